// What the fuzzers begin with: OUT/NAME/* for each of them, out of the recordings in DATA where they are, and built.
//   fuzz_seeds OUT [DATA]
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "base/byte_reader.h"
#include "chunk_kinds.h"
#include "link/cigi_random.h"
#include "link/dis.h"
#include "link/native_fdm.h"
#include "link/pcap.h"
#include "link/track_file.h"
#include "link/xplane.h"
#include "terrain/chunk_codec.h"
#include "terrain/compression.h"
#include "terrain/synthetic_chunk.h"

namespace {

using namespace eye;
using Bytes = std::vector<std::byte>;
namespace fs = std::filesystem;

class Corpus {
 public:
  explicit Corpus(fs::path folder) : folder_(std::move(folder)) { fs::create_directories(folder_); }
  void add(std::span<const std::byte> bytes) {
    std::ofstream file(folder_ / fmt::format("{:04}", count_++), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  void add(std::string_view text) { add(std::as_bytes(std::span(text))); }

 private:
  fs::path folder_;
  int count_ = 0;
};

// The first bytes of a file; nothing where there is none.
Bytes beginning(const fs::path& path, size_t most) {
  std::ifstream file(path, std::ios::binary);
  std::string text(most, '\0');
  file.read(text.data(), static_cast<std::streamsize>(most));
  text.resize(static_cast<size_t>(file.gcount()));
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

// The first payload of each length in a capture: one of each kind of message.
std::vector<Bytes> payloadKinds(const fs::path& path) {
  std::vector<Bytes> kinds;
  const auto file = readTrackFile(path);
  const auto capture = file ? parsePcap(*file) : Result<Capture>(Capture{});
  std::set<size_t> lengths;
  if (capture)
    for (const auto& datagram : capture->datagrams)
      if (lengths.insert(datagram.payload.size()).second)
        kinds.emplace_back(datagram.payload.begin(), datagram.payload.end());
  return kinds;
}

void cigiSeeds(Corpus corpus, const fs::path& captures) {
  for (const char* name : {"cigi33_ccl_c1723.pcap", "cigi40_ccl_c1723.pcap"})
    for (const Bytes& payload : payloadKinds(captures / name)) corpus.add(payload);
  for (const cigi::Format& format : test::cigiFormats()) {
    test::RandomCigi random(1, format.version);
    for (size_t i = 0; i < std::variant_size_v<cigi::Packet>; ++i) {
      cigi::Builder builder = i < test::kStartOfFrameIndex ? cigi::Builder(format, random.igControl())
                                                           : cigi::Builder(format, random.startOfFrame());
      if (i != test::kIgControlIndex && i != test::kStartOfFrameIndex) builder.add(random.packet(i));
      corpus.add(builder.take());
    }
  }
}

void fdmSeeds(Corpus corpus, const fs::path& captures) {
  corpus.add(buildNativeFdm({{{48.5, 16.5, 500}, 90, 2, -5}, 16000.0}));
  Bytes newer = buildNativeFdm({});
  newer.resize(kNativeFdmBytesV25);
  newer[3] = std::byte{25};
  corpus.add(newer);
  for (const Bytes& payload : payloadKinds(captures / "jsbsim_c1723_takeoff.pcap")) corpus.add(payload);
}

void smallSeeds(const fs::path& out) {
  DisEntityState entity;
  entity.pose = {{48.5, 16.5, 500}, 90, 2, -5};
  entity.marking = "EYE 1";
  Corpus(out / "dis").add(buildDisEntityState(entity));
  Corpus(out / "rpos").add(buildRpos({.pose = entity.pose}));
}

void pcapSeeds(Corpus corpus, const fs::path& captures) {
  for (const char* name : {"jsbsim_c1723_takeoff.pcap", "cigi33_ccl_c1723.pcap"}) {
    const Bytes bytes = beginning(captures / name, 2000);
    if (!bytes.empty()) corpus.add(bytes);
  }
  // Headers of the link layers, each with one empty record.
  for (const int linkType : {0, 1, 101, 108, 113, 228}) {
    Bytes bytes(24 + 16 + 48);
    const uint8_t magic[] = {0xd4, 0xc3, 0xb2, 0xa1, 2, 0, 4};
    for (size_t i = 0; i < sizeof magic; ++i) bytes[i] = std::byte{magic[i]};
    bytes[20] = static_cast<std::byte>(linkType);
    bytes[24 + 8] = bytes[24 + 12] = std::byte{48};
    corpus.add(bytes);
  }
}

void trackSeeds(Corpus corpus, const fs::path& data) {
  corpus.add("time,lat,lon,alt,heading,pitch,roll\n0,48,16,500,90,0,0\n1,48.001,16,510,91,1,2\n2,48.002,16,520,92,,\n");
  corpus.add("time,lat,lon,alt\r\n# a remark\r\n0,48,16,500\r\n\r\n10,48.01,16,510\r\n");
  corpus.add("AXXX\nHFDTE010124\nB1200004830000N01630000EA0050000510\nB1200014830010N01630000EA0050000510\n");
  for (const char* name : {"glider_nimbus4_frenchalps_1hz.igc", "helicopter_germany_4s.igc"}) {
    const Bytes bytes = beginning(data / "tracks/igc" / name, 4000);
    if (!bytes.empty()) corpus.add(bytes);
  }
}

void configSeeds(Corpus corpus) {
  corpus.add("size = \"800x600\"\nsse = 1.5\nheadless = true\nhost = [\"a\", \"b\"]\n");
  corpus.add(
      "mode = \"paper\"\n[paper]\nbands = [0.2, 0.4, 0.6, 0.8]\npitch-deg = [-30, 30]\n[adaptive]\ntrial-frames = 5\n");
  for (const char* name : {"config/eyepoint.toml", "config/selector.toml"}) corpus.add(beginning(name, 20'000));
}

// The first byte says which kind, see chunk_fuzz.cpp. Meshes that are packed also go unpacked, where bytes mean more.
void chunkSeeds(Corpus corpus) {
  constexpr size_t kHeaderBytes = 28, kPackingAt = 3, kVertexBytesAt = 18;
  for (size_t kind = 0; kind < fuzz::kChunkKeys.size(); ++kind)
    for (const int edges : {1, 6}) {
      const Blob mesh = encodeMesh(syntheticMesh(fuzz::kChunkKeys[kind], edges).mesh);
      Bytes seed{std::byte(kind)};
      seed.insert(seed.end(), mesh.begin(), mesh.end());
      corpus.add(seed);
      if (mesh[kPackingAt] == std::byte{0}) continue;
      ByteReader lengths{std::span(mesh).subspan(kVertexBytesAt), std::endian::little};
      const uint32_t vertices = lengths.u32(), indices = lengths.u32();
      const uint16_t clusters = lengths.u16();
      Bytes streams(vertices + indices + 18u * clusters);
      if (!decompress(std::span(mesh).subspan(kHeaderBytes), streams)) continue;
      seed.resize(1 + kHeaderBytes);
      seed[1 + kPackingAt] = std::byte{0};
      seed.insert(seed.end(), streams.begin(), streams.end());
      corpus.add(seed);
    }
  const Blob picture = encodeImagery(syntheticPicture(fuzz::kTextureSize, 1), fuzz::kTextureSize);
  Bytes seed{std::byte(fuzz::kChunkKeys.size())};
  seed.insert(seed.end(), picture.begin(), picture.end());
  corpus.add(seed);
}

}  // namespace

int main(int count, char** words) {
  if (count < 2) {
    std::fputs("usage: fuzz_seeds OUT [DATA]\n", stderr);
    return 2;
  }
  const fs::path out = words[1], data = count > 2 ? words[2] : "", captures = data / "captures";
  fdmSeeds(Corpus(out / "native_fdm"), captures);
  cigiSeeds(Corpus(out / "cigi"), captures);
  smallSeeds(out);
  pcapSeeds(Corpus(out / "pcap"), captures);
  trackSeeds(Corpus(out / "track"), data);
  configSeeds(Corpus(out / "config"));
  chunkSeeds(Corpus(out / "chunk"));
  return 0;
}

// What the fuzzers begin with: OUT/NAME/* for each of them, out of the recordings in DATA where they are, and built.
//   fuzz_seeds OUT [DATA]
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "base/byte_reader.h"
#include "chunk_kinds.h"
#include "feed_script.h"
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

// Messages of a session, one a frame.
class CigiScript {
 public:
  explicit CigiScript(const cigi::Format& format) : format_(format) {}
  void say(const std::vector<cigi::Packet>& packets, uint8_t wait = 16, uint8_t sender = 0) {
    cigi::IgControl control;
    control.mode = cigi::IgMode::operate;
    control.smoothing = true;
    control.hostFrame = frame_++;
    control.ticks = control.hostFrame * 1600;
    cigi::Builder builder(format_, control);
    for (const cigi::Packet& packet : packets) builder.add(packet);
    fuzz::addStep(input_, builder.take(), wait, sender);
  }
  void goBack(uint32_t frames) { frame_ -= frames; }
  const Bytes& input() const { return input_; }

 private:
  cigi::Format format_;
  uint32_t frame_ = 5;
  Bytes input_;
};

cigi::Entity entityAt(uint16_t id, const cigi::Point& point, cigi::EntityState state = cigi::EntityState::active,
                      uint16_t parentId = 0) {
  cigi::EntityTraits traits;
  traits.state = state;
  traits.smoothing = true;
  return {id, traits, cigi::EntityPlace{cigi::Clamp::none, parentId, 3, 2, 1, point}};
}

// What a session remembers: circles of attached entities and their end, views and their groups, motion, overtaken
// messages, another host.
void cigiSessionSeeds(Corpus& corpus, const cigi::Format& format) {
  const Geodetic place{48.5, 16.5, 500};
  const cigi::BodyOffset offset{10, 2, -1};
  cigi::Velocity velocity;
  velocity.xMS = 100, velocity.yawDegS = 3, velocity.inBodyFrame = true;
  cigi::Acceleration acceleration;
  acceleration.xMS2 = 5;
  cigi::ViewControl eye;
  eye.entityId = 2, eye.xM = 1.5, eye.yawDeg = 60;
  cigi::ViewControl groupsEye = eye;
  groupsEye.viewId = 9, groupsEye.groupId = 3, groupsEye.entityId = 1;
  cigi::ViewDefinition lens;
  lens.groupId = 3, lens.leftDegOrM = -30, lens.rightDegOrM = 20, lens.nearM = 0.5;
  cigi::CelestialSphere sky;
  sky.dateTime = cigi::DateTime{2024, 6, 21, 12, 30, 0}, sky.clockRuns = true;
  cigi::Weather fog;
  fog.enabled = true, fog.visibilityM = 200, fog.thicknessM = 900;
  const cigi::HeightRequest height{7, cigi::HeightKind::both, 2, 2, offset};

  CigiScript attached(format);
  attached.say({entityAt(0, place), lens, sky, fog});
  attached.say({entityAt(1, offset, cigi::EntityState::active, 0), entityAt(2, offset, cigi::EntityState::active, 1)});
  attached.say({eye, velocity, acceleration, height});
  attached.say({});
  attached.say({groupsEye}, 201);
  attached.say({entityAt(0, offset, cigi::EntityState::active, 2)});  // a circle
  attached.say({entityAt(1, offset, cigi::EntityState::destroyed)});
  attached.say({entityAt(0, place)});
  corpus.add(attached.input());

  CigiScript overtaken(format);
  for (int i = 0; i < 4; ++i) overtaken.say({entityAt(0, place), velocity}, 10, i == 2 ? 0x80 : 0);
  overtaken.goBack(3);
  overtaken.say({lens, entityAt(0, Geodetic{-48, 179.9, 100}), height});
  overtaken.goBack(2);
  for (int i = 0; i < 12; ++i) overtaken.say({entityAt(0, place)});
  overtaken.say({entityAt(0, place)}, 16, 1);
  overtaken.say({entityAt(0, place)}, 203, 1);
  corpus.add(overtaken.input());
}

void cigiSeeds(Corpus corpus, const fs::path& captures) {
  for (const char* name : {"cigi33_ccl_c1723.pcap", "cigi40_ccl_c1723.pcap"})
    for (const Bytes& payload : payloadKinds(captures / name)) corpus.add(payload);
  for (const cigi::Format& format : test::cigiFormats()) {
    cigiSessionSeeds(corpus, format);
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
  // A flight long enough for its clock to be believed, of milliseconds, and a packet that was overtaken.
  Bytes flight;
  for (uint32_t i = 0; i < 60; ++i)
    fuzz::addStep(flight,
                  buildNativeFdm({{{48.5, 16.5 + i * 1e-3, 500}, 90, 2, -5}, 16000.0, 200 * (i == 55 ? 53 : i)}), 200,
                  i % 8 == 7 ? 0x80 : 0);
  corpus.add(flight);
}

void smallSeeds(const fs::path& out) {
  DisEntityState entity;
  entity.pose = {{48.5, 16.5, 500}, 90, 2, -5};
  entity.marking = "EYE 1";
  Corpus dis(out / "dis"), rpos(out / "rpos");
  dis.add(buildDisEntityState(entity));
  rpos.add(buildRpos({.pose = entity.pose}));
  // Of each way to move, over the hour, with another entity and another sender between.
  Bytes exercise, flight;
  entity.velocityMS = {100, 20, -3}, entity.accelerationMS2 = {1, 2, 3}, entity.turnRateBodyRadS = {0.1, 0.2, 0.3};
  for (uint8_t i = 0; i < 30; ++i) {
    entity.deadReckoning = static_cast<DeadReckoning>(i % 10);
    entity.timestamp = disTimestamp(std::fmod(3598 + (i == 20 ? 18 : i) * 0.2, 3600), i > 25);
    entity.entity = i % 5 == 4 ? 1 : 0;
    fuzz::addStep(exercise, buildDisEntityState(entity), i == 28 ? 213 : 200, i > 22 ? 1 : 0);
    fuzz::addStep(flight, buildRpos({.pose = entity.pose}), i == 15 ? 203 : 16, i > 12 ? 1 : 0);
  }
  dis.add(exercise);
  rpos.add(flight);
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

// CIGI against others: recorded sessions of the CIGI Class Library, and Wireshark's reading of them and of what is
// built.

#include <array>
#include <catch2/catch.hpp>

#include "cigi_labels.h"
#include "cigi_random.h"
#include "link/cigi.h"
#include "link/pcap.h"
#include "link/track_file.h"
#include "support/places.h"

namespace eye {
namespace {

using namespace eye::test;
using namespace eye::cigi;

// Nothing, with a warning, where there are no recordings.
std::optional<std::vector<std::byte>> recording(const std::string& name) {
  const std::string path = eye::test::kTestData + "/" + name;
  auto file = readTrackFile(path);
  if (!file) {
    WARN("no recording " << path);
    return std::nullopt;
  }
  return std::move(*file);
}

using Counts = std::array<int, std::variant_size_v<Packet>>;

struct Session {
  Counts counts{};
  std::vector<Message> messages;
};

Session sessionOf(const std::vector<std::byte>& file, const Format& format) {
  Session session;
  const auto capture = parsePcap(file);
  REQUIRE(capture);
  for (const auto& datagram : capture->datagrams) {
    auto message = parse(datagram.payload);
    REQUIRE(message);
    REQUIRE(message->format == format);
    REQUIRE(message->rejected == 0);
    REQUIRE(message->unknown == 0);
    for (const Packet& packet : message->packets) ++session.counts.at(packet.index());
    session.messages.push_back(std::move(*message));
  }
  return session;
}

// Wireshark prints six digits of a float and fifteen of a double.
void compare(const Dissected& judged, const Dissected& ours) {
  REQUIRE(judged.name == ours.name);
  INFO(ours.name);
  for (const auto& [label, value] : ours.fields) {
    INFO(label);
    REQUIRE(judged.fields.contains(label));
    const bool isDouble = label.find("Latitude") != std::string::npos || label.find("Longitude") != std::string::npos ||
                          label.find("Altitude") != std::string::npos;
    CHECK(judged.fields.at(label) == Approx(value).epsilon(isDouble ? 1e-14 : 1e-5).margin(isDouble ? 0 : 1e-20));
  }
  // And nothing that we pass over, but what stands in every packet.
  for (const auto& [label, value] : judged.fields)
    if (label != "Packet ID" && label != "Packet Size (bytes)" && label != "CIGI Version" && label != "Byte Swap") {
      INFO(label);
      CHECK(ours.fields.contains(label));
    }
}

TEST_CASE("CIGI 3.3: a recorded session is understood to its last packet, with Wireshark's values") {
  const auto file = recording("captures/cigi33_ccl_c1723.pcap");
  const auto golden = recording("captures/cigi33_golden_dissection.txt");
  if (!file || !golden) return;
  const Session session = sessionOf(*file, {{3, 3}, std::endian::little});
  CHECK(session.messages.size() == 7200);
  // 3600 frames; the surroundings once a second, the questions of line of sight twice.
  CHECK(session.counts == Counts{3600, 3600, 60, 60, 120, 0, 60, 60, 60, 3720, 120, 120, 3600, 3597, 119, 119, 119});

  const std::string text(reinterpret_cast<const char*>(golden->data()), golden->size());
  const auto judged = dissectedPackets(text);
  REQUIRE(judged.size() > 20);
  std::map<size_t, size_t> packetsOfFrame;
  for (const Dissected& packet : judged) {
    const auto& ours = session.messages.at(packet.frame - 1).packets;
    compare(packet, labelled(ours.at(packetsOfFrame[packet.frame]++), 3));
  }
  for (const auto& [frame, packets] : packetsOfFrame) CHECK(session.messages[frame - 1].packets.size() == packets);
}

TEST_CASE("CIGI 4.0: a recorded session says what the same flight says in 3.3") {
  const auto file3 = recording("captures/cigi33_ccl_c1723.pcap"), file4 = recording("captures/cigi40_ccl_c1723.pcap");
  if (!file3 || !file4) return;
  const Session in3 = sessionOf(*file3, {{3, 3}, std::endian::little});
  const Session in4 = sessionOf(*file4, {{4, 0}, std::endian::little});
  REQUIRE(in4.messages.size() == in3.messages.size());
  // An entity's traits are a packet of their own, once a second; the library's weather was left out of this recording.
  CHECK(in4.counts == Counts{3600, 3660, 60, 60, 120, 0, 60, 60, 0, 3720, 120, 120, 3600, 3597, 119, 119, 119});

  size_t places = 0;
  for (size_t i = 0; i < in3.messages.size(); ++i) {
    std::vector<Packet> expected = in3.messages[i].packets, there = in4.messages[i].packets;
    std::erase_if(expected, [](const Packet& p) { return std::holds_alternative<Weather>(p); });
    for (Packet& packet : expected)
      if (auto* entity = std::get_if<Entity>(&packet)) entity->traits.reset();
    std::erase_if(there, [](const Packet& p) {
      const auto* entity = std::get_if<Entity>(&p);
      return entity != nullptr && entity->traits;
    });
    for (const Packet& packet : there) places += std::holds_alternative<Entity>(packet) ? 1u : 0u;
    REQUIRE(there.size() == expected.size());
    CHECK(there == expected);
  }
  CHECK(places == 3600);
}

TEST_CASE("CIGI 2: a recorded session is refused by name") {
  const auto file = recording("cigi/cigi2.pcap");
  if (!file) return;
  const auto capture = parsePcap(*file);
  REQUIRE(capture);
  REQUIRE(capture->datagrams.size() == 949);
  for (const auto& datagram : capture->datagrams) {
    const auto message = parse(datagram.payload);
    REQUIRE_FALSE(message);
    REQUIRE(message.error().kind == ErrorKind::unsupported);
    REQUIRE(message.error().message.starts_with("the message is CIGI 2;"));
  }
  const auto track = parsePcapTrack(*file);
  REQUIRE_FALSE(track);
  CHECK(track.error().message.find("none of the capture's 949") != std::string::npos);
  CHECK(track.error().message.find("the message is CIGI 2;") != std::string::npos);
}

TEST_CASE("CIGI 3.0 to 3.3: Wireshark reads what is built as it was meant") {
  std::vector<Bytes> payloads;
  std::vector<Dissected> expected;
  for (const Format& format : cigiFormats()) {
    if (format.version.major != 3) continue;
    const uint8_t minor = format.version.minor;
    RandomCigi random(100 + minor, format.version);
    for (int trial = 0; trial < 20; ++trial)
      for (const bool fromHost : {true, false}) {
        const IgControl control = random.igControl();
        const StartOfFrame frame = random.startOfFrame();
        Builder builder = fromHost ? Builder(format, control) : Builder(format, frame);
        expected.push_back(fromHost ? labelled(Packet(control), minor) : labelled(Packet(frame), minor));
        const size_t first = fromHost ? kIgControlIndex + 1 : kStartOfFrameIndex + 1;
        const size_t end = fromHost ? kStartOfFrameIndex : std::variant_size_v<Packet>;
        for (size_t alternative = first; alternative < end; ++alternative) {
          const Packet packet = random.packet(alternative);
          REQUIRE(builder.add(packet));
          expected.push_back(labelled(packet, minor));
        }
        payloads.push_back(builder.take());
      }
  }
  const auto text = tsharkVerbose(captureOf(payloads, 8004), "udp.port==8004,cigi", "cigi");
  if (!text) {
    WARN("no tshark: nobody judges");
    return;
  }
  CHECK(text->find("Malformed") == std::string::npos);
  const auto judged = dissectedPackets(*text);
  REQUIRE(judged.size() == expected.size());
  for (size_t i = 0; i < judged.size(); ++i) compare(judged[i], expected[i]);
}

}  // namespace
}  // namespace eye

#include "link/pcap.h"

#include "link/track_file.h"
#include "packets.h"

namespace eye {
namespace {

using namespace eye::test;

Bytes zeros(size_t count) {
  return Bytes(count);
}

// A frame of each link type around an IP packet.
Bytes frameOf(uint32_t linkType, const Bytes& packet, bool bigEndian) {
  Bytes frame;
  if (linkType == 0) frame = zeros(4), putU(frame, 0, 2, 4, bigEndian);
  if (linkType == 108) frame = zeros(4), putU(frame, 0, 2, 4);
  if (linkType == 1) frame = zeros(14), putU(frame, 12, 0x0800, 2);
  if (linkType == 113) frame = zeros(16), putU(frame, 14, 0x0800, 2);
  if (linkType == 276) frame = zeros(20), putU(frame, 0, 0x0800, 2);
  append(frame, packet);
  return frame;
}

TEST_CASE("captures of every link type, byte order and clock give the payload") {
  const Bytes payload = fdmPacket(0.5, 1, 100, 0, 0, 0, 0);
  for (const uint32_t linkType : {0u, 1u, 101u, 108u, 113u, 228u, 276u})
    for (const bool big : {false, true})
      for (const bool ns : {false, true}) {
        PcapWriter writer(linkType, big, ns);
        writer.add(1'500'000'123'456'000, frameOf(linkType, ipPacket(payload, 5550), big));
        const auto capture = parsePcap(writer.bytes);
        INFO("link type " << linkType << " big " << big << " ns " << ns);
        REQUIRE(capture);
        REQUIRE(capture->datagrams.size() == 1);
        const CapturedDatagram& datagram = capture->datagrams[0];
        CHECK(Bytes(datagram.payload.begin(), datagram.payload.end()) == payload);
        CHECK(datagram.timeNs == 1'500'000'123'456'000);
        CHECK(datagram.destination == 0x7f000001);
        CHECK(datagram.destinationPort == 5550);
      }
}

TEST_CASE("what is no whole IPv4 UDP datagram is passed over") {
  const Bytes payload = zeros(20);
  Bytes tcp = ipPacket(payload, 1), fragment = ipPacket(payload, 1), cut = ipPacket(payload, 1),
        v6 = ipPacket(payload, 1);
  putU(tcp, 9, 6, 1);
  putU(fragment, 6, 0x2000, 2);
  cut.resize(40);
  putU(v6, 0, 0x65, 1);
  PcapWriter writer(101);
  for (const Bytes& packet : {tcp, fragment, cut, v6, zeros(0), zeros(3)}) writer.add(0, packet);
  writer.add(0, ipPacket(payload, 7));
  Bytes file = writer.bytes;
  const auto capture = parsePcap(file);
  REQUIRE(capture);
  CHECK(capture->passedOver == 6);
  CHECK(capture->datagrams.size() == 1);

  file.pop_back();  // a capture that was killed while it wrote
  const auto truncated = parsePcap(file);
  REQUIRE(truncated);
  CHECK(truncated->truncated);
  CHECK(truncated->datagrams.empty());
}

TEST_CASE("VLAN tags and IP options are stepped over") {
  const Bytes payload = zeros(9);
  Bytes packet = ipPacket(payload, 42);
  putU(packet, 0, 0x46, 1);
  packet.insert(packet.begin() + 20, 4, std::byte{1});
  Bytes frame = zeros(22);
  putU(frame, 12, 0x88a8, 2);
  putU(frame, 16, 0x8100, 2);
  putU(frame, 20, 0x0800, 2);
  append(frame, packet);
  PcapWriter writer(1);
  writer.add(0, frame);
  const auto capture = parsePcap(writer.bytes);
  REQUIRE(capture);
  REQUIRE(capture->datagrams.size() == 1);
  CHECK(capture->datagrams[0].destinationPort == 42);
  CHECK(capture->datagrams[0].payload.size() == 9);
}

TEST_CASE("other files are named for what they are") {
  Bytes pcapng = zeros(64);
  putU(pcapng, 0, 0x0a0d0d0a, 4);
  CHECK(parsePcap(pcapng).error().message.find("editcap -F pcap") != std::string::npos);
  CHECK(parsePcap(zeros(64)).error().message.find("no pcap") != std::string::npos);
  CHECK_FALSE(parsePcap({}));
  CHECK(parsePcap(PcapWriter(147).bytes).error().message.find("147") != std::string::npos);
  CHECK(parsePcapTrack(PcapWriter(1).bytes).error().message.find("none of the capture's 0 UDP") != std::string::npos);
}

TEST_CASE("a capture's track is the first stream's, in order, bad packets left out") {
  PcapWriter writer(101);
  const auto add = [&](double timeS, double altM, uint16_t port) {
    writer.add(static_cast<int64_t>(timeS * 1e9), ipPacket(fdmPacket(0.5, 1, altM, 0, 0, 0, 0), port));
  };
  add(10.0, 100, 5550);
  add(10.0, 900, 5551);  // another aircraft
  add(10.5, 150, 5550);
  add(10.4, 149, 5550);  // the clock was set back
  add(11.0, 1e9, 5550);  // out of range
  add(12.0, 200, 5550);
  const auto track = parsePcapTrack(writer.bytes);
  REQUIRE(track);
  REQUIRE(track->samples().size() == 3);
  CHECK(track->durationS() == Approx(2));
  CHECK(track->at(0.5).position.altM == 150);
  // To be sent again, nothing is left out but the other aircraft.
  const auto packets = parsePcapPackets(writer.bytes, RecordedProtocol::nativeFdm);
  REQUIRE(packets);
  REQUIRE(packets->size() == 5);
  CHECK((*packets)[2].timeS == Approx(0.5));
  CHECK(packets->back().timeS == Approx(2));
}

TEST_CASE("damaged captures never crash") {
  PcapWriter writer(1);
  for (int i = 0; i < 6; ++i)
    writer.add(i * 16'666'667, frameOf(1, ipPacket(fdmPacket(0.5, 1, 100 + i, 0, 0, 0, 0), 5550), false));
  std::mt19937_64 random(11);
  size_t read = 0;
  for (int i = 0; i < 20'000; ++i) {
    Bytes file = writer.bytes;
    damage(file, random);
    if (i % 2 == 0) {  // in the headers, where damage tells
      const size_t record = random() % 6;
      const size_t at = 24 + record * (16 + 42 + 408) + random() % 58;
      if (at < file.size()) file[at] = static_cast<std::byte>(random() & 0xff);
    }
    if (const auto track = parsePcapTrack(file)) ++read;
    (void)parsePcapPackets(file, RecordedProtocol::nativeFdm);
  }
  CHECK(read > 5'000);
}

}  // namespace
}  // namespace eye

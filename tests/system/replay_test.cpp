// A recorded take-off over UDP at real time: every packet arrives and is counted, and what is drawn is where a packet
// says.
#include <fmt/format.h>

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>

#include "support/places.h"
#include "system/live_run.h"
#include "system/program.h"
#include "truth/wgs84.h"

namespace eye::truth {
namespace {

constexpr double kSeconds = 6;

double bigEndianDouble(const std::string& bytes, size_t at) {
  uint64_t value = 0;
  for (size_t i = 0; i < 8; ++i) value = value << 8 | static_cast<uint8_t>(bytes[at + i]);
  return std::bit_cast<double>(value);
}

// Positions of a little-endian classic pcap of Ethernet frames: found by the version 24 that starts each payload of 408
// bytes. Longitude at 8, latitude at 16 (radians), altitude at 24.
std::vector<Place> positionsIn(const std::string& capture) {
  const std::string bytes = readText(capture);
  std::vector<Place> places;
  size_t at = 24;
  while (at + 16 <= bytes.size()) {
    uint32_t length = 0;
    for (size_t i = 0; i < 4; ++i) length |= static_cast<uint32_t>(static_cast<uint8_t>(bytes[at + 8 + i])) << (8 * i);
    const size_t end = at + 16 + length;
    if (end > bytes.size()) break;
    if (length >= 408) {
      const size_t payload = end - 408;
      constexpr double kDeg = 57.29577951308232;
      places.push_back({bigEndianDouble(bytes, payload + 16) * kDeg, bigEndianDouble(bytes, payload + 8) * kDeg,
                        bigEndianDouble(bytes, payload + 24)});
    }
    at = end;
  }
  return places;
}

}  // namespace

TEST_CASE("replay: a take-off over UDP drives the picture, no packet lost, position to the millimetre") {
  const std::string capture = eye::test::kTestData + "/captures/jsbsim_c1723_takeoff.pcap";
  const std::string database = carpathiaDatabase();
  if (database.empty() || !std::filesystem::exists(capture)) {
    WARN("no " << capture << " or no terrain: this test checks nothing");
    return;
  }
  const std::string stats = testFile("replay.jsonl");
  std::filesystem::remove(stats);
  const uint16_t port = freePort();
  const std::string address = fmt::format("127.0.0.1:{}", port);
  auto flight = std::async(std::launch::async, [&] {
    return runProgram("eyepoint",
                      {"--headless", "--terrain", database, "--host", "native-fdm://" + address, "--stats", stats,
                       "--size", "320x240", "--duration", fmt::format("{}", kSeconds + 6), "--log-level", "error"});
  });
  REQUIRE(awaitListeners("127.0.0.1", port));

  const ProgramRun host = runProgram("eyepoint-host", {"--protocol", "native-fdm", "--to", address, "--track", capture,
                                                       "--duration", fmt::format("{}", kSeconds)});
  const ProgramRun drawn = flight.get();
  INFO(host.out << host.err << drawn.err);
  REQUIRE(host.exitCode == 0);
  REQUIRE(drawn.exitCode == 0);

  const std::vector<nlohmann::json> frames = linesOf(stats);
  REQUIRE(frames.size() > 100);
  const auto received = frames.back()["host"]["packets"].get<uint64_t>();
  CHECK(frames.back()["host"]["rejected"].get<uint64_t>() == 0);
  const std::vector<Place> positions = positionsIn(capture);
  REQUIRE(positions.size() > 1000);
  // What the host says it sent, last number before "packets" of its summary.
  const std::string said = host.out + host.err;
  INFO("received " << received << " of " << positions.size() << " in the capture");
  CHECK(said.find(fmt::format("{} packets", received)) != std::string::npos);
  CHECK(received > 100);

  // Every frame after the first packet stands exactly where one of the packets received says.
  size_t next = 0, matched = 0, checked = 0;
  for (const nlohmann::json& frame : frames) {
    if (frame["host"]["packets"].get<uint64_t>() == 0) continue;
    ++checked;
    const auto pose = frame["pose"].get<std::vector<double>>();
    const Vec at = ecefFromPlace({pose[0], pose[1], pose[2]});
    size_t i = next;
    while (i < positions.size() && length(ecefFromPlace(positions[i]) - at) > 1e-3) ++i;
    if (i == positions.size()) continue;
    ++matched;
    next = i;  // packets are taken in order
  }
  CHECK(checked > 100);
  CHECK(matched == checked);
  CHECK(next + 1 == received);  // the last frame shows the last packet
}

}  // namespace eye::truth

// A recorded CIGI session over UDP at real time, in both versions: every packet counted, every frame where one of them
// says, and Starts of Frame that the host understands.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>

#include "link/cigi_host.h"
#include "link/track_file.h"
#include "support/places.h"
#include "system/live_run.h"
#include "system/program.h"
#include "truth/wgs84.h"

namespace eye::truth {
namespace {

constexpr double kSeconds = 4;

std::vector<Place> placesIn(const std::string& capture) {
  std::vector<Place> places;
  const auto file = readTrackFile(capture);
  if (!file) return places;
  const auto packets = parsePcapPackets(*file, RecordedProtocol::cigi);
  if (!packets) return places;
  for (const RecordedPacket& packet : *packets)
    if (const auto pose = cigi::entityPoseIn(packet.payload))
      places.push_back({pose->position.latDeg, pose->position.lonDeg, pose->position.altM});
  return places;
}

// The number before `words` in a text.
int numberBefore(const std::string& text, const std::string& words) {
  const size_t at = text.find(words);
  if (at == std::string::npos) return -1;
  const size_t begin = text.find_last_not_of("0123456789", at - 1) + 1;
  return begin == at ? -1 : std::stoi(text.substr(begin, at - begin));
}

}  // namespace

TEST_CASE("CIGI: a recorded session over UDP drives the picture in both versions, and hears of every frame") {
  const std::string database = carpathiaDatabase();
  for (const std::string version : {"3.3", "4.0"}) {
    const std::string capture =
        fmt::format("{}/captures/cigi{}{}_ccl_c1723.pcap", eye::test::kTestData, version[0], version[2]);
    if (database.empty() || !std::filesystem::exists(capture)) {
      WARN("no " << capture << " or no terrain: this test checks nothing");
      return;
    }
    const std::string stats = testFile("cigi.jsonl");
    std::filesystem::remove(stats);
    const uint16_t port = freePort();
    const std::string address = fmt::format("127.0.0.1:{}", port);
    auto flight = std::async(std::launch::async, [&] {
      return runProgram("eyepoint",
                        {"--headless", "--terrain", database, "--host", "cigi://" + address, "--stats", stats, "--size",
                         "320x240", "--duration", fmt::format("{}", kSeconds + 5), "--log-level", "error"});
    });
    REQUIRE(awaitListeners("127.0.0.1", port));
    const ProgramRun host =
        runProgram("eyepoint-host", {"--protocol", "cigi", "--cigi-version", version, "--to", address, "--track",
                                     capture, "--duration", fmt::format("{}", kSeconds)});
    const ProgramRun drawn = flight.get();
    INFO(host.out << host.err << drawn.err);
    REQUIRE(host.exitCode == 0);
    REQUIRE(drawn.exitCode == 0);

    const std::vector<nlohmann::json> frames = linesOf(stats);
    REQUIRE(frames.size() > 100);
    const nlohmann::json& counts = frames.back()["host"];
    const std::string said = host.out + host.err;
    const auto received = counts["packets"].get<size_t>();
    CHECK(counts["rejected"] == 0);
    CHECK(counts["lost"] == 0);
    CHECK(received > 100);
    CHECK(said.find(fmt::format("{} packets", received)) != std::string::npos);
    CHECK(numberBefore(said, " Starts of Frame") > 50);
    CHECK(numberBefore(said, " datagrams not understood") == 0);
    CHECK(numberBefore(said, " answers of height") > 100);

    // Every frame after the first packet stands where one of the packets says, in their order, the last at the last.
    const std::vector<Place> places = placesIn(capture);
    REQUIRE(places.size() > received);
    size_t next = 0, matched = 0, checked = 0;
    for (const nlohmann::json& frame : frames) {
      if (frame["host"]["packets"].get<uint64_t>() == 0) continue;
      ++checked;
      const auto pose = frame["pose"].get<std::vector<double>>();
      const Vec at = ecefFromPlace({pose[0], pose[1], pose[2]});
      size_t i = next;
      while (i < received && length(ecefFromPlace(places[i]) - at) > 1e-3) ++i;
      if (i == received) continue;
      ++matched;
      next = i;
    }
    CHECK(checked > 100);
    CHECK(matched == checked);
    CHECK(length(ecefFromPlace(places[received - 1]) - ecefFromPlace(places[next])) < 1e-3);
  }
}

TEST_CASE("CIGI: a host that asks prints every answer and Start of Frame, in both versions") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  for (const std::string version : {"3.3", "4.0"}) {
    const uint16_t port = freePort();
    const std::string address = fmt::format("127.0.0.1:{}", port);
    auto flight = std::async(std::launch::async, [&] {
      return runProgram("eyepoint", {"--headless", "--terrain", database, "--host", "cigi://" + address, "--size",
                                     "160x120", "--duration", "7", "--log-level", "error"});
    });
    REQUIRE(awaitListeners("127.0.0.1", port));
    const ProgramRun host = runProgram("eyepoint-host", {"--protocol",
                                                         "cigi",
                                                         "--cigi-version",
                                                         version,
                                                         "--synchronous",
                                                         "--channels",
                                                         "1",
                                                         "--to",
                                                         address,
                                                         "--pose",
                                                         "49.25,20.1,2600,180,-10,0",
                                                         "--ask",
                                                         "hat,hot",
                                                         "--ask",
                                                         "hat-hot,los",
                                                         "--ask",
                                                         "los-extended",
                                                         "--ask-every",
                                                         "10",
                                                         "--print-replies",
                                                         "--duration",
                                                         "2"});
    const ProgramRun drawn = flight.get();
    INFO(version << ": " << host.out << host.err << drawn.err);
    REQUIRE(host.exitCode == 0);
    REQUIRE(drawn.exitCode == 0);
    const std::string said = host.out + host.err;
    const auto count = [&](const std::string& words) {
      int found = 0;
      for (size_t at = said.find(words); at != std::string::npos; at = said.find(words, at + 1)) ++found;
      return found;
    };
    // An answer to each request of each tenth frame that was answered in time, no more.
    const int starts = count("Start of Frame "), due = starts / 10 + 1;
    CHECK(starts > 20);
    for (const std::string answer : {"HAT 1 ", "HOT 2 ", "HAT/HOT 3 ", "LOS 4 ", "LOS extended 5 "}) {
      INFO(answer);
      CHECK(count(answer) >= 2);
      CHECK(count(answer) <= due + 1);
    }
    CHECK(count("not valid") == 0);  // ten degrees down there is ground
    CHECK(numberBefore(said, " datagrams not understood") == 0);
    // The two ways to ask agree.
    const auto after = [&](const std::string& words) {
      const size_t at = said.find(words);
      return at == std::string::npos ? -1e9 : std::stod(said.substr(said.find("): ", at) + 3));
    };
    CHECK(after("HAT 1 ") + after("HOT 2 ") == Approx(2600).margin(0.011));
  }
}

}  // namespace eye::truth

// The same flight over native-fdm, CIGI 3.3 and CIGI 4.0: the same picture.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <future>

#include "system/live_run.h"
#include "system/program.h"
#include "system/rasters.h"
#include "truth/wgs84.h"

namespace eye::truth {
namespace {

struct Protocol {
  std::string name, scheme;
  std::vector<std::string> host;  // options of eyepoint-host
};

std::string fileOf(const Protocol& protocol, const char* ending) {
  return testFile("protocol_" + protocol.name + ending);
}

}  // namespace

TEST_CASE("protocols: the same flight gives the same picture over each") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  constexpr Place kEnd{49.24, 20.11, 2500};
  const std::string track = testFile("protocols.csv");
  writeText(track, "time,lat,lon,alt,heading,pitch,roll\n0,49.25,20.1,2600,180,-5,7\n1,49.24,20.11,2500,170,-8,-5\n");
  const std::vector<Protocol> protocols = {{"native_fdm", "native-fdm", {"--protocol", "native-fdm"}},
                                           {"cigi33", "cigi", {"--protocol", "cigi", "--cigi-version", "3.3"}},
                                           {"cigi40", "cigi", {"--protocol", "cigi", "--cigi-version", "4.0"}}};
  std::vector<std::future<ProgramRun>> flights;
  std::vector<uint16_t> ports;
  for (const Protocol& protocol : protocols) {
    for (const char* ending : {".jsonl", ".tif", ".png"}) std::filesystem::remove(fileOf(protocol, ending));
    ports.push_back(freePort());
    flights.push_back(std::async(std::launch::async, [&protocol, &database, port = ports.back()] {
      return runProgram("eyepoint",
                        {"--headless", "--terrain", database, "--host",
                         fmt::format("{}://127.0.0.1:{}", protocol.scheme, port), "--host-delay", "off", "--size",
                         "320x240", "--duration", "7", "--stats", fileOf(protocol, ".jsonl"), "--distance-map",
                         fileOf(protocol, ".tif"), "--screenshot", fileOf(protocol, ".png"), "--log-level", "error"});
    }));
  }
  for (size_t i = 0; i < protocols.size(); ++i) {
    REQUIRE(awaitListeners("127.0.0.1", ports[i]));
    std::vector<std::string> words = protocols[i].host;
    for (const std::string& word :
         {std::string("--to"), fmt::format("127.0.0.1:{}", ports[i]), std::string("--track"), track})
      words.push_back(word);
    CHECK(runProgram("eyepoint-host", words).exitCode == 0);
  }
  for (auto& flight : flights) {
    const ProgramRun run = flight.get();
    INFO(run.err);
    REQUIRE(run.exitCode == 0);
  }

  const RasterImage map = readRaster(fileOf(protocols[0], ".tif")), picture = readRaster(fileOf(protocols[0], ".png"));
  REQUIRE((map.widthPx == 320 && picture.bands >= 3));
  for (const Protocol& protocol : protocols) {
    INFO(protocol.name);
    const nlohmann::json last = linesOf(fileOf(protocol, ".jsonl")).back();
    CHECK(last["host"]["packets"] == 61);
    CHECK(last["host"]["rejected"] == 0);
    CHECK(last["paging"]["missing"] == 0);
    const auto pose = last["pose"].get<std::vector<double>>();
    CHECK(length(ecefFromPlace({pose[0], pose[1], pose[2]}) - ecefFromPlace(kEnd)) < 1e-3);
    CHECK(pose[3] == Approx(170).margin(1e-4));  // native-fdm has angles of 32 bits
    const RasterImage otherMap = readRaster(fileOf(protocol, ".tif")), other = readRaster(fileOf(protocol, ".png"));
    REQUIRE((otherMap.values.size() == map.values.size() && other.values.size() == picture.values.size()));
    int differentDistance = 0, differentColour = 0;
    for (size_t i = 0; i < map.values.size(); ++i) {
      const float a = map.values[i], b = otherMap.values[i];
      differentDistance += std::isnan(a) != std::isnan(b) || std::abs(a - b) > 1e-3f * a;
    }
    for (size_t i = 0; i < picture.values.size(); ++i)
      differentColour += std::abs(picture.values[i] - other.values[i]) > 2;  // of 255
    CAPTURE(differentDistance, differentColour);
    CHECK(differentDistance < 320 * 240 / 1000);
    CHECK(differentColour < 3 * 320 * 240 / 1000);
  }
}

}  // namespace eye::truth

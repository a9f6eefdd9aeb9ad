// A moving eye costs no more than a still one. lavapipe compiles a shader anew for each value of a uniform that steers
// a branch, 45 ms and more a frame; such a branch is easily written and shows in no picture.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "system/program.h"

namespace eye::truth {
namespace {

// Median milliseconds of 60 small frames along a track from a pose to another within a second, all terrain resident.
double medianFrameMs(const std::string& from, const std::string& to, const std::string& database) {
  const std::string track = testFile("moving_eye.csv"), stats = testFile("moving_eye.jsonl");
  writeText(track, "time,lat,lon,alt,heading,pitch,roll\n0," + from + "\n1," + to + "\n");
  const ProgramRun run = runProgram(
      "eyepoint", {"--headless", "--offline", "--redraw", "always", "--frames", "60", "--size", "64x48", "--terrain",
                   database, "--host", "file://" + track, "--stats", stats, "--log-level", "error"});
  INFO(run.err);
  REQUIRE(run.exitCode == 0);
  std::vector<double> times;
  std::ifstream in(stats);
  for (std::string line; std::getline(in, line);)
    times.push_back(nlohmann::json::parse(line)["frame_ms"].get<double>());
  REQUIRE(times.size() == 60);
  std::nth_element(times.begin(), times.begin() + 30, times.end());
  return times[30];
}

}  // namespace

TEST_CASE("moving eye: turns, rolls and climbs cost what standing still does") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  const std::string still = "49.25,20.1,2600,180,0,0";
  const double stillMs = medianFrameMs(still, still, database);
  for (const char* to : {"49.25,20.1,2600,180,0,25", "49.25,20.1,2600,200,0,0", "49.25,20.1,2600,180,10,0",
                         "49.25,20.1,2700,180,0,0", "49.251,20.102,2600,170,0,0"}) {
    INFO(to << ", standing still " << stillMs << " ms");
    CHECK(medianFrameMs(still, to, database) < 3 * stillMs + 10);
  }
}

}  // namespace eye::truth

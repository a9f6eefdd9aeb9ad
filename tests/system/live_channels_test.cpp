// Three channels with the shipped configurations and one synchronous host on a multicast group: together they draw
// what one wide channel draws, of the same moments.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <future>
#include <map>

#include "support/places.h"
#include "system/live_run.h"
#include "system/program.h"
#include "system/rasters.h"

namespace eye::truth {
namespace {

constexpr const char* kGroup = "239.255.69.92";
constexpr int kWidth = 160, kHeight = 120;
constexpr double kFlightS = 4;

struct Channel {
  std::string name, config, frustum;
  int widthPx = kWidth;
};

std::string fileOf(const Channel& channel, const char* ending) {
  return testFile("live_" + channel.name + ending);
}

ProgramRun fly(const Channel& channel, const std::string& database, uint16_t port) {
  const bool answers = channel.name == "centre";  // questions; Start of Frame all of them
  return runProgram("eyepoint",
                    {"--headless",
                     "--terrain",
                     database,
                     "--config",
                     eye::test::kSourceDir + "/config/channel-" + channel.config + ".toml",
                     "--host",
                     fmt::format("cigi://{}:{}?interface=127.0.0.1{}", kGroup, port, answers ? "" : "&answers=no"),
                     "--view-offset",
                     "0,0,0",
                     "--frustum=" + channel.frustum,
                     "--size",
                     fmt::format("{}x{}", channel.widthPx, kHeight),
                     "--duration",
                     fmt::format("{}", kFlightS + 5),
                     "--stats",
                     fileOf(channel, ".jsonl"),
                     "--distance-map",
                     fileOf(channel, ".tif"),
                     "--screenshot",
                     fileOf(channel, ".png"),
                     "--log-level",
                     "error"});
}

// What the frames that showed each of the host's frames drew: the eye, of the newest.
std::map<uint32_t, nlohmann::json> eyesByHostFrame(const Channel& channel) {
  std::map<uint32_t, nlohmann::json> eyes;
  for (const nlohmann::json& frame : linesOf(fileOf(channel, ".jsonl")))
    if (!frame["host"]["frame"].is_null()) eyes[frame["host"]["frame"].get<uint32_t>()] = frame["eye"];
  return eyes;
}

}  // namespace

TEST_CASE("channels: three live ones of a synchronous host join to the wide picture, at the same host frame") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  // A flat wall of three times 60 degrees of one plane, as the configurations' comments have it.
  const double up = std::atan(std::tan(M_PI / 6) * kHeight / kWidth) * 180 / M_PI;
  const std::vector<Channel> all = {{"left", "left", fmt::format("-60,-30,{},{}", -up, up)},
                                    {"centre", "centre", fmt::format("-30,30,{},{}", -up, up)},
                                    {"right", "right", fmt::format("30,60,{},{}", -up, up)},
                                    {"wide", "left", fmt::format("-60,60,{},{}", -up, up), 3 * kWidth}};
  const std::string track = testFile("live_channels.csv");
  writeText(track,
            fmt::format("time,lat,lon,alt,heading,pitch,roll\n0,49.25,20.1,2600,180,-5,7\n{},49.24,20.1,2500,170,-8,"
                        "-5\n",
                        kFlightS));
  const uint16_t port = freePort();
  std::vector<std::future<ProgramRun>> flights;
  for (const Channel& channel : all) {
    for (const char* ending : {".jsonl", ".tif", ".png"}) std::filesystem::remove(fileOf(channel, ending));
    flights.push_back(std::async(std::launch::async, [&] { return fly(channel, database, port); }));
  }
  REQUIRE(awaitListeners(kGroup, port, all.size()));
  const ProgramRun host =
      runProgram("eyepoint-host", {"--protocol", "cigi", "--synchronous", "--channels", "4", "--rate", "60", "--to",
                                   fmt::format("{}:{}", kGroup, port), "--interface", "127.0.0.1", "--track", track,
                                   "--ask", "hot", "--ask-every", "1"});
  INFO(host.out << host.err);
  CHECK(host.exitCode == 0);
  for (size_t i = 0; i < all.size(); ++i) {
    const ProgramRun run = flights[i].get();
    INFO(all[i].name << ": " << run.err);
    REQUIRE(run.exitCode == 0);
  }

  // All of them have shown every frame of the host, though the wide one has three times the load and the others wait
  // for it; with the same eye, to the last digit. None was missed, and one channel alone has answered.
  const std::string said = host.out + host.err;
  CHECK(said.find("going on without it") == std::string::npos);
  CHECK(said.find("of 4 channels") != std::string::npos);
  const auto wideEyes = eyesByHostFrame(all[3]);
  REQUIRE_FALSE(wideEyes.empty());
  for (size_t i = 0; i < 3; ++i) {
    const auto eyes = eyesByHostFrame(all[i]);
    REQUIRE_FALSE(eyes.empty());
    CHECK(eyes.rbegin()->first == wideEyes.rbegin()->first);
    int differ = 0;
    for (const auto& [number, eye] : eyes) differ += !wideEyes.contains(number) || wideEyes.at(number) != eye;
    INFO(all[i].name << ": " << eyes.size() << " host frames, the wide channel " << wideEyes.size());
    CHECK(eyes.size() > 20);
    CHECK(eyes.size() == wideEyes.size());
    CHECK(eyes.size() == eyes.rbegin()->first - eyes.begin()->first + 1);  // no number is missing
    CHECK(differ == 0);
  }

  const RasterImage wideMap = readRaster(fileOf(all[3], ".tif")), widePicture = readRaster(fileOf(all[3], ".png"));
  REQUIRE((wideMap.widthPx == 3 * kWidth && widePicture.widthPx == 3 * kWidth));
  int sky = 0, otherSky = 0, otherDistance = 0, otherColour = 0;
  for (int i = 0; i < 3; ++i) {
    const Channel& channel = all[static_cast<size_t>(i)];
    const RasterImage map = readRaster(fileOf(channel, ".tif")), picture = readRaster(fileOf(channel, ".png"));
    REQUIRE((map.widthPx == kWidth && picture.widthPx == kWidth));
    for (int row = 0; row < kHeight; ++row) {
      for (int column = 0; column < kWidth; ++column) {
        const int wideColumn = i * kWidth + column;
        const float a = wideMap.at(0, row, wideColumn), b = map.at(0, row, column);
        sky += std::isnan(a);
        otherSky += std::isnan(a) != std::isnan(b);
        otherDistance += std::abs(a - b) > 2e-3f * a;
        float most = 0;
        for (int band = 0; band < 3; ++band)
          most = std::max(most, std::abs(widePicture.at(band, row, wideColumn) - picture.at(band, row, column)));
        otherColour += most > 6;  // of 255
      }
    }
  }
  // Edges fall to one pixel or the next by the rounding of their corners in the one grid and in the other.
  constexpr int kPixels = 3 * kWidth * kHeight;
  CAPTURE(sky, otherSky, otherDistance, otherColour);
  CHECK(sky > kPixels / 20);
  CHECK(sky < kPixels * 19 / 20);
  CHECK(otherSky < kPixels / 1000);
  CHECK(otherDistance < kPixels / 200);
  CHECK(otherColour < kPixels / 100);
}

}  // namespace eye::truth

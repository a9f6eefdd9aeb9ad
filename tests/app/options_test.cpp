#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "app/config_file.h"
#include "app/options.h"
#include "support/places.h"

using namespace eye;

namespace {

ParsedOptions parse(std::vector<const char*> words) {
  words.insert(words.begin(), "eyepoint");
  return parseOptions(static_cast<int>(words.size()), words.data());
}

struct TomlFile {
  std::string path =
      (std::filesystem::temp_directory_path() / ("eyepoint_options_" + std::to_string(getpid()) + ".toml")).string();
  explicit TomlFile(const std::string& text) { std::ofstream(path) << text; }
  ~TomlFile() { std::filesystem::remove(path); }
};

}  // namespace

TEST_CASE("the command line sets what it says") {
  const ParsedOptions parsed = parse({"--size",       "1280x720",  "--fov",    "75",        "--frustum=-30,20,-10,15",
                                      "--rate",       "max",       "--vsync",  "off",       "--sse",
                                      "0.5",          "--culling", "none",     "--horizon", "paper",
                                      "--background", "0,0.5,1",   "--frames", "10",        "--pose",
                                      "1,2,3,4,5,6",  "--sampler", "nearest",  "--samples", "4",
                                      "--bands",      "3"});
  REQUIRE_FALSE(parsed.exitStatus);
  const Options& o = parsed.options;
  CHECK(o.sampler == TextureFilter::nearest);
  CHECK(o.samples == 4);
  CHECK(o.bands == 3);
  CHECK(o.widthPx == 1280);
  CHECK(o.heightPx == 720);
  CHECK(o.fovDeg == 75);
  CHECK(*o.frustumDeg == std::array<double, 4>{-30, 20, -10, 15});
  CHECK(std::isinf(*o.rateHz));
  CHECK_FALSE(o.vsync);
  CHECK(o.ssePx == 0.5);
  CHECK(o.culling == CullingMode::none);
  CHECK(o.horizon == HorizonTest::paper);
  CHECK(*o.background == glm::vec3(0, 0.5f, 1));
  CHECK(*o.frames == 10);
  CHECK(o.hosts == std::vector<std::string>{"pose://1,2,3,4,5,6"});
}

TEST_CASE("the sun's date and hours: local or universal, on the command line or in a file") {
  const ParsedOptions parsed = parse({"--date", "2026-06-21", "--utc", "14.5"});
  REQUIRE_FALSE(parsed.exitStatus);
  REQUIRE(parsed.options.date);
  CHECK(parsed.options.date->month == 6);
  CHECK(parsed.options.date->day == 21);
  CHECK(*parsed.options.utcH == 14.5);
  CHECK(parse({"--date", "2024-02-29"}).options.date->day == 29);
  for (const char* date :
       {"2023-02-29", "2026-13-01", "26-01-01", "2026-1-1", "2026-01-01x", "1800-01-01", "today", "1e99-01-01"})
    CHECK(parse({"--date", date}).exitStatus == 2);
  CHECK(parse({"--utc", "12", "--time-of-day", "12"}).exitStatus == 2);

  const TomlFile file("utc = 3.0\ndate = 2026-12-21");
  const ParsedOptions fromFile = parse({"--config", file.path.c_str()});
  REQUIRE_FALSE(fromFile.exitStatus);
  CHECK(*fromFile.options.utcH == 3);
  CHECK(fromFile.options.date->month == 12);
  const ParsedOptions hoursWin = parse({"--config", file.path.c_str(), "--time-of-day", "9"});
  REQUIRE_FALSE(hoursWin.exitStatus);
  CHECK_FALSE(hoursWin.options.utcH);
  CHECK(*hoursWin.options.timeOfDayH == 9);
}

TEST_CASE("debug views are words with commas, and keys switch them") {
  const ParsedOptions parsed = parse({"--debug-view", "freeze,fate"});
  REQUIRE_FALSE(parsed.exitStatus);
  const DebugView view = parsed.options.debugView;
  CHECK(view == DebugView{.freeze = true, .depthMap = false, .tint = Tint::fate});
  CHECK(switched(view, {.freeze = 1, .depthMap = 3, .tint = 1}) == DebugView{.depthMap = true});
  CHECK(switched({}, {.tint = 4}) == DebugView{.tint = Tint::level});
  CHECK_FALSE(parse({}).options.debugView.any());
}

TEST_CASE("hosts may be given again") {
  const ParsedOptions parsed = parse({"--host", "demo://", "--host", "native-fdm://:5550"});
  REQUIRE_FALSE(parsed.exitStatus);
  CHECK(parsed.options.hosts == std::vector<std::string>{"demo://", "native-fdm://:5550"});
}

TEST_CASE("bad usage is one line and exit status 2") {
  const std::vector<std::vector<const char*>> bad{{"--size", "800"},
                                                  {"--size", "0x600"},
                                                  {"--size", "1e9x5"},
                                                  {"--size", "800x600x"},
                                                  {"--fov", "nan"},
                                                  {"--fov", "180"},
                                                  {"--frustum", "10,-10,-5,5"},
                                                  {"--frustum", "-10,10,-5"},
                                                  {"--rate", "-3"},
                                                  {"--rate", "fast"},
                                                  {"--view-offset", "-60"},
                                                  {"--view-offset", "0,91,0"},
                                                  {"--view-offset", "nan,0,0"},
                                                  {"--vsync", "maybe"},
                                                  {"--sse", "0"},
                                                  {"--culling", "all"},
                                                  {"--sampler", "best"},
                                                  {"--samples", "2"},
                                                  {"--samples", "8"},
                                                  {"--bands", "0"},
                                                  {"--bands", "5"},
                                                  {"--horizon", "flat"},
                                                  {"--frames", "0"},
                                                  {"--frames", "3.7"},
                                                  {"--frames", "1e3"},
                                                  {"--monitor", "-1"},
                                                  {"--background", "1,0"},
                                                  {"--background", "0,0,1.5"},
                                                  {"--background", "nan,0,0"},
                                                  {"--background=-0.1,0,0"},
                                                  {"--redraw", "never"},
                                                  {"--debug-view", "all"},
                                                  {"--debug-view", "freeze,"},
                                                  {"--debug-view", "level,fate"},
                                                  {"--colour"},
                                                  {"stray"},
                                                  {"--pose", "1,2,3,4,5,6", "--host", "demo://"},
                                                  {"--config", "/nonexistent.toml"}};
  for (const auto& words : bad) {
    const ParsedOptions parsed = parse(words);
    INFO(words[0] << " " << (words.size() > 1 ? words[1] : ""));
    CHECK(parsed.exitStatus == 2);
    CHECK_FALSE(parsed.text.empty());
    CHECK(parsed.text.find('\n') == std::string::npos);
  }
}

TEST_CASE("a slip of the keyboard is answered with the nearest option") {
  CHECK(parse({"--screenshoot", "a.png"}).text.find("--screenshot") != std::string::npos);
}

TEST_CASE("help teaches and version tells") {
  const ParsedOptions help = parse({"--help"});
  CHECK(help.exitStatus == 0);
  for (const char* word : {"--terrain", "--host", "--pose", "--sse", "Examples:", "native-fdm://"})
    CHECK(help.text.find(word) != std::string::npos);
  CHECK(parse({"--version"}).text.rfind("eyepoint 0.", 0) == 0);
  CHECK(parse({"--version"}).text.find("(commit ") != std::string::npos);
}

TEST_CASE("the configuration file gives what the command line leaves out") {
  const TomlFile file(
      "size = \"640x480\"\nsse = 2\nheadless = true\nhost = [\"demo://\", \"native-fdm://:5550\"]\nvsync = \"off\"\n");
  const ParsedOptions parsed = parse({"--config", file.path.c_str(), "--sse", "4"});
  INFO(parsed.text);
  REQUIRE_FALSE(parsed.exitStatus);
  CHECK(parsed.options.widthPx == 640);
  CHECK(parsed.options.ssePx == 4);
  CHECK(parsed.options.headless);
  CHECK_FALSE(parsed.options.vsync);
  CHECK(parsed.options.hosts.size() == 2);
}

TEST_CASE("the configuration file's mistakes name file, key and cure") {
  const auto message = [](const std::string& text) {
    const TomlFile file(text);
    const ParsedOptions parsed = parse({"--config", file.path.c_str()});
    CHECK(parsed.exitStatus == 2);
    CHECK(parsed.text.find(".toml") != std::string::npos);
    CHECK(parsed.text.find('\n') == std::string::npos);
    return parsed.text;
  };
  CHECK(message("terain = \"x.eyt\"\n").find("did you mean 'terrain'") != std::string::npos);
  CHECK(message("sse = [1, 2]\n").find("one value") != std::string::npos);
  CHECK(message("sse = \"coarse\"\n").find("sse") != std::string::npos);
  CHECK(message("size = 800\n").find("WxH") != std::string::npos);
  CHECK(message("sse = = 1\n").find(":1:") != std::string::npos);
  CHECK(message("[window]\nsize = 1\n").find("window") != std::string::npos);
}

TEST_CASE("the configuration file's values have the types of their options") {
  const auto refused = [](const std::string& line, const std::string& reason) {
    const TomlFile file(line + "\n");
    const ParsedOptions parsed = parse({"--config", file.path.c_str()});
    INFO(line << ": " << parsed.text);
    CHECK(parsed.exitStatus == 2);
    CHECK(parsed.text.find(file.path) != std::string::npos);
    CHECK(parsed.text.find(reason) != std::string::npos);
    CHECK(parsed.text.find('\n') == std::string::npos);
  };
  refused("headless = \"maybe\"", "headless takes true or false; got \"maybe\"");
  refused("headless = 1", "headless takes true or false; got 1");
  refused("headless = \"true\"", "headless takes true or false");
  refused("frames = 3.7", "'3.7' is not a whole number from 1");
  refused("frames = \"10\"", "frames takes a number");
  refused("frames = -1", "'-1' is not a whole number");
  refused("cache-ram = 96.5", "'96.5' is not a whole number from 8 to");
  refused("sse = \"2\"", "sse takes a number");
  refused("sse = true", "sse takes a number");
  refused("sse = nan", "'nan' is not a number from");
  refused("screenshot = true", "screenshot takes text in quotes, FILE.png; got true");
  refused("terrain = 5", "terrain takes text in quotes");
  refused("vsync = 1", "vsync takes text in quotes, on/off; got 1");
  refused("vsync = \"maybe\"", "neither on nor off");
  refused("horizon = \"flat\"", "horizon");
  refused("background = \"0,0,2\"", "R,G,B from 0 to 1");
  refused("host = [\"demo://\", 3]", "host takes text in quotes");
  const TomlFile file("frames = 10\nheadless = false\nvsync = true\nrate = 30\nsse = 2\nhorizon = \"paper\"\n");
  const ParsedOptions parsed = parse({"--config", file.path.c_str()});
  INFO(parsed.text);
  REQUIRE_FALSE(parsed.exitStatus);
  CHECK(*parsed.options.frames == 10);
  CHECK(parsed.options.vsync);
  CHECK(*parsed.options.rateHz == 30);
  CHECK(parsed.options.ssePx == 2);
  CHECK(parsed.options.horizon == HorizonTest::paper);
}

TEST_CASE("every documented key of the example configuration is known") {
  const std::string path = eye::test::kSourceDir + "/config/eyepoint.toml";
  const ParsedOptions parsed = parse({"--config", path.c_str()});
  INFO(parsed.text);
  CHECK_FALSE(parsed.exitStatus);
}

TEST_CASE("the example channels look left, ahead and right, and one of them answers") {
  const std::pair<std::string, double> channels[] = {{"left", -60}, {"centre", 0}, {"right", 60}};
  for (const auto& [name, headingDeg] : channels) {
    const std::string path = eye::test::kSourceDir + "/config/channel-" + name + ".toml";
    const ParsedOptions parsed = parse({"--config", path.c_str()});
    INFO(name << ": " << parsed.text);
    REQUIRE_FALSE(parsed.exitStatus);
    const Options& o = parsed.options;
    CHECK(o.viewOffsetDeg == std::array<double, 3>{headingDeg, 0, 0});
    CHECK(o.fovDeg == 60);
    CHECK(o.rateOfHost);
    CHECK(o.hostDelay == HostDelayMode::off);
    REQUIRE(o.hosts.size() == 1);
    CHECK(o.hosts[0].ends_with("?answers=no") == (name != "centre"));
    CHECK(parse({"--config", path.c_str(), "--rate", "30"}).options.rateHz == 30);
    CHECK_FALSE(parse({"--config", path.c_str(), "--rate", "30"}).options.rateOfHost);
  }
}

TEST_CASE("an option wins over the file's keys that say the same thing in another way") {
  const TomlFile file("pose = \"1,2,3,4,5,6\"\nfrustum = \"-30,30,-20,20\"\n");
  const ParsedOptions parsed = parse({"--config", file.path.c_str(), "--host", "demo://", "--fov", "40"});
  INFO(parsed.text);
  REQUIRE_FALSE(parsed.exitStatus);
  CHECK(parsed.options.hosts == std::vector<std::string>{"demo://"});
  CHECK(parsed.options.fovDeg == 40);
  CHECK_FALSE(parsed.options.frustumDeg);
}

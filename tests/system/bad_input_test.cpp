// Whatever is wrong: an exit status that says so, one line on stderr that says what, and never a crash.
#include <fmt/format.h>
#include <sys/mount.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <random>
#include <regex>

#include "system/program.h"
#include "system/rasters.h"

namespace eye::truth {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kOnePicture{"--headless",  "--pose", "46.015,8.015,2000,0,-30,0", "--size", "64x48",
                                           "--log-level", "error"};

std::vector<std::string> picture(const std::string& database, std::vector<std::string> more = {}) {
  std::vector<std::string> words = kOnePicture;
  words.insert(words.end(), {"--terrain", database});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

HeightGrid hills(int posts) {
  return HeightGrid({46, 8, 1.0 / 1200, posts, posts},
                    [](double lat, double lon) { return 800 + 500 * std::sin(lat * 300) * std::cos(lon * 200); });
}

// A database of a few tiles, baked once a test program.
const std::string& tinyDatabase() {
  static const std::string path = [] {
    std::string file = testFile("tiny.eyt");
    const std::string source = testFile("tiny.tif");
    writeElevation(source, hills(41));
    fs::remove(file);
    const ProgramRun bake = runProgram("eyepoint-bake", {"--elevation", source, "--error", "4", "--out", file});
    INFO(bake.err);
    REQUIRE(bake.exitCode == 0);
    return file;
  }();
  return path;
}

void expectFailure(const std::string& program, const std::vector<std::string>& words, int status,
                   const std::string& pattern, const RunSettings& settings = {}) {
  const ProgramRun run = runProgram(program, words, settings);
  INFO(program << " " << joined(words) << "\nstderr: " << run.err);
  CHECK(run.signal == 0);
  CHECK(run.exitCode == status);
  CHECK(run.errorLines().size() == 1);
  CHECK(std::regex_search(run.err, std::regex(pattern, std::regex::icase)));
}

}  // namespace

TEST_CASE("bad input: no Vulkan driver") {
  const RunSettings none{
      .environment = {{"VK_DRIVER_FILES", "/nonexistent.json"}, {"VK_ICD_FILENAMES", "/nonexistent.json"}},
      .timeoutS = 60};
  expectFailure("eyepoint", picture(tinyDatabase()), 1, "vulkan.*(driver|mesa)", none);
  expectFailure("eyepoint", {"--list-devices"}, 1, "vulkan.*(driver|mesa)", none);
  expectFailure("eyepoint", picture(tinyDatabase(), {"--device", "no such card"}), 1, "no such card");
}

TEST_CASE("bad input: a database that is missing, empty, foreign or cut short") {
  expectFailure("eyepoint", picture("/nonexistent/alps.eyt"), 1, "/nonexistent/alps.eyt");
  expectFailure("eyepoint-bake", {"verify", "/nonexistent/alps.eyt"}, 1, "/nonexistent/alps.eyt");
  const std::string file = testFile("damaged.eyt");
  writeText(file, "");
  expectFailure("eyepoint", picture(file), 1, "damaged.eyt");
  writeText(file,
            "this is a letter to my aunt, not terrain, although it is longer than the header of a database would be");
  expectFailure("eyepoint", picture(file), 1, "damaged.eyt");
  expectFailure("eyepoint-bake", {"info", file}, 1, "damaged.eyt");
  const std::string whole = readText(tinyDatabase());
  for (const double share : {0.01, 0.3, 0.6, 0.95}) {
    writeText(file, whole.substr(0, static_cast<size_t>(static_cast<double>(whole.size()) * share)));
    const ProgramRun run = runProgram("eyepoint", picture(file));
    INFO(share << " of the file: " << run.err);
    CHECK(run.signal == 0);
    CHECK((run.exitCode == 0 || run.exitCode == 1));
    const ProgramRun verify = runProgram("eyepoint-bake", {"verify", file});
    INFO(verify.err);
    CHECK(verify.exitCode == 1);
  }
}

TEST_CASE("bad input: 200 databases with random bits flipped never crash eyepoint") {
  const std::string whole = readText(tinyDatabase()), file = testFile("flipped.eyt");
  std::mt19937 random(5);
  int drawn = 0, refused = 0, detected = 0;
  for (int i = 0; i < 200; ++i) {
    std::string bytes = whole;
    // The first page holds the schema: a third of the damage goes there and to the pages behind it.
    const size_t range = i % 3 == 0 ? std::min<size_t>(bytes.size(), 16384) : bytes.size();
    for (int flip = 0; flip <= i % 4; ++flip) bytes[random() % range] ^= static_cast<char>(1 << random() % 8);
    writeText(file, bytes);
    const ProgramRun run = runProgram("eyepoint", picture(file), {.environment = {}, .timeoutS = 20});
    INFO("flip " << i << ": exit " << run.exitCode << " signal " << run.signal << "\n" << run.err);
    REQUIRE(run.signal == 0);
    REQUIRE_FALSE(run.timedOut);
    REQUIRE((run.exitCode == 0 || run.exitCode == 1));
    drawn += run.exitCode == 0;
    refused += run.exitCode == 1;
    if (i % 4 == 0) {
      const ProgramRun verify = runProgram("eyepoint-bake", {"verify", file}, {.environment = {}, .timeoutS = 20});
      INFO(verify.err);
      REQUIRE((verify.exitCode == 0 || verify.exitCode == 1));
      detected += verify.exitCode == 1;
    }
  }
  fmt::print("bit flips: {} drawn, {} refused; verify found {} of 50\n", drawn, refused, detected);
  CHECK(detected > 0);
}

TEST_CASE("bad input: elevation without a place, without a value, without a file") {
  const std::string out = testFile("never.eyt");
  const std::string nowhere = testFile("nowhere.tif");
  writeElevation(nowhere, hills(60), false);
  expectFailure("eyepoint-bake", {"--elevation", nowhere, "--out", out}, 1, "nowhere.tif.*(gdal|georeference)");
  const std::string voids = testFile("voids.tif");
  writeElevation(voids, HeightGrid({46, 8, 1.0 / 1200, 60, 60},
                                   [](double, double) { return std::numeric_limits<double>::quiet_NaN(); }));
  expectFailure("eyepoint-bake", {"--elevation", voids, "--out", out}, 1, "voids.tif");
  const std::string empty = testFile("empty_folder");
  fs::create_directories(empty);
  expectFailure("eyepoint-bake", {"--elevation", empty, "--out", out}, 1, "empty_folder");
  expectFailure("eyepoint-bake", {"--elevation", "/nonexistent.tif", "--out", out}, 1, "/nonexistent.tif");
  const std::string text = testFile("notes.tif");
  writeText(text, "no raster at all");
  expectFailure("eyepoint-bake", {"--elevation", text, "--out", out}, 1, "notes.tif");
}

TEST_CASE("bad input: a disk that fills up during a bake leaves a valid database and one line") {
  const std::string folder = testFile("full_disk");
  fs::create_directories(folder);
  if (mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=1m") != 0) {
    WARN("mounting a small tmpfs is not permitted here: this test checks nothing");
    return;
  }
  const std::string source = testFile("full_disk.tif"), file = folder + "/big.eyt";
  writeElevation(source, hills(601));
  const ProgramRun run = runProgram("eyepoint-bake", {"--elevation", source, "--out", file});
  const ProgramRun info = runProgram("eyepoint-bake", {"info", file});
  umount2(folder.c_str(), MNT_DETACH);
  INFO("bake: " << run.err << "\ninfo: " << info.err);
  CHECK(run.exitCode == 1);
  CHECK(run.signal == 0);
  CHECK(std::regex_search(run.errorLines().back(), std::regex("(full|space)", std::regex::icase)));
  CHECK(info.signal == 0);
}

TEST_CASE("bad input: options") {
  const std::string file = tinyDatabase();
  struct Case {
    std::vector<std::string> words;
    std::string pattern;
  };
  const std::vector<Case> cases{
      {{"--siez", "800x600"}, "siez.*--size"},
      {{"--size", "800"}, "--size.*800"},
      {{"--size", "0x600"}, "--size"},
      {{"--size", "99999x99999"}, "--size"},
      {{"--fov", "190"}, "--fov"},
      {{"--fov", "wide"}, "--fov"},
      {{"--sse", "nan"}, "--sse"},
      {{"--sse", "-1"}, "--sse"},
      {{"--frames", "-3"}, "--frames"},
      {{"--duration", "0"}, "--duration"},
      {{"--rate", "fast"}, "--rate"},
      {{"--frustum", "10,-10,5,-5"}, "--frustum"},
      {{"--culling", "magic"}, "--culling"},
      {{"--cache-gpu", "0"}, "--cache-gpu"},
      {{"--pose", "91,0,100,0,0,0"}, "lat"},
      {{"--pose", "46,8,1000,0,0"}, "pose"},
      {{"--pose", "46,8,nan,0,0,0"}, "(pose|alt)"},
      {{"--host", "gopher://x"}, "gopher"},
      {{"--host", "file:///nonexistent.csv"}, "nonexistent.csv"},
      {{"--host", "native-fdm://127.0.0.1:99999"}, "99999"},
      {{"--time-of-day", "25"}, "--time-of-day"},
      {{"--utc", "nan"}, "--utc"},
      {{"--utc", "12", "--time-of-day", "12"}, "--utc"},
      {{"--date", "2026-02-29"}, "--date"},
      {{"--date", "1.4.2026"}, "--date"},
      {{"--log-level", "loud"}, "--log-level"},
      {{"--pose"}, "--pose"},
      {{"stray"}, "stray"},
  };
  for (const Case& bad : cases) {
    std::vector<std::string> words{"--headless", "--terrain", file};
    words.insert(words.end(), bad.words.begin(), bad.words.end());
    const ProgramRun run = runProgram("eyepoint", words, {.environment = {}, .timeoutS = 20});
    INFO(joined(words) << "\nstderr: " << run.err);
    CHECK(run.signal == 0);
    // A file that is not there is no misuse of the option that names it.
    CHECK(run.exitCode == (bad.pattern == "nonexistent.csv" ? 1 : 2));
    CHECK(run.errorLines().size() == 1);
    CHECK(std::regex_search(run.err, std::regex(bad.pattern)));
  }
  expectFailure("eyepoint-bake", {"--elevation", file}, 2, "--out");
  expectFailure("eyepoint-bake", {"--out", file}, 2, "--elevation");
  expectFailure("eyepoint-bake", {"--elevation", file, "--out", file, "--error", "-1"}, 2, "--error");
  expectFailure("eyepoint-bake", {"--elevation", file, "--out", file, "--region", "10,0,5,20"}, 2, "--region");
  expectFailure("eyepoint-host", {"--protocol", "morse", "--to", "127.0.0.1:5550", "--scenario", "orbit"}, 2,
                "native-fdm");
  expectFailure("eyepoint-host", {"--protocol", "native-fdm", "--to", "127.0.0.1:5550", "--scenario", "picnic"}, 2,
                "takeoff");
}

TEST_CASE("bad input: configuration files") {
  const std::string file = tinyDatabase(), config = testFile("bad.toml");
  const auto refused = [&](const std::string& text, const std::string& pattern) {
    writeText(config, text);
    INFO("bad.toml: " << text);
    expectFailure("eyepoint", picture(file, {"--config", config}), 2, pattern);
  };
  refused("visibilty = 20000\n", "visibilty.*visibility");
  refused("sse = \n", "bad.toml:1");
  refused("sse = -4\n", "sse");
  refused("fov = [60, 70]\n", "fov");
  refused("fov = { wide = true }\n", "fov");
  refused(std::string("\xff\xfe\x00\x01garbage", 11), "bad.toml");
  expectFailure("eyepoint", picture(file, {"--config", "/nonexistent.toml"}), 2, "/nonexistent.toml");
  // And a good one works, its values under those of the command line.
  writeText(config, "sse = 4.0\nheadless = true\nsize = \"640x480\"\n");
  const std::string summary = testFile("config_summary.json");
  const ProgramRun run = runProgram("eyepoint", picture(file, {"--config", config, "--summary", summary}));
  INFO(run.err);
  CHECK(run.exitCode == 0);
  const std::string settings = readText(summary);
  CHECK_THAT(settings, Catch::Matchers::Contains("size=64x48 ") && Catch::Matchers::Contains(" sse=4 "));
}

TEST_CASE("bad input: outputs that cannot be written") {
  const std::string file = tinyDatabase();
  for (const std::string option : {"--screenshot", "--distance-map", "--stats", "--summary", "--trace"}) {
    expectFailure("eyepoint", picture(file, {option, "/nonexistent/folder/out.file"}), 1,
                  "/nonexistent/folder/out.file");
    expectFailure("eyepoint", picture(file, {option, "/dev/full"}), 1, "/dev/full.*(space|full|write)");
  }
  expectFailure("eyepoint", picture(file, {"--frames-dir", "/proc/frames"}), 1, "/proc/frames");
  expectFailure("eyepoint-bake",
                {"--elevation", testFile("tiny.tif"), "--out", "/nonexistent/folder/out.eyt", "--log-level", "error"},
                1, "/nonexistent/folder");
  expectFailure("eyepoint", picture(file, {"--summary", testFile("")}), 1, "folder");
}

TEST_CASE("bad input: an output that cannot be written keeps none of the others back") {
  const std::string file = tinyDatabase();
  const std::vector<std::pair<std::string, std::string>> outputs{{"--screenshot", testFile("kept.png")},
                                                                 {"--distance-map", testFile("kept.tif")},
                                                                 {"--stats", testFile("kept.jsonl")},
                                                                 {"--summary", testFile("kept.json")},
                                                                 {"--trace", testFile("kept.trace")}};
  for (const auto& [full, unused] : outputs) {
    std::vector<std::string> words = picture(file);
    for (const auto& [option, path] : outputs) {
      fs::remove(path);
      words.insert(words.end(), {option, option == full ? "/dev/full" : path});
    }
    expectFailure("eyepoint", words, 1, "/dev/full");
    for (const auto& [option, path] : outputs) {
      INFO(full << " cannot be written: " << path);
      CHECK((option == full || (fs::exists(path) && fs::file_size(path) > 0)));
    }
  }
}

TEST_CASE("bad input: a flight that ends before its last frame was known still leaves its picture") {
  const std::string file = tinyDatabase(), png = testFile("early_end.png"), map = testFile("early_end.tif");
  fs::remove(png);
  fs::remove(map);
  const ProgramRun run = runProgram("eyepoint", picture(file, {"--frames", "1000000", "--duration", "0.2",
                                                               "--screenshot", png, "--distance-map", map}));
  INFO(run.err);
  CHECK(run.exitCode == 0);
  CHECK(fs::exists(png));
  CHECK(fs::exists(map));
}

TEST_CASE("bad input: a cache too small for the view is said once, with what to give") {
  const std::string database = carpathiaDatabase();
  if (database.empty()) return;
  const auto run = [&](const std::string& cacheMiB) {
    return runProgram("eyepoint", {"--headless", "--offline", "--redraw", "always", "--frames", "3", "--size",
                                   "640x480", "--sse", "0.5", "--pose", "49.25,20.1,2600,180,-5,0", "--cache-gpu",
                                   cacheMiB, "--log-level", "warn", "--terrain", database});
  };
  const ProgramRun small = run("24"), ample = run("400");
  INFO(small.err << ample.err);
  CHECK(small.exitCode == 0);
  CHECK(small.errorLines().size() == 1);
  CHECK(std::regex_search(small.err, std::regex("3 of 3 frames drawn.*--cache-gpu 24 is too small; give 48")));
  CHECK(ample.exitCode == 0);
  CHECK(ample.err.empty());
}

}  // namespace eye::truth

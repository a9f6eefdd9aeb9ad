#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <limits>

#include <unistd.h>
#include <nlohmann/json.hpp>

#include "app/statistics.h"

using namespace eye;

namespace {

std::string temporary(const std::string& name) {
  return (std::filesystem::temp_directory_path() / (std::to_string(getpid()) + name)).string();
}

FrameRecord frameOf(double frameMs, bool drawn = true) {
  FrameRecord record;
  record.frameMs = frameMs;
  record.drawn = drawn;
  record.triangles = 1000;
  record.pose = Pose{{49.25, 20.1, 2600}, 180, -1, 2};
  record.passes = {{"geometry", 1.5}};
  return record;
}

}  // namespace

TEST_CASE("quantiles of a known sample") {
  std::vector<double> values;
  for (int i = 100; i >= 0; --i) values.push_back(i);
  const TimeSummary times = summarize(values);
  CHECK(times.mean == Approx(50));
  CHECK(times.median == Approx(50));
  CHECK(times.p95 == Approx(95));
  CHECK(times.p99 == Approx(99));
  CHECK(times.max == 100);
  CHECK(summarize({}).max == 0);
  CHECK(summarize({3.0}).p99 == 3.0);
}

TEST_CASE("a line of statistics has every key") {
  const std::string path = temporary("_stats.jsonl");
  {
    auto file = StatisticsFile::create(path);
    REQUIRE(file);
    REQUIRE(file->write(frameOf(7.25)));
    REQUIRE(file->close());
  }
  std::ifstream in(path);
  const auto json = nlohmann::json::parse(in);
  for (const char* key : {"frame", "time_s", "pose", "frame_ms", "cpu_ms", "gpu_ms", "pass_ms", "triangles", "vertices",
                          "draws", "chunks", "clusters", "depth_map", "membership", "paging", "prediction", "host"})
    CHECK(json.contains(key));
  for (const char* key :
       {"considered", "frustum_culled", "horizon_culled", "backface_culled", "occlusion_culled", "drawn"})
    CHECK(json["chunks"].contains(key));
  for (const char* key :
       {"requested", "loaded", "evicted", "resident", "ram_bytes", "gpu_bytes", "missing", "bytes_read"})
    CHECK(json["paging"].contains(key));
  for (const char* key : {"packets", "rejected", "unread", "lost", "frame", "age_ms"})
    CHECK(json["host"].contains(key));
  CHECK(json["frame_ms"] == 7.25);
  CHECK(json["pose"][0] == 49.25);
  CHECK(json["pass_ms"]["geometry"] == 1.5);
  std::filesystem::remove(path);
}

TEST_CASE("the summary counts drawn frames alone and those over 1000/60 ms") {
  RunSummary summary;
  summary.add(frameOf(10));
  summary.add(frameOf(16.6));
  summary.add(frameOf(16.7));
  summary.add(frameOf(500, false));
  const std::string path = temporary("_summary.json");
  REQUIRE(summary.write(path, "a device", 321, "settings"));
  std::ifstream in(path);
  const auto json = nlohmann::json::parse(in);
  CHECK(json["frames"] == 4);
  CHECK(json["over_budget_frames"] == 1);
  CHECK(json["frame_ms"]["max"] == 16.7);
  CHECK(json["triangles_mean"] == 1000);
  CHECK(json["fps"].get<double>() == Approx(1000.0 / ((10 + 16.6 + 16.7) / 3)));
  CHECK(json["startup_ms"] == 321);
  CHECK(json["peak_rss_bytes"].get<uint64_t>() > 1000000);
  for (const char* key : {"vertices_mean", "missing_chunk_frames", "bytes_read", "device", "settings"})
    CHECK(json.contains(key));
  std::filesystem::remove(path);
}

TEST_CASE("outputs that cannot be written are errors that name the file") {
  CHECK(StatisticsFile::create("/nonexistent/a.jsonl").error().message.find("/nonexistent/a.jsonl") !=
        std::string::npos);
  CHECK(RunSummary().write("/nonexistent/b.json", "", 0, "").error().message.find("b.json") != std::string::npos);
  if (std::filesystem::exists("/dev/full")) {
    auto file = StatisticsFile::create("/dev/full");
    REQUIRE(file);
    (void)file->write(frameOf(1));
    const auto closed = file->close();
    REQUIRE_FALSE(closed);
    CHECK(closed.error().kind == ErrorKind::noSpace);
  }
}

// Every suite from its start to its report, over a small database.
#include <map>
#include <set>

#include <spdlog/spdlog.h>
#include <catch2/catch.hpp>

#include "bench/small_database.h"
#include "bench/suites.h"
#include "render/renderer.h"

namespace eye {
namespace {

std::optional<SuiteReport> quickly(Result<SuiteReport> (*suite)(const SuiteOptions&)) {
  const auto devices = Renderer::listDevices();
  if (!devices || devices->empty()) {
    WARN("no Vulkan device: not tested");
    return std::nullopt;
  }
  double lastShare = -1;
  SuiteOptions options;
  options.terrain = smallDatabase();
  options.quick = true;
  options.progress = [&](const std::string&, double share) {
    CHECK((share >= lastShare && share < 1));
    lastShare = share;
  };
  Result<SuiteReport> report = suite(options);
  INFO((report ? std::string() : report.error().message));
  REQUIRE(report);
  CHECK(lastShare > 0);
  CHECK_FALSE(report->device.empty());
  return *report;
}

void requireKeys(const nlohmann::ordered_json& object, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    INFO(key);
    REQUIRE(object.contains(key));
  }
}

}  // namespace

TEST_CASE("Suite culling: every scheme at every height, and the published figures where there are any") {
  const auto report = quickly(runCullingSuite);
  if (!report) return;
  requireKeys(report->summary, {"saved_cpu_low_level", "worst_loss", "pass_ms"});
  CHECK(report->rows.size() == 2 * 2 * 4);  // places, altitudes, schemes
  for (const auto& row : report->rows) {
    requireKeys(row, {"altitude_ft", "scheme", "size", "place", "triangles", "vertices", "fps", "frame_ms", "cpu_ms",
                      "published_triangles", "published_fps"});
    CHECK(row["cpu_ms"] > 0);
    CHECK(row["triangles"] > 0);
    CHECK(row["visible_share"] > 0);
    CHECK(row["visible_share"] <= 1);
    CHECK(row["published_fps"].is_number() == (row["altitude_ft"] == 2000 && row["scheme"] != "dynamic_320x240"));
  }
  for (size_t i = 0; i < report->rows.size(); i += 4) {  // none, frustum, dynamic, with the pass always
    CHECK(report->rows[i]["scheme"] == "none");
    CHECK(report->rows[i]["triangles"] > report->rows[i + 1]["triangles"]);
    CHECK(report->rows[i + 1]["triangles"] >= report->rows[i + 2]["triangles"]);
    CHECK(report->rows[i + 1]["triangles"] > report->rows[i + 3]["triangles"]);
    CHECK(report->rows[i + 3]["depth_map"] == "320x240");
  }
  CHECK(report->rows[6]["published_triangles"] == 2176);
}

TEST_CASE("Suite selector: every fixed choice and both modes on the same frames") {
  const auto report = quickly(runSelectorSuite);
  if (!report) return;
  requireKeys(report->summary, {"adaptive_regret", "paper_regret", "worst_600_frames_loss", "frames"});
  std::set<std::string> modes;
  for (const auto& row : report->rows) {
    requireKeys(row, {"mode", "cpu_ms", "regret", "used"});
    modes.insert(row["mode"].get<std::string>());
    CHECK(row["cpu_ms"] > 0);
    double shares = 0;
    for (const auto& [name, share] : row["used"].items()) shares += share.get<double>();
    CHECK(shares == Approx(1));
  }
  CHECK(modes == std::set<std::string>{"off", "320x240", "400x300", "640x480", "800x600", "adaptive", "paper"});
  CHECK(report->rows[1]["used"]["320x240"] == 1.0);  // a fixed choice uses nothing else
  CHECK(report->rows[0]["used"]["off"] == 1.0);
  CHECK(report->rows[0]["worst_600_frames_loss"] == 0.0);  // off against itself
}

TEST_CASE("Suite flight: every task with and without prediction, in real time") {
  const auto report = quickly(runFlightSuite);
  if (!report) return;
  requireKeys(report->summary, {"bytes_saved", "unpredicted_widening", "paging_cost", "prediction"});
  CHECK(report->summary["paging_cost"] > 0);
  REQUIRE(report->rows.size() >= 3 * 2);
  for (size_t i = 0; i < report->rows.size(); ++i) {
    const auto& row = report->rows[i];
    requireKeys(row, {"task", "rate_hz", "predictor", "missed_frames", "missing_chunk_frames", "bytes_read", "frame_ms",
                      "cpu_ms", "smoothness", "published", "pager"});
    CHECK(row["rate_hz"] == 25);
    CHECK(row["slots"] == 51);  // 2 s
    CHECK(row["slots"] == row["frames"].get<int>() + row["missed_frames"].get<int>());
    CHECK(row["bytes_read"] > 0);
    CHECK(row["missing_chunk_frames"] > 0);  // cold: the first picture is never complete
    CHECK(row["frame_ms"]["max"] >= row["frame_ms"]["median"]);
    if (i < 6) CHECK(row["predictor"] == (i % 2 == 0 ? "none" : "kalman"));
  }
  CHECK(report->plots.size() == 2);
}

TEST_CASE("Suite host: every protocol, flood and link, with figures that can be") {
  const auto report = quickly(runHostSuite);
  if (!report) return;
  requireKeys(report->summary, {"transport_delay_ms", "transport_delay_p99_ms"});
  CHECK(report->summary["transport_delay_ms"] > 0);
  CHECK(report->summary["transport_delay_ms"] < 2000);
  std::set<std::string> protocols;
  double answered = 0, followed = 0, received = 0, unread = 0;
  for (const auto& row : report->rows) {
    requireKeys(row, {"protocol", "case", "value", "unit"});
    protocols.insert(row["protocol"].get<std::string>());
    REQUIRE(row["value"].is_number());
    const std::string name = row["case"].get<std::string>();
    if (name == "a thousand heights a frame: answered") answered = row["value"];
    if (name == "flood of valid state from a stranger: frames that follow within 0.1 s") followed = row["value"];
    if (name == "flood of valid state from the host: received") received = row["value"];
    if (name == "flood of garbage from a stranger: dropped unread") unread = row["value"];
  }
  CHECK(protocols == std::set<std::string>{"native-fdm", "CIGI 3.3", "CIGI 4.0", "CIGI"});
  CHECK(answered > 0.5);
  CHECK(followed > 0.5);
  CHECK(received > 1000);
  CHECK(unread > 1000);
}

TEST_CASE("Suite stability: every figure has a limit, and keeps within it") {
  const auto report = quickly(runStabilitySuite);
  if (!report) return;
  CHECK(report->summary["failures"] == 0);
  CHECK(report->rows.size() > 40);
  for (const auto& row : report->rows) {
    requireKeys(row, {"case", "figure", "limit", "unit", "holds"});
    INFO(row.dump());
    CHECK(row["holds"] == true);
  }
}

TEST_CASE("Suite globe: the paper's five distances, and flights over the poles and along the date line") {
  const auto report = quickly(runGlobeSuite);
  if (!report) return;
  REQUIRE(report->rows.size() == 5);
  for (size_t i = 0; i < 5; ++i) {
    const auto& row = report->rows[i];
    requireKeys(row, {"distance_km", "level", "blocks", "visible", "culled_share", "fps", "published_culled_share"});
    CHECK(row["level"] == row["published_level"]);
    CHECK(row["blocks"] == row["published_blocks"]);  // also below where the small database ends
    CHECK(row["visible"] > 0);
    CHECK(row["visible"] <= row["blocks"]);
    CHECK(row["fps"] > 0);
  }
  REQUIRE(report->summary["flights"].size() == 3);
  for (const auto& flight : report->summary["flights"]) {
    CHECK(flight["frames"] > 0);
    CHECK(flight["hole_pixels"] == 0);
  }
}

TEST_CASE("Suite panorama: every method's shares and metrics, and the published ones") {
  const auto report = quickly(runPanoramaSuite);
  if (!report) return;
  requireKeys(report->summary, {"mape", "r2", "rmse_m", "peaks"});
  REQUIRE(report->summary["peaks"] > 3);
  CHECK(report->summary["mape"] < 0.03);
  CHECK(report->rows.size() >= 5 * 3 + 3 + 4);  // and where there are enough peaks, corrected by a line
  CHECK(report->summary["viewpoints"] == 3);
  CHECK(report->summary["peaks_camera_lower"] > 0);
  for (const auto& row : report->rows) {
    requireKeys(row, {"method", "camera", "within", "peaks"});
    CHECK(row["within"].size() == 8);
    if (row["method"] != "range" || row["camera"] != "all") continue;
    CHECK(row["within"][0] > 0.98);
    CHECK(row["peaks"] == report->summary["peaks"]);
  }
  CHECK(report->rows.back()["camera"] == "lower_regression");
  CHECK(report->tables.size() == 4);
  CHECK(report->plots.size() == 2);
}

TEST_CASE("Suite pareto: each axis with time and error, the default on the front, and the floor") {
  const auto report = quickly(runParetoSuite);
  if (!report) return;
  requireKeys(report->summary, {"default_on_front", "floor_ratio", "truth"});
  CHECK(report->summary["default_on_front"].is_boolean());
  CHECK(report->summary["floor_ratio"] > 1);
  std::map<double, nlohmann::ordered_json> byTolerance;
  std::set<std::string> samplers, cullings, sizes;
  int defaults = 0;
  for (const auto& row : report->rows) {
    requireKeys(row, {"sse", "culling", "depth_map", "sampler", "samples", "size", "cpu_ms", "wall_ms", "triangles",
                      "explained", "distance_p99", "psnr_db", "ssim", "skyline_px", "on_front"});
    CHECK(row["missing_chunks"] == 0);
    CHECK(row["cpu_ms"] > 0);
    CHECK(row["psnr_db"] > 15);
    CHECK(row["explained"] > 0.5);
    samplers.insert(row["sampler"]);
    cullings.insert(row["culling"]);
    sizes.insert(row["size"]);
    defaults += row["is_default"].get<bool>();
    if (row["culling"] == "dynamic" && row["depth_map"] == "auto" && row["samples"] == 1 && row["size"] == "800x600" &&
        row["sampler"] == report->rows[0]["sampler"])
      byTolerance[row["sse"]] = row;
  }
  CHECK(defaults == 1);
  CHECK(samplers.size() == 3);
  CHECK(cullings == std::set<std::string>{"none", "frustum", "dynamic"});
  CHECK(sizes == std::set<std::string>{"800x600", "1280x720"});
  REQUIRE(byTolerance.size() == 7);
  // Sixteen pixels against a quarter of one. How many triangles are drawn hangs on whether the selector has settled.
  const auto &coarse = byTolerance.at(16), &fine = byTolerance.at(0.25);
  CHECK(coarse["distance_p99"] > fine["distance_p99"]);
  CHECK(coarse["explained"] < fine["explained"]);
  CHECK(coarse["psnr_db"] < fine["psnr_db"]);
  CHECK(fine["explained"] > 0.999);
  CHECK(report->plots.size() == 4);
}

TEST_CASE("Suite floor: a frame has more triangles than its floor and takes longer") {
  const auto report = quickly(runFloorSuite);
  if (!report) return;
  CHECK(report->summary["floor_ratio"] > 1);
  CHECK(report->rows.size() == 3);
  for (const auto& row : report->rows) {
    CHECK(row["visible"] > 0);
    CHECK(row["visible"] < row["submitted"]);
    CHECK(row["cpu_ms"]["floor"] > row["cpu_ms"]["bare_terrain"]);
    CHECK(row["differing_px"] < 800 * 600 / 1000);
  }
}

TEST_CASE("A suite over no database says so") {
  SuiteOptions options;
  options.terrain = "/nowhere/none.eyt";
  for (const Suite& suite : suites()) {
    const auto report = suite.run(options);
    REQUIRE_FALSE(report);
    CHECK(report.error().message.find("/nowhere/none.eyt") != std::string::npos);
  }
}

}  // namespace eye

#include "app/statistics.h"

#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace eye {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kFrameBudgetMs = 1000.0 / 60.0;

Json membershipOf(const std::optional<Decision>& decision) {
  if (!decision) return {{"altitude", nullptr}, {"pitch", nullptr}, {"sum", nullptr}};
  return {{"altitude", decision->altitudeMembership}, {"pitch", decision->pitchMembership}, {"sum", decision->sum}};
}

Json poseOf(const Pose& pose) {
  return {pose.position.latDeg, pose.position.lonDeg, pose.position.altM, pose.headingDeg, pose.pitchDeg, pose.rollDeg};
}

Json predictionOf(const PredictionRecord& r) {
  if (r.horizonS <= 0) return {{"horizon_s", nullptr}, {"error_m", nullptr}, {"radius_m", nullptr}};
  return {{"horizon_s", r.horizonS}, {"error_m", r.errorM ? Json(*r.errorM) : Json(nullptr)}, {"radius_m", r.radiusM}};
}

Json jsonOf(const FrameRecord& r) {
  Json passes = Json::object();
  for (const PassTime& pass : r.passes) passes[pass.name] = pass.ms;
  const SelectionCounts& s = r.selection;
  Json chunks = {{"considered", s.considered},
                 {"frustum_culled", s.frustumCulled},
                 {"horizon_culled", s.horizonCulled},
                 {"backface_culled", 0},
                 {"occlusion_culled", 0},
                 {"drawn", s.drawn}};
  Json clusters = {{"considered", r.clusters.considered},
                   {"frustum_culled", r.clusters.outside},
                   {"horizon_culled", 0},  // by chunks
                   {"backface_culled", r.clusters.backFacing},
                   {"occlusion_culled", r.clusters.occluded},
                   {"drawn", r.clusters.drawn}};
  return Json{{"frame", r.frame},
              {"time_s", r.timeS},
              {"pose", poseOf(r.pose)},
              {"eye", poseOf(r.eye.pose)},
              {"drawn", r.drawn},
              {"frame_ms", r.frameMs},
              {"cpu_ms", r.cpuMs},
              {"gpu_ms", r.gpuMs},
              {"pass_ms", passes},
              {"triangles", r.triangles},
              {"vertices", r.vertices},
              {"draws", r.draws},
              {"chunks", chunks},
              {"clusters", clusters},
              {"depth_map", r.depthMapPx ? fmt::format("{}x{}", r.depthMapPx->x, r.depthMapPx->y) : "off"},
              {"membership", membershipOf(r.decision)},
              {"paging",
               {{"requested", r.paging.requested},
                {"loaded", r.paging.loaded},
                {"evicted", r.paging.evicted},
                {"resident", r.paging.resident},
                {"ram_bytes", r.paging.ramBytes},
                {"gpu_bytes", r.paging.gpuBytes},
                {"missing", s.missing},
                {"damaged", r.paging.damaged},
                {"bytes_read", r.paging.bytesRead},
                {"cached", r.paging.cached},
                {"refused", r.paging.refused},
                {"coarsening", r.coarsening},
                {"interval_s", r.pace.interval.lengthS},
                {"keeps_up", r.pace.interval.keepsUp},
                {"memory_s", r.pace.memoryS},
                {"cache_s", r.pace.cacheS},
                {"read_bytes_s", r.pace.rates.readBytesS},
                {"decode_bytes_s", r.pace.rates.decodeBytesS},
                {"demand_bytes_s", r.pace.rates.demandBytesS}}},
              {"prediction", predictionOf(r.prediction)},
              {"host",
               {{"packets", r.host.packets},
                {"rejected", r.host.rejected},
                {"unread", r.host.unread},
                {"lost", r.host.lost},
                {"frame", r.hostFrame ? Json(*r.hostFrame) : Json(nullptr)},
                {"delay_ms", r.eye.delayMs},
                {"jitter_ms", r.eye.jitterMs},
                {"stamps", r.hostAgeMs < 0 ? Json(nullptr) : Json(r.eye.stampedByHost ? "host" : "arrival")},
                {"silent", r.eye.silent},
                {"age_ms", r.hostAgeMs < 0 ? Json(nullptr) : Json(r.hostAgeMs)}}}};
}

Error writeError(const std::string& path) {
  return Error{errno == ENOSPC ? ErrorKind::noSpace : ErrorKind::io,
               fmt::format("{}: cannot write: {}; free space or choose another place", path, std::strerror(errno))};
}

// Of sorted values, linear between neighbours (the usual definition of numpy and spreadsheets).
double quantile(const std::vector<double>& sorted, double q) {
  const double place = q * static_cast<double>(sorted.size() - 1);
  const size_t below = static_cast<size_t>(place);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

}  // namespace

Result<StatisticsFile> StatisticsFile::create(const std::string& path) {
  StatisticsFile file;
  file.path_ = path;
  file.file_.reset(std::fopen(path.c_str(), "w"));
  if (!file.file_) return tl::unexpected(writeError(path));
  return file;
}

Result<void> StatisticsFile::write(const FrameRecord& record) {
  const std::string line = jsonOf(record).dump() + "\n";
  if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size()) return tl::unexpected(writeError(path_));
  return {};
}

Result<void> StatisticsFile::close() {
  if (std::fclose(file_.release()) != 0) return tl::unexpected(writeError(path_));
  return {};
}

TimeSummary summarize(std::vector<double> values) {
  TimeSummary summary;
  if (values.empty()) return summary;
  std::sort(values.begin(), values.end());
  for (const double value : values) summary.mean += value / static_cast<double>(values.size());
  summary.median = quantile(values, 0.5);
  summary.p95 = quantile(values, 0.95);
  summary.p99 = quantile(values, 0.99);
  summary.max = values.back();
  return summary;
}

void RunSummary::add(const FrameRecord& record) {
  ++frames_;
  paging_ = record.paging;
  if (!record.drawn) return;
  frameMs_.push_back(record.frameMs);
  overBudget_ += record.frameMs > kFrameBudgetMs ? 1 : 0;
  missingChunkFrames_ += record.selection.missing > 0 ? 1 : 0;
  mostMissing_ = std::max(mostMissing_, record.selection.missing);
  triangles_ += static_cast<double>(record.triangles);
  vertices_ += static_cast<double>(record.vertices);
  cpuMs_ += record.cpuMs;
}

Result<void> RunSummary::write(const std::string& path, const std::string& device, double startupMs,
                               const std::string& settings) const {
  const TimeSummary times = summarize(frameMs_);
  const double drawn = std::max<double>(1, static_cast<double>(frameMs_.size()));
  const Json json{
      {"frames", frames_},
      {"frames_drawn", frameMs_.size()},
      {"frame_ms",
       {{"mean", times.mean}, {"median", times.median}, {"p95", times.p95}, {"p99", times.p99}, {"max", times.max}}},
      {"fps", times.mean > 0 ? 1000.0 / times.mean : 0.0},
      {"cpu_ms_mean", cpuMs_ / drawn},
      {"over_budget_frames", overBudget_},
      {"triangles_mean", triangles_ / drawn},
      {"vertices_mean", vertices_ / drawn},
      {"missing_chunk_frames", missingChunkFrames_},
      {"bytes_read", paging_.bytesRead},
      {"peak_rss_bytes", peakRssBytes()},
      {"device", device},
      {"startup_ms", startupMs},
      {"settings", settings}};
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) return tl::unexpected(writeError(path));
  const std::string text = json.dump(2) + "\n";
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  if (std::fclose(file) != 0 || !written) return tl::unexpected(writeError(path));
  return {};
}

uint64_t peakRssBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace eye

#include "bench/pareto_runs.h"

#include <algorithm>
#include <cmath>

#include "app/option_values.h"
#include "app/outputs.h"
#include "bench/picture_error.h"

namespace eye {
namespace {

// The finest picture: an eighth of the default tolerance.
constexpr double kFinestSsePx = 0.125;
constexpr uint64_t kFinestCacheMiB = 1536;

std::pair<int, int> keyOf(glm::ivec2 sizePx) {
  return {sizePx.x, sizePx.y};
}

// The view moved by a part of a pixel.
View shifted(View view, double columns, double rows) {
  Frustum& f = view.frustum;
  const double right = columns * (f.tanRight - f.tanLeft) / view.widthPx;
  const double down = rows * (f.tanTop - f.tanBottom) / view.heightPx;
  f.tanLeft += right;
  f.tanRight += right;
  f.tanTop -= down;
  f.tanBottom -= down;
  return view;
}

// The mean of n x n pictures whose pixels' rays are spread evenly over the pixel.
Result<std::vector<float>> meanPicture(SteeredGenerator& generator, const Pose& pose, int n) {
  const Result<FrameRecord> record = generator.frame(pose);
  if (!record) return tl::unexpected(record.error());
  FrameInput input = generator.generator().lastInput();
  input.readColour = true;
  const View view = input.view;
  MeanPicture mean;
  for (int i = 0; i < n * n; ++i) {
    input.view = shifted(view, (i % n + 0.5) / n - 0.5, (i / n + 0.5) / n - 0.5);
    const Result<FrameOutput> output = generator.generator().renderer().drawFrame(input);
    if (!output) return tl::unexpected(output.error());
    mean.add(output->rgba);
  }
  return mean.rgb();
}

void judge(const ImageGenerator& generator, const ViewTruth& truth, double share, ParetoResult& result) {
  const std::vector<float> rangeM = slantRange(generator.depth(), generator.view());
  const truth::Comparison compared = truth::compare(truth.distances, rangeM);
  const std::vector<float> rgb = rgbOf(generator.picture());
  result.explained += share * compared.explainedShare();
  result.distanceMedian += share * compared.medianError;
  result.distanceP99 += share * compared.p99Error;
  result.skylinePx += share * skylineErrorPx(truth.distances, rangeM);
  result.psnrDb += share * psnrDb(rgb, truth.colours);
  result.ssim += share * ssim(rgb, truth.colours, generator.widthPx(), generator.heightPx());
}

struct Times {
  std::vector<double> cpuMs, wallMs, gpuMs, triangles;
};

// Of two that were drawn in turn, frame by frame.
std::vector<double> ratios(const std::vector<double>& of, const std::vector<double>& to) {
  std::vector<double> each(of.size());
  for (size_t i = 0; i < of.size(); ++i) each[i] = of[i] / to[i];
  return each;
}

// The views' medians are independent of one another, so the squares of their spreads add up.
void addShare(const SpreadMedian& of, double share, SpreadMedian& mean) {
  mean.median += share * of.median;
  mean.spread = std::hypot(mean.spread, share * of.spread);
}

void addMedians(const Times& times, const Times& ofDefault, double share, ParetoResult& result) {
  const SpreadMedian cpu = spreadMedian(times.cpuMs);
  result.cpuMs += share * cpu.median;
  result.cpuSpreadMs = std::hypot(result.cpuSpreadMs, share * cpu.spread);
  addShare(spreadMedian(ratios(times.cpuMs, ofDefault.cpuMs)), share, result.cpuAgainstDefault);
  addShare(spreadMedian(ratios(times.wallMs, ofDefault.wallMs)), share, result.wallAgainstDefault);
  result.wallMs += share * spreadMedian(times.wallMs).median;
  result.gpuMs += share * spreadMedian(times.gpuMs).median;
  result.triangles += share * spreadMedian(times.triangles).median;
}

}  // namespace

Result<SteeredGenerator> ParetoRuns::generatorFor(const ParetoSetting& setting) {
  Options options = setting.options();
  options.terrain = terrain_;
  options.device = device_;
  Result<SteeredGenerator> generator = SteeredGenerator::create(options);
  if (generator) deviceName_ = generator->generator().renderer().device().name;
  return generator;
}

Result<void> ParetoRuns::makeTruths(glm::ivec2 sizePx, int picturesASide) {
  Options options =
      ParetoSetting{
          .ssePx = kFinestSsePx, .culling = CullingMode::frustum, .sampler = TextureFilter::trilinear, .sizePx = sizePx}
          .options();
  options.terrain = terrain_;
  options.device = device_;
  options.cacheGpuMiB = kFinestCacheMiB;
  Result<SteeredGenerator> generator = SteeredGenerator::create(options);
  if (!generator) return tl::unexpected(generator.error());
  std::vector<ViewTruth>& truths = truths_[keyOf(sizePx)];
  for (const BenchView& view : views_) {
    Result<truth::TruthImage> distances = distances_.image(view.pose, options.fovDeg, sizePx.x, sizePx.y);
    if (!distances) return tl::unexpected(distances.error());
    Result<std::vector<float>> colours = meanPicture(*generator, view.pose, picturesASide);
    if (!colours) return tl::unexpected(colours.error());
    truths.push_back({std::move(*distances), std::move(*colours)});
  }
  return {};
}

Result<std::vector<ParetoResult>> ParetoRuns::measure(const ParetoBlock& block, const ParetoEffort& effort) {
  std::vector<SteeredGenerator> generators;
  std::vector<ParetoResult> results;
  for (const ParetoSetting& setting : block) {
    Result<SteeredGenerator> generator = generatorFor(setting);
    if (!generator) return tl::unexpected(generator.error());
    results.push_back({.setting = setting, .samplerName = nameOf(generator->generator().renderer().textureFilter())});
    generators.push_back(std::move(*generator));
  }
  const double share = 1.0 / static_cast<double>(views_.size());
  for (size_t v = 0; v < views_.size(); ++v) {
    const Pose& pose = views_[v].pose;
    const ViewTruth& truth = truths_.at(keyOf(block.front().sizePx))[v];
    std::vector<Times> times(block.size());
    for (size_t s = 0; s < block.size(); ++s) {
      const bool selects = block[s].culling == CullingMode::dynamic && !block[s].depthMapPx;
      const int settle = selects ? std::max(effort.settle, effort.selectorFrames) : effort.settle;
      for (int i = 0; i < settle; ++i) {
        const Result<FrameRecord> record = generators[s].frame(pose, 0, i == settle - 1);
        if (!record) return tl::unexpected(record.error());
        if (i == settle - 1) results[s].missing += static_cast<int>(record->selection.missing);
      }
      judge(generators[s].generator(), truth, share, results[s]);
    }
    for (int i = 0; i < effort.frames; ++i) {
      for (size_t k = 0; k < block.size(); ++k) {
        const size_t s = (k + static_cast<size_t>(i)) % block.size();  // begins with another one each time
        const Result<FrameRecord> record = generators[s].frame(pose);
        if (!record) return tl::unexpected(record.error());
        times[s].cpuMs.push_back(record->cpuMs);
        times[s].wallMs.push_back(record->frameMs);
        times[s].gpuMs.push_back(record->gpuMs);
        times[s].triangles.push_back(static_cast<double>(record->triangles));
      }
    }
    for (size_t s = 0; s < block.size(); ++s) addMedians(times[s], times[0], share, results[s]);
  }
  return results;
}

}  // namespace eye

// Settings measured: what a frame of each takes, and how far its picture is from the truth. Owner thread: render.
#pragma once

#include <map>

#include "bench/bench_views.h"
#include "bench/pareto_front.h"
#include "bench/pareto_settings.h"
#include "bench/steered_generator.h"
#include "bench/true_distances.h"

namespace eye {

// What is right in one view at one size.
struct ViewTruth {
  truth::TruthImage distances;
  std::vector<float> colours;  // red, green, blue by pixel: the mean of 64 pictures within the pixel, finest data
};

// Means over the views.
struct ParetoResult {
  ParetoSetting setting;
  std::string samplerName;  // "bilinear", where the setting leaves it to the device too
  double cpuMs = 0, wallMs = 0, gpuMs = 0, triangles = 0;
  double cpuSpreadMs = 0;                                  // of the median, as SpreadMedian says
  SpreadMedian cpuAgainstDefault{}, wallAgainstDefault{};  // ratios of frames drawn behind one another
  double explained = 0, distanceMedian = 0, distanceP99 = 0, skylinePx = 0, psnrDb = 0, ssim = 0;
  int missing = 0;  // chunks, over all views: 0, or the memory was too small
};

struct ParetoEffort {
  int frames = 24, settle = 3;
  int selectorFrames = 70;  // the selector has made its first comparison after some 20, and its second at most after 90
};

class ParetoRuns {
 public:
  ParetoRuns(std::string terrain, std::string device, std::vector<BenchView> views, TrueDistances& distances)
      : terrain_(std::move(terrain)), device_(std::move(device)), views_(std::move(views)), distances_(distances) {}

  // Once for each size, before what is measured at it. `picturesASide`: squared, the samples of a pixel's colour.
  Result<void> makeTruths(glm::ivec2 sizePx, int picturesASide);
  // The default first, then the others in the block's order.
  Result<std::vector<ParetoResult>> measure(const ParetoBlock& block, const ParetoEffort& effort);
  const std::string& deviceName() const { return deviceName_; }

 private:
  Result<SteeredGenerator> generatorFor(const ParetoSetting& setting);

  std::string terrain_, device_, deviceName_;
  std::vector<BenchView> views_;
  TrueDistances& distances_;
  std::map<std::pair<int, int>, std::vector<ViewTruth>> truths_;  // by size, a view each
};

}  // namespace eye

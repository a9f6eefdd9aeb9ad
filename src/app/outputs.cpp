#include "app/outputs.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "raster/distance_map.h"
#include "raster/picture.h"

namespace eye {
namespace {

Result<void> checkOutput(const std::string& path) {
  if (path.empty()) return {};
  std::error_code failed;
  if (std::filesystem::is_directory(path, failed))
    return fail(ErrorKind::io, fmt::format("{}: cannot write there: it is a folder; give a file in it", path));
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (access(folder.empty() ? "." : folder.c_str(), W_OK) == 0) return {};
  return fail(ErrorKind::io,
              fmt::format("{}: cannot write there: {}; make the folder or choose another", path, std::strerror(errno)));
}

}  // namespace

// Depth = near / z, and the ray through a pixel has z = 1.
std::vector<float> slantRange(std::span<const float> depth, const View& view) {
  std::vector<float> rangeM(depth.size(), std::numeric_limits<float>::quiet_NaN());
  size_t i = 0;
  for (int row = 0; row < view.heightPx; ++row) {
    for (int column = 0; column < view.widthPx; ++column, ++i) {
      if (depth[i] <= 0) continue;
      const Vec3d ray = rayThroughPixel(view.frustum, view.widthPx, view.heightPx, column, row);
      rangeM[i] = static_cast<float>(view.frustum.nearM / static_cast<double>(depth[i]) * glm::length(ray));
    }
  }
  return rangeM;
}

Result<void> checkOutputs(const Options& options) {
  for (const std::string& path :
       {options.screenshot, options.distanceMap, options.summary, options.trace, options.record, options.stats})
    if (const Result<void> writable = checkOutput(path); !writable) return writable;
  return {};
}

Result<void> writeScreenshot(const Options& options, const ImageGenerator& generator) {
  if (options.screenshot.empty()) return {};
  return writePng(options.screenshot, generator.picture(), generator.widthPx(), generator.heightPx());
}

Result<void> writeDistances(const Options& options, const ImageGenerator& generator) {
  if (options.distanceMap.empty()) return {};
  const std::vector<float> rangeM = slantRange(generator.depth(), generator.view());
  return writeDistanceMap(options.distanceMap, rangeM, generator.widthPx(), generator.heightPx());
}

bool FirstError::keep(const Result<void>& result) {
  if (result) return true;
  if (!error_)
    error_ = result.error();
  else if (error_->message != result.error().message)
    spdlog::error("{}", result.error().message);
  return false;
}

Result<void> FirstError::result() const {
  if (error_) return tl::unexpected(*error_);
  return {};
}

}  // namespace eye

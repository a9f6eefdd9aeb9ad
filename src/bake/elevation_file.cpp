#include "bake/elevation_file.h"

#include <gdal_priv.h>

#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace eye {

namespace {

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
// No land or sea floor is outside; what is comes from damaged or untagged voids.
constexpr double kLowestM = -11500, kHighestM = 9500;
// Above this (some 60,000 x 60,000) the missing posts are not told apart, to keep the mask's memory bounded.
constexpr uint64_t kMaxMaskPosts = uint64_t{1} << 32;

double metresPerUnit(const GDALRasterBand& band) {
  const std::string unit = const_cast<GDALRasterBand&>(band).GetUnitType();
  if (unit == "ft" || unit == "foot" || unit == "feet" || unit == "Feet" || unit == "FEET") return 0.3048;
  if (unit == "us-ft" || unit == "US survey foot" || unit == "sfoot") return 1200.0 / 3937.0;
  return 1;
}

Result<void> readFrom(GDALDataset& dataset, const std::string& path, int row, int column, int rows, int columns,
                      float* heightM) {
  GdalMessages messages;
  GDALRasterBand* band = dataset.GetRasterBand(1);
  if (band->RasterIO(GF_Read, column, row, columns, rows, heightM, columns, rows, GDT_Float32, 0, 0, nullptr) !=
      CE_None) {
    return fail(ErrorKind::badData, fmt::format("{}: cannot read rows {} to {}: {}; the file is damaged or cut short",
                                                path, row, row + rows - 1, messages.failure()));
  }
  int hasNoData = 0;
  const auto noData = static_cast<float>(band->GetNoDataValue(&hasNoData));
  const double unitM = metresPerUnit(*band);
  const double scale = band->GetScale() * unitM, offset = band->GetOffset() * unitM;
  const size_t count = static_cast<size_t>(rows) * static_cast<size_t>(columns);
  for (size_t i = 0; i < count; ++i) {
    const float raw = heightM[i];
    const bool marked = (hasNoData && raw == noData) || raw == -32768.0f || raw == -32767.0f || raw == -9999.0f;
    const double height = static_cast<double>(raw) * scale + offset;
    // Negated, so that NaN is missing too.
    heightM[i] = marked || !(height >= kLowestM && height <= kHighestM) ? kMissing : static_cast<float>(height);
  }
  return {};
}

// Missing posts from which a path of missing posts leads to a corner. A raster that was turned leaves its corners
// empty, a coastal one its sea; a void in the mountains seldom reaches a corner.
std::vector<bool> collarFrom(const std::vector<bool>& missing, int rows, int columns) {
  std::vector<bool> collar(missing.size(), false);
  std::vector<uint32_t> open;
  const auto width = static_cast<uint32_t>(columns), height = static_cast<uint32_t>(rows);
  const auto visit = [&](uint32_t index) {
    if (!missing[index] || collar[index]) return;
    collar[index] = true;
    open.push_back(index);
  };
  for (const uint32_t row : {0u, height - 1}) {
    for (const uint32_t column : {0u, width - 1}) visit(row * width + column);
  }
  while (!open.empty()) {
    const uint32_t index = open.back();
    open.pop_back();
    if (index % width > 0) visit(index - 1);
    if (index % width + 1 < width) visit(index + 1);
    if (index / width > 0) visit(index - width);
    if (index / width + 1 < height) visit(index + width);
  }
  return collar;
}

}  // namespace

Result<ElevationFile> scanElevation(const std::string& path) {
  Result<GeoRaster> raster = openGeoRaster(path, RasterUse::elevation);
  if (!raster) return tl::unexpected(raster.error());
  const GeoGrid grid = raster->grid;
  if (grid.rows < 2 || grid.columns < 2) {
    return fail(ErrorKind::badData,
                fmt::format("{}: {} x {} posts are too few for a surface", path, grid.columns, grid.rows));
  }
  ElevationFile file;
  file.path = path;
  file.grid = grid;
  file.warped = raster->warped;
  file.posts = static_cast<uint64_t>(grid.rows) * static_cast<uint64_t>(grid.columns);
  file.minM = std::numeric_limits<double>::infinity();
  file.maxM = -file.minM;
  const bool masked = file.posts < kMaxMaskPosts;
  std::vector<bool> missing(masked ? file.posts : 0, false);
  uint64_t missingCount = 0;
  constexpr int kStripRows = 256;
  std::vector<float> strip(static_cast<size_t>(kStripRows) * static_cast<size_t>(grid.columns));
  for (int row = 0; row < grid.rows; row += kStripRows) {
    const int rows = std::min(kStripRows, grid.rows - row);
    if (auto read = readFrom(raster->dataset(), path, row, 0, rows, grid.columns, strip.data()); !read) {
      return tl::unexpected(read.error());
    }
    const size_t first = static_cast<size_t>(row) * static_cast<size_t>(grid.columns);
    for (size_t i = 0; i < static_cast<size_t>(rows) * static_cast<size_t>(grid.columns); ++i) {
      if (std::isnan(strip[i])) {
        ++missingCount;
        if (masked) missing[first + i] = true;
      } else {
        file.minM = std::min(file.minM, static_cast<double>(strip[i]));
        file.maxM = std::max(file.maxM, static_cast<double>(strip[i]));
      }
    }
  }
  if (missingCount == file.posts) {
    return fail(ErrorKind::badData, fmt::format("{}: has no valid height at all; leave it out", path));
  }
  if (missingCount > 0 && masked) {
    file.collarMask = collarFrom(missing, grid.rows, grid.columns);
    file.collar = static_cast<uint64_t>(std::count(file.collarMask.begin(), file.collarMask.end(), true));
    if (file.collar == 0) file.collarMask = {};
  }
  file.voids = missingCount - file.collar;
  return file;
}

Result<void> readPosts(const ElevationFile& file, int firstRow, int firstColumn, int rows, int columns,
                       float* heightM) {
  Result<GeoRaster> raster = openGeoRaster(file.path, RasterUse::elevation);
  if (!raster) return tl::unexpected(raster.error());
  if (raster->grid.rows != file.grid.rows || raster->grid.columns != file.grid.columns) {
    return fail(ErrorKind::io, fmt::format("{}: has changed during the bake; start again", file.path));
  }
  return readFrom(raster->dataset(), file.path, firstRow, firstColumn, rows, columns, heightM);
}

}  // namespace eye

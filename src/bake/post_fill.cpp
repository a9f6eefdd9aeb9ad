#include "bake/post_fill.h"

#include <gdal_alg.h>
#include <gdal_priv.h>

#include <cmath>

#include "raster/encode.h"

namespace eye {

namespace {

constexpr float kUnfilled = -99999;  // far below any height

}  // namespace

Result<void> interpolateVoids(PostWindow& window, const std::vector<uint8_t>& isVoid) {
  // GDAL fills where the mask is 0, from where it is not; posts that are missing but no void must do neither.
  std::vector<uint8_t> valid(window.heightM.size());
  std::vector<float> filled = window.heightM;
  for (size_t i = 0; i < filled.size(); ++i) {
    valid[i] = !std::isnan(filled[i]);
    if (!valid[i]) filled[i] = kUnfilled;
  }
  const Dataset heights = wrapPixels(filled.data(), window.columns, window.rows, 1, GDT_Float32, 4, 4);
  const Dataset mask = wrapPixels(valid.data(), window.columns, window.rows, 1, GDT_Byte, 1, 1);
  if (!heights || !mask) return fail(ErrorKind::io, "out of memory while filling voids; lower --jobs");
  GdalMessages messages;
  const char* const options[] = {"TEMP_FILE_DRIVER=MEM", "NODATA=-99999", nullptr};
  GDALRasterBand* band = heights->GetRasterBand(1);
  if (GDALFillNodata(GDALRasterBand::ToHandle(band), GDALRasterBand::ToHandle(mask->GetRasterBand(1)), kFillPosts, 0, 0,
                     const_cast<char**>(options), nullptr, nullptr) != CE_None) {
    return fail(ErrorKind::io, "cannot fill voids: " + messages.failure());
  }
  heights->FlushCache();
  for (size_t i = 0; i < filled.size(); ++i) {
    if (isVoid[i] && filled[i] != kUnfilled) window.heightM[i] = filled[i];
  }
  return {};
}

Fade fadeAround(const PostWindow& window) {
  const int rows = window.rows, columns = window.columns;
  // Columns to the nearest valid post of the same row, up to the fade's width; the window's own sign tells the side.
  constexpr int16_t kFar = kFadePosts + 1;
  std::vector<int16_t> inRow(window.heightM.size(), kFar);
  for (int row = 0; row < rows; ++row) {
    int last = -kFar;
    for (int column = 0; column < columns; ++column) {
      if (!std::isnan(window.heightM[window.index(row, column)])) last = column;
      if (column - last < kFar) inRow[window.index(row, column)] = static_cast<int16_t>(last - column);
    }
    last = columns + kFar;
    for (int column = columns - 1; column >= 0; --column) {
      if (!std::isnan(window.heightM[window.index(row, column)])) last = column;
      int16_t& nearest = inRow[window.index(row, column)];
      if (last - column < std::abs(nearest)) nearest = static_cast<int16_t>(last - column);
    }
  }
  Fade fade{std::vector<int32_t>(inRow.size(), -1), std::vector<float>(inRow.size(), 0.0f)};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const size_t i = window.index(row, column);
      if (inRow[i] == 0) {
        fade.nearest[i] = static_cast<int32_t>(i);
        fade.weight[i] = 1;
        continue;
      }
      int best = kFadePosts * kFadePosts;
      for (int dy = -kFadePosts + 1; dy < kFadePosts; ++dy) {
        if (row + dy < 0 || row + dy >= rows) continue;
        const int dx = inRow[window.index(row + dy, column)];
        if (std::abs(dx) == kFar || dx * dx + dy * dy >= best) continue;
        best = dx * dx + dy * dy;
        fade.nearest[i] = static_cast<int32_t>(window.index(row + dy, column + dx));
      }
      if (fade.nearest[i] < 0) continue;
      const double share = std::sqrt(double(best)) / kFadePosts;
      fade.weight[i] = static_cast<float>(1 - share * share * (3 - 2 * share));
    }
  }
  return fade;
}

}  // namespace eye

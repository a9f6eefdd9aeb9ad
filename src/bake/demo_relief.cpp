#include "bake/demo_relief.h"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "raster/gdal.h"

namespace eye {

std::optional<std::vector<float>> installedReliefM(const std::string& path, const GeoGrid& world) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::nullopt;
  const Result<Dataset> relief = openRaster(path);
  if (!relief || (*relief)->GetRasterCount() < 1) return std::nullopt;
  // Posts every 360 / columns degrees from longitude 0 and from pole to pole, both included.
  const int columns = (*relief)->GetRasterXSize(), rows = (*relief)->GetRasterYSize();
  if (columns < 360 || columns > 43200 || rows != columns / 2 + 1) return std::nullopt;
  std::vector<float> posts(static_cast<size_t>(columns) * static_cast<size_t>(rows));
  const GdalMessages messages;
  if ((*relief)->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, columns, rows, posts.data(), columns, rows, GDT_Float32, 0,
                                            0, nullptr) != CE_None)
    return std::nullopt;

  const double perDegree = columns / 360.0;
  const int reach = std::max(0, static_cast<int>(world.latStepDeg * perDegree / 2));
  std::vector<float> heights;
  heights.reserve(static_cast<size_t>(world.rows) * static_cast<size_t>(world.columns));
  for (int row = 0; row < world.rows; ++row) {
    const int centreRow = static_cast<int>(std::lround((90 - (world.northDeg() - row * world.latStepDeg)) * perDegree));
    for (int column = 0; column < world.columns; ++column) {
      const int centreColumn = static_cast<int>(std::lround((world.westDeg + column * world.lonStepDeg) * perDegree));
      double sumM = 0;
      int count = 0;
      for (int r = std::max(0, centreRow - reach); r <= std::min(rows - 1, centreRow + reach); ++r) {
        for (int c = centreColumn - reach; c <= centreColumn + reach; ++c, ++count) {
          const int wrapped = ((c % columns) + columns) % columns;
          const float heightM =
              posts[static_cast<size_t>(r) * static_cast<size_t>(columns) + static_cast<size_t>(wrapped)];
          if (heightM > 0 && heightM < 9000) sumM += static_cast<double>(heightM);
        }
      }
      heights.push_back(static_cast<float>(count > 0 ? sumM / count : 0.0));
    }
  }
  return heights;
}

}  // namespace eye

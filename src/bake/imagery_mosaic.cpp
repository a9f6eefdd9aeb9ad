#include "bake/imagery_mosaic.h"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <mutex>

#include <fmt/format.h>

#include "raster/find_rasters.h"

namespace eye {

namespace {

// Open handles kept for the next tile; opening a warped source takes milliseconds.
constexpr size_t kIdleHandles = 64;

struct IdleHandle {
  size_t file;
  GeoRaster raster;
};

// Pixels around a tile, thinned to about its texels.
struct Patch {
  double northDeg = 0, westDeg = 0;  // outer edge
  double rowDeg = 0, columnDeg = 0;  // size of a patch pixel
  int rows = 0, columns = 0;
  std::vector<uint8_t> red, green, blue, alpha;
};

Result<ImageryFile> describe(const std::string& path) {
  Result<GeoRaster> raster = openGeoRaster(path, RasterUse::imagery);
  if (!raster) return tl::unexpected(raster.error());
  GDALDataset& dataset = raster->dataset();
  for (int band = 1; band <= dataset.GetRasterCount(); ++band) {
    if (dataset.GetRasterBand(band)->GetRasterDataType() != GDT_Byte) {
      return fail(
          ErrorKind::unsupported,
          fmt::format("{}: imagery must have 8 bits a channel, this has {}; convert it: gdal_translate -ot Byte "
                      "-scale {} OUT.tif",
                      path, GDALGetDataTypeName(dataset.GetRasterBand(band)->GetRasterDataType()), path));
    }
  }
  return ImageryFile{path, raster->grid, raster->warped, raster->takenForGlobe, dataset.GetRasterCount() >= 3 ? 3 : 1};
}

bool goesAround(const GeoGrid& grid) {
  return std::abs(grid.lonStepDeg * grid.columns - 360) < grid.lonStepDeg * 1e-3;
}

// The pixels of a window, in one run; across the date line of a picture of the whole globe in two.
struct ColumnRuns {
  struct Run {
    int first = 0, pixels = 0;
  };
  int left = 0;  // of the window, below 0 where it begins beyond the first column
  std::vector<Run> runs;
  int pixels() const { return runs.size() == 2 ? runs[0].pixels + runs[1].pixels : runs.front().pixels; }
};

// Two runs are whole multiples of `thinning` long, so that both are thinned alike.
ColumnRuns columnRuns(int left, int right, int columns, bool around, int thinning) {
  const int seam = left < 0 ? 0 : columns;
  if (around && left < seam && right > seam) {
    const auto multiple = [&](int pixels) { return (pixels + thinning - 1) / thinning * thinning; };
    const int before = multiple(seam - left), behind = multiple(right - seam);
    if (before + behind <= columns) return {seam - before, {{columns - before, before}, {0, behind}}};
  }
  left = std::clamp(left, 0, columns);
  right = std::clamp(right, 0, columns);
  if (left >= right) return {};
  return {left, {{left, right - left}}};
}

}  // namespace

struct ImageryMosaic::Impl {
  std::vector<ImageryFile> files;
  std::mutex mutex;
  std::list<IdleHandle> idle;  // newest first

  Result<GeoRaster> take(size_t file) {
    {
      const std::lock_guard lock(mutex);
      for (auto it = idle.begin(); it != idle.end(); ++it) {
        if (it->file != file) continue;
        GeoRaster raster = std::move(it->raster);
        idle.erase(it);
        return raster;
      }
    }
    return openGeoRaster(files[file].path, RasterUse::imagery);
  }

  void giveBack(size_t file, GeoRaster raster) {
    std::list<IdleHandle> closing;  // outside the lock
    const std::lock_guard lock(mutex);
    idle.push_front({file, std::move(raster)});
    if (idle.size() > kIdleHandles) closing.splice(closing.begin(), idle, std::prev(idle.end()));
  }

  // No rows where the region misses the file. `turnDeg` is what the file's longitudes are moved by.
  Result<Patch> read(size_t file, const TileBounds& region, double turnDeg, double texelLatDeg, double texelLonDeg);
};

Result<Patch> ImageryMosaic::Impl::read(size_t file, const TileBounds& region, double turnDeg, double texelLatDeg,
                                        double texelLonDeg) {
  const GeoGrid& grid = files[file].grid;
  const double northEdgeDeg = grid.northDeg() + grid.latStepDeg / 2;
  const double westEdgeDeg = grid.westDeg - grid.lonStepDeg / 2 + turnDeg;
  // One texel and one pixel around the tile, for the footprint and for interpolation.
  const double marginLat = texelLatDeg + grid.latStepDeg, marginLon = texelLonDeg + grid.lonStepDeg;
  const auto clampTo = [](double value, int count) { return static_cast<int>(std::clamp(value, 0.0, double(count))); };
  const int top = clampTo(std::floor((northEdgeDeg - region.northDeg - marginLat) / grid.latStepDeg), grid.rows);
  const int bottom = clampTo(std::ceil((northEdgeDeg - region.southDeg + marginLat) / grid.latStepDeg), grid.rows);
  // Kept within a turn of the globe, which an int holds.
  const auto column = [&](double lonDeg) {
    return std::clamp((lonDeg - westEdgeDeg) / grid.lonStepDeg, -1.0 * grid.columns, 2.0 * grid.columns);
  };
  const int leftmost = static_cast<int>(std::floor(column(region.westDeg - marginLon)));
  const int rightmost = static_cast<int>(std::ceil(column(region.eastDeg + marginLon)));
  const int thinning = std::max(1, static_cast<int>(texelLonDeg / grid.lonStepDeg));
  const ColumnRuns across = columnRuns(leftmost, rightmost, grid.columns, goesAround(grid), thinning);
  Patch patch;
  if (top >= bottom || across.runs.empty()) return patch;

  const auto thinned = [](int pixels, double pixelDeg, double texelDeg) {
    return static_cast<int>(std::ceil(pixels / std::max(1.0, texelDeg / pixelDeg)));
  };
  const int pixelsAcross = across.pixels();
  const bool isWhole = across.runs.size() == 1;
  patch.rows = thinned(bottom - top, grid.latStepDeg, texelLatDeg);
  patch.columns = isWhole ? thinned(pixelsAcross, grid.lonStepDeg, texelLonDeg) : pixelsAcross / thinning;
  patch.northDeg = northEdgeDeg - top * grid.latStepDeg;
  patch.westDeg = westEdgeDeg + across.left * grid.lonStepDeg;
  patch.rowDeg = (bottom - top) * grid.latStepDeg / patch.rows;
  patch.columnDeg = pixelsAcross * grid.lonStepDeg / patch.columns;

  Result<GeoRaster> raster = take(file);
  if (!raster) return tl::unexpected(raster.error());
  GdalMessages messages;
  GDALDataset& dataset = raster->dataset();
  GDALRasterIOExtraArg how;
  INIT_RASTERIO_EXTRA_ARG(how);
  how.eResampleAlg = GRIORA_Average;
  const auto readBand = [&](GDALRasterBand* band, std::vector<uint8_t>& values) {
    values.resize(static_cast<size_t>(patch.rows) * static_cast<size_t>(patch.columns));
    int patchColumn = 0;
    for (const ColumnRuns::Run& run : across.runs) {
      const int columns = isWhole ? patch.columns : run.pixels / thinning;
      if (band->RasterIO(GF_Read, run.first, top, run.pixels, bottom - top, &values[static_cast<size_t>(patchColumn)],
                         columns, patch.rows, GDT_Byte, 0, patch.columns, &how) != CE_None) {
        return false;
      }
      patchColumn += columns;
    }
    return true;
  };
  bool ok = readBand(dataset.GetRasterBand(1), patch.red);
  if (files[file].colourBands == 3) {
    ok = ok && readBand(dataset.GetRasterBand(2), patch.green) && readBand(dataset.GetRasterBand(3), patch.blue);
  } else {
    patch.green = patch.blue = patch.red;
  }
  GDALRasterBand* first = dataset.GetRasterBand(1);
  if (first->GetMaskFlags() & GMF_ALL_VALID) {
    patch.alpha.assign(patch.red.size(), 255);
  } else {
    ok = ok && readBand(first->GetMaskBand(), patch.alpha);
  }
  if (!ok) {
    return fail(ErrorKind::badData, fmt::format("{}: cannot read its pixels: {}; the file is damaged or cut short",
                                                files[file].path, messages.failure()));
  }
  giveBack(file, std::move(*raster));
  return patch;
}

namespace {

// Bilinear; opacity falls to 0 beyond the patch's edge pixels. Colour is weighted by opacity.
glm::vec4 at(const Patch& patch, LatLon point) {
  const double row = (patch.northDeg - point.latDeg) / patch.rowDeg - 0.5;
  const double column = (point.lonDeg - patch.westDeg) / patch.columnDeg - 0.5;
  if (row < -0.501 || column < -0.501 || row > patch.rows - 0.499 || column > patch.columns - 0.499)
    return glm::vec4(0);
  const int row0 = static_cast<int>(std::floor(row)), column0 = static_cast<int>(std::floor(column));
  const auto down = static_cast<float>(row - row0), right = static_cast<float>(column - column0);
  glm::vec3 colour(0);
  float alpha = 0;
  for (const int dy : {0, 1}) {
    for (const int dx : {0, 1}) {
      const auto y = static_cast<size_t>(std::clamp(row0 + dy, 0, patch.rows - 1));
      const auto x = static_cast<size_t>(std::clamp(column0 + dx, 0, patch.columns - 1));
      const size_t i = y * static_cast<size_t>(patch.columns) + x;
      const float weight = (dy ? down : 1 - down) * (dx ? right : 1 - right) * float(patch.alpha[i]) / 255.0f;
      colour += weight * glm::vec3(patch.red[i], patch.green[i], patch.blue[i]);
      alpha += weight;
    }
  }
  return alpha > 0 ? glm::vec4(colour / alpha, alpha) : glm::vec4(0);
}

bool meets(const GeoGrid& grid, const TileBounds& region, double turnDeg) {
  return grid.southDeg - grid.latStepDeg / 2 < region.northDeg &&
         region.southDeg < grid.northDeg() + grid.latStepDeg / 2 &&
         grid.westDeg - grid.lonStepDeg / 2 + turnDeg < region.eastDeg &&
         region.westDeg < grid.eastDeg() + grid.lonStepDeg / 2 + turnDeg;
}

constexpr double kTurnsDeg[] = {0.0, -360.0, 360.0};

}  // namespace

ImageryMosaic::ImageryMosaic(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ImageryMosaic::~ImageryMosaic() = default;
const std::vector<ImageryFile>& ImageryMosaic::files() const {
  return impl_->files;
}

Result<std::unique_ptr<ImageryMosaic>> ImageryMosaic::open(const std::vector<std::string>& sources) {
  auto impl = std::make_unique<Impl>();
  for (const std::string& source : sources) {
    const auto paths = findRasters(source);
    if (!paths) return tl::unexpected(paths.error());
    const auto firstOwn = static_cast<std::ptrdiff_t>(impl->files.size());
    for (const std::string& path : *paths) {
      Result<ImageryFile> file = describe(path);
      if (!file) return tl::unexpected(file.error());
      impl->files.push_back(std::move(*file));
    }
    std::stable_sort(impl->files.begin() + firstOwn, impl->files.end(), [](const ImageryFile& a, const ImageryFile& b) {
      return a.grid.latStepDeg < b.grid.latStepDeg * (1 - 1e-6);
    });
  }
  return std::unique_ptr<ImageryMosaic>(new ImageryMosaic(std::move(impl)));
}

double ImageryMosaic::finestPixelDeg(const TileBounds& region) const {
  double finestDeg = 0;
  for (const ImageryFile& file : impl_->files) {
    for (const double turnDeg : kTurnsDeg) {
      if (meets(file.grid, region, turnDeg) && (finestDeg == 0 || file.grid.latStepDeg < finestDeg)) {
        finestDeg = file.grid.latStepDeg;
      }
    }
  }
  return finestDeg;
}

Result<std::vector<glm::vec4>> ImageryMosaic::sample(const TileBounds& region, double texelLatDeg, double texelLonDeg,
                                                     const std::vector<LatLon>& points) const {
  std::vector<glm::vec4> colours(points.size(), glm::vec4(0));
  bool open = true;
  for (size_t file = 0; file < impl_->files.size() && open; ++file) {
    for (const double turnDeg : kTurnsDeg) {
      if (!meets(impl_->files[file].grid, region, turnDeg)) continue;
      const Result<Patch> patch = impl_->read(file, region, turnDeg, texelLatDeg, texelLonDeg);
      if (!patch) return tl::unexpected(patch.error());
      if (patch->rows == 0) continue;
      open = false;
      for (size_t i = 0; i < points.size(); ++i) {
        glm::vec4& colour = colours[i];
        if (colour.a < 0.999f) {
          const glm::vec4 own = at(*patch, points[i]);
          const float share = (1 - colour.a) * own.a;
          if (share > 0) {
            const glm::vec3 mixed = (glm::vec3(colour) * colour.a + glm::vec3(own) * share) / (colour.a + share);
            colour = glm::vec4(mixed, colour.a + share);
          }
        }
        open = open || colour.a < 0.999f;
      }
    }
  }
  return colours;
}

}  // namespace eye

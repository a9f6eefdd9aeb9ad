#include "raster/geo_raster.h"

#include <gdal_priv.h>
#include <gdal_utils.h>
#include <gdalwarper.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace eye {

namespace {

using Options = std::vector<std::string>;

std::vector<char*> asArguments(const Options& options) {
  std::vector<char*> arguments;
  for (const std::string& option : options) arguments.push_back(const_cast<char*>(option.c_str()));
  arguments.push_back(nullptr);
  return arguments;
}

Dataset expandPalette(GDALDataset& source) {
  const Options options{"-of", "VRT", "-expand", "rgba"};
  GDALTranslateOptions* parsed = GDALTranslateOptionsNew(asArguments(options).data(), nullptr);
  Dataset view(GDALDataset::FromHandle(GDALTranslate("", GDALDataset::ToHandle(&source), parsed, nullptr)));
  GDALTranslateOptionsFree(parsed);
  return view;
}

Dataset warpToGrid(GDALDataset& source, const GeoGrid& grid, RasterUse use) {
  const auto number = [](double value) { return fmt::format("{:.17g}", value); };
  const double halfLat = grid.latStepDeg / 2, halfLon = grid.lonStepDeg / 2;
  Options options{"-of", "VRT", "-t_srs", "EPSG:4326", "-r", "bilinear", "-et", "0.01"};
  for (const std::string& part : {std::string("-te"), number(grid.westDeg - halfLon), number(grid.southDeg - halfLat),
                                  number(grid.eastDeg() + halfLon), number(grid.northDeg() + halfLat)}) {
    options.push_back(part);
  }
  options.insert(options.end(), {"-ts", std::to_string(grid.columns), std::to_string(grid.rows)});
  if (use == RasterUse::elevation) {
    options.insert(options.end(), {"-ot", "Float32", "-dstnodata", "nan"});
  } else {
    options.push_back("-dstalpha");
  }
  GDALWarpAppOptions* parsed = GDALWarpAppOptionsNew(asArguments(options).data(), nullptr);
  GDALDatasetH handle = GDALDataset::ToHandle(&source);
  Dataset view(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &handle, parsed, nullptr)));
  GDALWarpAppOptionsFree(parsed);
  return view;
}

GeoGrid gridOf(const std::array<double, 6>& transform, int columns, int rows) {
  GeoGrid grid;
  grid.rows = rows;
  grid.columns = columns;
  grid.latStepDeg = -transform[5];
  grid.lonStepDeg = transform[1];
  grid.southDeg = transform[3] + transform[5] * (rows - 0.5);
  grid.westDeg = transform[0] + transform[1] * 0.5;
  return grid;
}

// Whether latitude and longitude may be read off the geotransform: no system given, or a geographic one whose datum
// moves no corner by more than a twentieth of a pixel.
bool isPlainLatLon(GDALDataset& dataset, const std::array<double, 6>& transform) {
  if (transform[2] != 0 || transform[4] != 0 || transform[1] <= 0 || transform[5] >= 0) return false;
  const GeoGrid grid = gridOf(transform, dataset.GetRasterXSize(), dataset.GetRasterYSize());
  const bool inRange = grid.southDeg >= -90.5 && grid.northDeg() <= 90.5 && grid.westDeg >= -360.5 &&
                       grid.eastDeg() <= 360.5 && grid.lonStepDeg * grid.columns <= 361;
  const OGRSpatialReference* system = dataset.GetSpatialRef();
  if (system == nullptr) return inRange;
  if (!system->IsGeographic() || !inRange) return false;
  OGRSpatialReference wgs84;
  wgs84.importFromEPSG(4326);
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRSpatialReference own(*system);
  own.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  if (own.IsSame(&wgs84)) return true;
  const std::unique_ptr<OGRCoordinateTransformation> change(OGRCreateCoordinateTransformation(&own, &wgs84));
  if (!change) return false;
  for (const double lat : {grid.southDeg, grid.northDeg()}) {
    for (const double lon : {grid.westDeg, grid.eastDeg()}) {
      double x = lon, y = lat;
      if (!change->Transform(1, &x, &y)) return false;
      if (std::abs(x - lon) > 0.05 * grid.lonStepDeg || std::abs(y - lat) > 0.05 * grid.latStepDeg) return false;
    }
  }
  return true;
}

// Rounded up to two digits, so that neighbouring files of one survey get the same grid.
double roundUpToTwoDigits(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::ceil(value / unit - 1e-9) * unit;
}

// The grid to warp to: about the source's own resolution, posts at whole fractions of a degree.
Result<GeoGrid> suggestGrid(GDALDataset& source, const std::string& path) {
  GdalMessages messages;
  const char* const to[] = {"DST_SRS=EPSG:4326", nullptr};
  void* transformer = GDALCreateGenImgProjTransformer2(GDALDataset::ToHandle(&source), nullptr, const_cast<char**>(to));
  std::array<double, 6> transform{};
  std::array<double, 4> extentDeg{};  // west, south, east, north
  int columns = 0, rows = 0;
  const bool ok = transformer != nullptr &&
                  GDALSuggestedWarpOutput2(GDALDataset::ToHandle(&source), GDALGenImgProjTransform, transformer,
                                           transform.data(), &columns, &rows, extentDeg.data(), 0) == CE_None;
  if (transformer != nullptr) GDALDestroyGenImgProjTransformer(transformer);
  if (!ok || !(transform[1] > 0)) {
    return fail(ErrorKind::badData,
                fmt::format("{}: cannot be brought to latitude and longitude ({}); check its coordinate system", path,
                            messages.failure()));
  }
  const double middleLatDeg = std::clamp((extentDeg[1] + extentDeg[3]) / 2, -89.0, 89.0);
  // GDAL suggests square pixels in degrees along the diagonal; the rows keep the ground distance, the columns are
  // stretched by the parallel's shrinking, in twelfths so that neighbours agree.
  const double shrink = std::ceil(std::cos(middleLatDeg * 0.017453292519943295) * 12) / 12;
  const double meanPerDegree = 1 / transform[1];
  const double latPerDegree = roundUpToTwoDigits(meanPerDegree / std::sqrt(shrink));
  const double lonPerDegree = std::ceil(latPerDegree * shrink);
  const auto first = [](double deg, double perDegree) { return std::floor(deg * perDegree); };
  const auto last = [](double deg, double perDegree) { return std::ceil(deg * perDegree); };
  GeoGrid grid;
  grid.latStepDeg = 1 / latPerDegree;
  grid.lonStepDeg = 1 / lonPerDegree;
  const double south = first(std::max(extentDeg[1], -90.0), latPerDegree);
  const double north = last(std::min(extentDeg[3], 90.0), latPerDegree);
  const double west = first(extentDeg[0], lonPerDegree), east = last(extentDeg[2], lonPerDegree);
  if (north - south > 1e6 || east - west > 1e6) {
    return fail(ErrorKind::unsupported,
                fmt::format("{}: too large when warped to latitude and longitude ({:.0f} x {:.0f}); cut it into tiles "
                            "with gdal_retile.py",
                            path, east - west, north - south));
  }
  grid.southDeg = south / latPerDegree;
  grid.westDeg = west / lonPerDegree;
  grid.rows = int(north - south) + 1;
  grid.columns = int(east - west) + 1;
  return grid;
}

bool isTwiceAsWide(GDALDataset& dataset) {
  return dataset.GetRasterXSize() == 2 * dataset.GetRasterYSize();
}

Error noGeoreference(const std::string& path) {
  return {ErrorKind::badData,
          fmt::format("{}: has no georeference; give it one: gdal_translate -a_srs EPSG:4326 -a_ullr WEST NORTH EAST "
                      "SOUTH {} OUT.tif (or gdal_edit.py with the same options)",
                      path, path)};
}

}  // namespace

Result<GeoRaster> openGeoRaster(const std::string& path, RasterUse use) {
  Result<Dataset> opened = openRaster(path);
  if (!opened) return tl::unexpected(opened.error());
  GeoRaster raster{std::move(*opened), nullptr, {}, false};
  if (raster.source->GetRasterCount() < 1) return fail(ErrorKind::badData, path + ": has no raster band");

  GdalMessages messages;
  std::array<double, 6> transform{};
  const bool hasTransform = raster.source->GetGeoTransform(transform.data()) == CE_None;
  const bool hasSystem = raster.source->GetSpatialRef() != nullptr;
  if (!hasTransform && raster.source->GetGCPCount() == 0) {
    raster.takenForGlobe = use == RasterUse::imagery && !hasSystem && isTwiceAsWide(*raster.source);
    if (!raster.takenForGlobe) return tl::unexpected(noGeoreference(path));
  }

  const bool hasPalette = raster.source->GetRasterBand(1)->GetColorTable() != nullptr;
  if (use == RasterUse::imagery && hasPalette) {
    raster.view = expandPalette(*raster.source);
    if (!raster.view) {
      return fail(ErrorKind::badData, fmt::format("{}: cannot expand its palette: {}", path, messages.failure()));
    }
  }
  if (raster.takenForGlobe) {
    const int columns = raster.source->GetRasterXSize(), rows = raster.source->GetRasterYSize();
    raster.grid = gridOf({-180, 360.0 / columns, 0, 90, 0, -180.0 / rows}, columns, rows);
    return raster;
  }
  if (hasTransform && isPlainLatLon(*raster.source, transform)) {
    raster.grid = gridOf(transform, raster.source->GetRasterXSize(), raster.source->GetRasterYSize());
    return raster;
  }
  if (hasTransform && !hasSystem) return tl::unexpected(noGeoreference(path));

  const Result<GeoGrid> grid = suggestGrid(*raster.source, path);
  if (!grid) return tl::unexpected(grid.error());
  Dataset warped = warpToGrid(raster.dataset(), *grid, use);
  if (!warped) {
    return fail(ErrorKind::badData,
                fmt::format("{}: cannot be warped to latitude and longitude: {}", path, messages.failure()));
  }
  if (raster.view) std::swap(raster.source, raster.view);  // the palette view is what the warp reads from
  // VRT datasets hold references on what they read, so closing order does not matter.
  raster.view = std::move(warped);
  raster.grid = *grid;
  raster.warped = true;
  return raster;
}

}  // namespace eye

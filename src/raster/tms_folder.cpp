#include "raster/tms_folder.h"

#include <cpl_minixml.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "raster/gdal.h"

namespace eye {
namespace fs = std::filesystem;

namespace {

constexpr const char* kDescription = "tilemapresource.xml";
constexpr int kLargestTilePx = 4096;
constexpr int64_t kLargestSidePx = int64_t{1} << 30;

struct CloseXml {
  void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};
using Xml = std::unique_ptr<CPLXMLNode, CloseXml>;

struct TileMap {
  std::string system, extension;  // as WKT; with its dot
  double originX = 0, originY = 0, unitsPerPixel = 0;
  int tileWidthPx = 0, tileHeightPx = 0;
  fs::path level;
};

struct Tile {
  int column = 0, row = 0;  // row 0 is the southernmost
  std::string path;
};

Error badFolder(const std::string& folder, const std::string& what) {
  return {ErrorKind::badData, fmt::format("{}/{}: {}; it should describe a TMS folder of tiles, as gdal2tiles.py does",
                                          folder, kDescription, what)};
}

double number(const CPLXMLNode* node, const char* path) {
  return CPLAtof(CPLGetXMLValue(node, path, "nan"));
}

std::optional<int> wholeNumber(const std::string& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value >= 0 ? std::optional(value) : std::nullopt;
}

std::string wktOf(const char* name) {
  OGRSpatialReference system;
  constexpr const char* kClosed[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
  if (system.SetFromUserInput(name, kClosed) != OGRERR_NONE) return {};
  char* wkt = nullptr;
  system.exportToWkt(&wkt);
  std::string text = wkt != nullptr ? wkt : "";
  CPLFree(wkt);
  return text;
}

Result<TileMap> readTileMap(const std::string& folder) {
  const GdalMessages quiet;
  const Xml xml(CPLParseXMLFile((fs::path(folder) / kDescription).c_str()));
  const CPLXMLNode* map = xml ? CPLGetXMLNode(xml.get(), "=TileMap") : nullptr;
  if (map == nullptr) return tl::unexpected(badFolder(folder, "has no TileMap"));
  TileMap found;
  found.system = wktOf(CPLGetXMLValue(map, "SRS", ""));
  if (found.system.empty()) return tl::unexpected(badFolder(folder, "its SRS is none that GDAL knows"));
  found.originX = number(map, "Origin.x");
  found.originY = number(map, "Origin.y");
  const auto sidePx = [&](const char* path) { return wholeNumber(CPLGetXMLValue(map, path, "")).value_or(0); };
  found.tileWidthPx = sidePx("TileFormat.width");
  found.tileHeightPx = sidePx("TileFormat.height");
  found.extension = std::string(".") + CPLGetXMLValue(map, "TileFormat.extension", "");
  found.unitsPerPixel = std::numeric_limits<double>::infinity();
  const CPLXMLNode* sets = CPLGetXMLNode(map, "TileSets");
  for (const CPLXMLNode* set = sets != nullptr ? sets->psChild : nullptr; set != nullptr; set = set->psNext) {
    const double unitsPerPixel = number(set, "units-per-pixel");
    if (!(unitsPerPixel > 0 && unitsPerPixel < found.unitsPerPixel)) continue;
    found.unitsPerPixel = unitsPerPixel;
    // A name, not a way out of the folder or to a server.
    found.level = fs::path(folder) / fs::path(CPLGetXMLValue(set, "href", "")).filename();
  }
  const auto validSide = [](int side) { return side > 0 && side <= kLargestTilePx; };
  if (!std::isfinite(found.originX) || !std::isfinite(found.originY) || !std::isfinite(found.unitsPerPixel) ||
      !validSide(found.tileWidthPx) || !validSide(found.tileHeightPx)) {
    return tl::unexpected(badFolder(folder, "lacks an Origin, a TileFormat or a TileSet"));
  }
  return found;
}

Result<std::vector<Tile>> tilesOf(const TileMap& map) {
  std::vector<Tile> tiles;
  std::error_code error;
  for (const auto& columnFolder : fs::directory_iterator(map.level, error)) {
    const auto column = wholeNumber(columnFolder.path().filename());
    std::error_code inside;
    if (!column || !columnFolder.is_directory(inside)) continue;
    for (const auto& file : fs::directory_iterator(columnFolder.path(), inside)) {
      const auto row = wholeNumber(file.path().stem());
      if (row && file.path().extension() == map.extension) tiles.push_back({*column, *row, file.path()});
    }
  }
  if (tiles.empty()) {
    return fail(ErrorKind::notFound, fmt::format("{}: has no tile COLUMN/ROW{}; the finest level of the TMS folder "
                                                 "should be there",
                                                 map.level.string(), map.extension));
  }
  std::sort(tiles.begin(), tiles.end(),
            [](const Tile& a, const Tile& b) { return std::pair(a.column, a.row) < std::pair(b.column, b.row); });
  return tiles;
}

std::string xmlText(const std::string& text) {
  char* escaped = CPLEscapeString(text.c_str(), static_cast<int>(text.size()), CPLES_XML);
  std::string result = escaped;
  CPLFree(escaped);
  return result;
}

// GDAL's virtual format: the bands of all tiles side by side, and as the last one where there is a tile.
Result<std::string> virtualRaster(const std::string& folder, const TileMap& map, const std::vector<Tile>& tiles) {
  const auto columnLess = [](const Tile& a, const Tile& b) { return a.column < b.column; };
  const auto rowLess = [](const Tile& a, const Tile& b) { return a.row < b.row; };
  const auto [west, east] = std::minmax_element(tiles.begin(), tiles.end(), columnLess);
  const auto [south, north] = std::minmax_element(tiles.begin(), tiles.end(), rowLess);
  const int64_t widthPx = (int64_t{east->column} - west->column + 1) * map.tileWidthPx;
  const int64_t heightPx = (int64_t{north->row} - south->row + 1) * map.tileHeightPx;
  if (widthPx > kLargestSidePx || heightPx > kLargestSidePx) {
    return tl::unexpected(badFolder(folder, fmt::format("its tiles lie {} x {} pixels apart", widthPx, heightPx)));
  }
  Result<Dataset> first = openRaster(tiles.front().path);
  if (!first) return tl::unexpected(first.error());
  const int bands = (*first)->GetRasterCount() >= 3 ? 3 : 1;
  if ((*first)->GetRasterBand(1)->GetColorTable() != nullptr) {
    return tl::unexpected(badFolder(folder, "its tiles have palettes; convert them: gdal_translate -expand rgb"));
  }

  const double unit = map.unitsPerPixel;
  const double westX = map.originX + unit * map.tileWidthPx * west->column;
  const double northY = map.originY + unit * map.tileHeightPx * (north->row + 1.0);
  std::string vrt = fmt::format(
      // An SRS without a mapping of its axes has x to the east, as tiles have.
      "<VRTDataset rasterXSize=\"{}\" rasterYSize=\"{}\"><SRS>{}</SRS>"
      "<GeoTransform>{:.17g},{:.17g},0,{:.17g},0,{:.17g}</GeoTransform>",
      widthPx, heightPx, xmlText(map.system), westX, unit, northY, -unit);
  for (int band = 1; band <= bands + 1; ++band) {
    const bool isMask = band > bands;
    vrt += fmt::format("<VRTRasterBand dataType=\"Byte\" band=\"{}\">{}", band,
                       isMask ? "<ColorInterp>Alpha</ColorInterp>" : "");
    for (const Tile& tile : tiles) {
      vrt += fmt::format(
          "<SimpleSource><SourceFilename>{}</SourceFilename><SourceBand>{}</SourceBand>"
          "<SrcRect xOff=\"0\" yOff=\"0\" xSize=\"{}\" ySize=\"{}\"/>"
          "<DstRect xOff=\"{}\" yOff=\"{}\" xSize=\"{}\" ySize=\"{}\"/></SimpleSource>",
          xmlText(fs::absolute(tile.path)), isMask ? std::string("mask,1") : std::to_string(band), map.tileWidthPx,
          map.tileHeightPx, int64_t{map.tileWidthPx} * (tile.column - west->column),
          int64_t{map.tileHeightPx} * (north->row - tile.row), map.tileWidthPx, map.tileHeightPx);
    }
    vrt += "</VRTRasterBand>";
  }
  return vrt + "</VRTDataset>";
}

}  // namespace

bool isTmsFolder(const std::string& folder) {
  std::error_code ignored;
  return fs::is_regular_file(fs::path(folder) / kDescription, ignored);
}

Result<std::string> rasterOfTmsFolder(const std::string& folder) {
  initGdal();
  const Result<TileMap> map = readTileMap(folder);
  if (!map) return tl::unexpected(map.error());
  const Result<std::vector<Tile>> tiles = tilesOf(*map);
  if (!tiles) return tl::unexpected(tiles.error());
  const Result<std::string> vrt = virtualRaster(folder, *map, *tiles);
  if (!vrt) return tl::unexpected(vrt.error());
  const std::string path = "/vsimem" + fs::absolute(folder).lexically_normal().string() + ".vrt";
  VSILFILE* file = VSIFOpenL(path.c_str(), "wb");
  const bool written = file != nullptr && VSIFWriteL(vrt->data(), 1, vrt->size(), file) == vrt->size();
  if (file != nullptr) VSIFCloseL(file);
  if (!written) return fail(ErrorKind::io, fmt::format("{}: no memory for its list of tiles", folder));
  return path;
}

}  // namespace eye

#include "bake/vertical_datum.h"

#include <GeographicLib/Geoid.hpp>
#include <cstdlib>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include "bake/elevation_mosaic.h"

namespace eye {
namespace fs = std::filesystem;

namespace {

// Finest first among files of a size that fits in memory.
const std::map<std::string, std::vector<std::string>> kGridNames{
    {"egm84", {"egm84-15.pgm", "egm84-30.pgm"}},
    {"egm96", {"egm96-5.pgm", "us_nga_egm96_15.tif", "egm96_15.gtx", "egm96-15.pgm"}},
    {"egm2008", {"egm2008-2_5.pgm", "us_nga_egm08_25.tif", "egm08_25.gtx", "egm2008-5.pgm"}},
};

std::vector<fs::path> gridFolders() {
  std::vector<fs::path> folders;
  for (const char* variable : {"PROJ_DATA", "PROJ_LIB", "GEOGRAPHICLIB_GEOID_PATH"}) {
    if (const char* value = std::getenv(variable)) folders.emplace_back(value);
  }
  for (const char* folder : {"/usr/share/proj", "/usr/local/share/proj", "/usr/share/GeographicLib/geoids",
                             "/usr/local/share/GeographicLib/geoids"}) {
    folders.emplace_back(folder);
  }
  return folders;
}

std::string findGrid(const std::string& name) {
  for (const std::string& file : kGridNames.at(name)) {
    for (const fs::path& folder : gridFolders()) {
      std::error_code ignored;
      if (fs::is_regular_file(folder / file, ignored)) return folder / file;
    }
  }
  return {};
}

Result<HeightCorrection> loadPgm(const fs::path& file) {
  try {
    // Bilinear, and all of it read at once, which makes it safe for any thread.
    const auto geoid =
        std::make_shared<const GeographicLib::Geoid>(file.stem(), file.parent_path().string(), false, true);
    return HeightCorrection([geoid](double latDeg, double lonDeg) { return (*geoid)(latDeg, lonDeg); });
  } catch (const std::exception& error) {
    return fail(ErrorKind::badData,
                fmt::format("{}: no geoid that GeographicLib reads: {}", file.string(), error.what()));
  }
}

}  // namespace

Result<HeightCorrection> loadVerticalDatum(const std::string& datum) {
  std::string file = datum;
  if (kGridNames.contains(datum)) {
    file = findGrid(datum);
    if (file.empty()) {
      return fail(ErrorKind::notFound,
                  fmt::format("--vertical-datum {}: none of its grids is installed; install proj-data or run "
                              "geographiclib-get-geoids, or name a file (.gtx, .tif, .pgm)",
                              datum));
    }
  }
  if (fs::path(file).extension() == ".pgm") return loadPgm(fs::absolute(file));
  auto mosaic = ElevationMosaic::open({file});
  if (!mosaic) return tl::unexpected(mosaic.error());
  const std::shared_ptr<const ElevationMosaic> geoid(std::move(*mosaic));
  return HeightCorrection([geoid](double latDeg, double lonDeg) { return geoid->heightM(latDeg, lonDeg); });
}

}  // namespace eye

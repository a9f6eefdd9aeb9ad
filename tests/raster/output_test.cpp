#include <gdal_priv.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>

#include "raster/distance_map.h"
#include "raster/gdal.h"
#include "raster/picture.h"

using namespace eye;
namespace fs = std::filesystem;

namespace {

struct Folder {
  fs::path path = fs::temp_directory_path() / ("eye_raster_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};

}  // namespace

TEST_CASE("A PNG holds the pixels, as RGB, row 0 at the top") {
  Folder folder;
  std::vector<uint8_t> rgba(5 * 3 * 4);
  std::iota(rgba.begin(), rgba.end(), uint8_t{7});
  const std::string path = folder.path / "picture.png";
  REQUIRE(writePng(path, rgba, 5, 3));

  const Dataset read = openRaster(path).value();
  REQUIRE(read->GetRasterCount() == 3);
  REQUIRE(read->GetRasterXSize() == 5);
  REQUIRE(read->GetRasterYSize() == 3);
  std::vector<uint8_t> rgb(5 * 3 * 3);
  REQUIRE(read->RasterIO(GF_Read, 0, 0, 5, 3, rgb.data(), 5, 3, GDT_Byte, 3, nullptr, 3, 15, 1, nullptr) == CE_None);
  for (size_t pixel = 0; pixel < 15; ++pixel) {
    for (size_t band = 0; band < 3; ++band) CHECK(rgb[pixel * 3 + band] == rgba[pixel * 4 + band]);
  }
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);  // no leftovers
}

TEST_CASE("A distance map is one Float32 band with NaN as NoData") {
  Folder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> rangeM{nan, nan, 1234.5f, 0.25f, 63e6f, 7.0f};
  const std::string path = folder.path / "distance.tif";
  REQUIRE(writeDistanceMap(path, rangeM, 3, 2));

  const Dataset read = openRaster(path).value();
  REQUIRE(read->GetRasterCount() == 1);
  GDALRasterBand* band = read->GetRasterBand(1);
  CHECK(band->GetRasterDataType() == GDT_Float32);
  int hasNoData = 0;
  CHECK(std::isnan(band->GetNoDataValue(&hasNoData)));
  CHECK(hasNoData);
  std::vector<float> values(6);
  REQUIRE(band->RasterIO(GF_Read, 0, 0, 3, 2, values.data(), 3, 2, GDT_Float32, 0, 0, nullptr) == CE_None);
  for (size_t i = 0; i < 6; ++i) CHECK((values[i] == rangeM[i] || (std::isnan(values[i]) && std::isnan(rangeM[i]))));
}

TEST_CASE("Writing fails with one line that names the file, and leaves the old file alone") {
  Folder folder;
  const std::vector<uint8_t> rgba(4, 255);
  const std::string missing = folder.path / "no" / "such" / "folder.png";
  const Result<void> result = writePng(missing, rgba, 1, 1);
  REQUIRE(!result);
  CHECK(result.error().kind == ErrorKind::io);
  CHECK(result.error().message.find(missing) != std::string::npos);
  CHECK(result.error().message.find('\n') == std::string::npos);

  // A device that is always full stands for a full disk.
  const Result<void> full = writePng("/dev/full", rgba, 1, 1);
  REQUIRE(!full);
  CHECK(full.error().kind == ErrorKind::noSpace);
  CHECK(fs::is_character_file("/dev/full"));
}

TEST_CASE("Opening what is not a raster says what to do") {
  Folder folder;
  const std::string text = folder.path / "notes.txt";
  std::ofstream(text) << "not a raster";
  CHECK(openRaster(text).error().kind == ErrorKind::badData);
  CHECK(openRaster(text).error().message.find(text) != std::string::npos);
  CHECK(openRaster(text + ".gone").error().kind == ErrorKind::notFound);
}

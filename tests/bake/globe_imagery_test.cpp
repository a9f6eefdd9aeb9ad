// Pictures of the whole globe as they are passed around: without georeference, and as folders of tiles.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <numbers>

#include <fmt/format.h>

#include "bake/elevation_mosaic.h"
#include "bake/imagery_mosaic.h"
#include "bake/tile_painter.h"
#include "raster/picture.h"
#include "raster_files.h"

using namespace eye;

namespace {

// East in red, north in green; west and east of the date line differ.
glm::vec3 globeColour(double latDeg, double lonDeg) {
  return {std::round(127 + lonDeg / 1.5), std::round(127 + latDeg), 90};
}

// A part of the globe as a picture without georeference.
void writePart(const std::string& path, double westDeg, double northDeg, double stepDeg, int widthPx, int heightPx) {
  std::vector<uint8_t> rgba;
  for (int row = 0; row < heightPx; ++row) {
    for (int column = 0; column < widthPx; ++column) {
      const glm::vec3 colour = globeColour(northDeg - (row + 0.5) * stepDeg, westDeg + (column + 0.5) * stepDeg);
      for (int band = 0; band < 3; ++band) rgba.push_back(static_cast<uint8_t>(colour[band]));
      rgba.push_back(255);
    }
  }
  REQUIRE(writePng(path, rgba, widthPx, heightPx));
}

glm::vec4 sampleAt(const ImageryMosaic& imagery, double latDeg, double lonDeg) {
  const TileBounds region{std::max(latDeg - 1, -90.0), std::min(latDeg + 1, 90.0), std::max(lonDeg - 1, -180.0),
                          std::min(lonDeg + 1, 180.0)};
  return imagery.sample(region, 0.5, 0.5, {{latDeg, lonDeg}}).value()[0];
}

void checkShowsGlobe(const ImageryMosaic& imagery) {
  for (const double latDeg : {-80.0, -30.25, 0.0, 44.0, 88.0}) {
    for (const double lonDeg : {-170.0, -33.5, 0.0, 61.0, 176.0}) {
      INFO(latDeg << " " << lonDeg);
      const glm::vec4 seen = sampleAt(imagery, latDeg, lonDeg);
      CHECK(seen.a == Approx(1));
      CHECK(glm::distance(glm::vec3(seen), globeColour(latDeg, lonDeg)) < 2.5f);
    }
  }
}

std::string tileMap(const std::string& extension) {
  return fmt::format(
      "<?xml version=\"1.0\"?><TileMap version=\"1.0.0\"><SRS>EPSG:4326</SRS>"
      "<Origin x=\"-180\" y=\"-90\"/><TileFormat width=\"64\" height=\"64\" extension=\"{}\"/>"
      "<TileSets profile=\"geodetic\"><TileSet href=\"0\" units-per-pixel=\"2.8125\" order=\"0\"/>"
      "<TileSet href=\"1\" units-per-pixel=\"1.40625\" order=\"1\"/></TileSets></TileMap>",
      extension);
}

// 4 x 2 tiles of 64 pixels; `missing` leaves the north-easternmost out.
std::string writeTiles(const TestFolder& folder, bool missing) {
  const double stepDeg = 1.40625;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 2; ++row) {
      const std::filesystem::path place = folder.path / "tms" / "1" / std::to_string(column);
      std::filesystem::create_directories(place);
      if (missing && column == 3 && row == 1) continue;
      writePart(place / fmt::format("{}.png", row), -180 + 90 * column, -90 + 90 * (row + 1), stepDeg, 64, 64);
    }
  }
  std::ofstream(folder.path / "tms" / "tilemapresource.xml") << tileMap("png");
  return folder.path / "tms";
}

}  // namespace

TEST_CASE("A picture twice as wide as high and without georeference is the whole globe; no other is") {
  TestFolder folder;
  writePart(folder.file("globe.png"), -180, 90, 1, 360, 180);
  const auto imagery = ImageryMosaic::open({folder.file("globe.png")});
  REQUIRE(imagery);
  CHECK((*imagery)->files()[0].takenForGlobe);
  checkShowsGlobe(**imagery);

  writePart(folder.file("holiday.png"), -180, 90, 1, 300, 180);
  const auto holiday = ImageryMosaic::open({folder.file("holiday.png")});
  REQUIRE_FALSE(holiday);
  CHECK(holiday.error().message.find("-a_ullr") != std::string::npos);
  // Heights are never guessed.
  const auto heights = ElevationMosaic::open({folder.file("globe.png")});
  REQUIRE_FALSE(heights);
  CHECK(heights.error().message.find("no georeference") != std::string::npos);
}

TEST_CASE("Across the date line a picture of the globe has no seam") {
  TestFolder folder;
  writePart(folder.file("globe.png"), -180, 90, 1, 360, 180);
  const auto imagery = std::move(*ImageryMosaic::open({folder.file("globe.png")}));
  // Half way between the last and the first column's centres; the mean of both.
  const glm::vec3 mean = (globeColour(10.5, 179.5) + globeColour(10.5, -179.5)) / 2.0f;
  for (const double lonDeg : {-180.0, 180.0}) {
    const glm::vec4 seen = sampleAt(*imagery, 10.5, lonDeg);
    CHECK(seen.a == Approx(1));
    CHECK(glm::distance(glm::vec3(seen), mean) < 1.0f);
  }
  // Of neighbours' pictures too, coarse levels with several pixels in a texel included.
  const auto surface = std::move(*ElevationMosaic::open(
      {writeHeights(folder.file("h.tif"), postGrid(-89.5, -179.5, 1, 180, 360), [](double, double) { return 0; })}));
  const int size = 32;
  for (const int level : {1, 4}) {
    const auto a = paintTile(TileKey::containing(10, 179.9, level), size, *surface, imagery.get()).value();
    const auto b = paintTile(TileKey::containing(10, -179.9, level), size, *surface, imagery.get()).value();
    for (int j = 0; j < size / 2; ++j) {
      INFO("level " << level << ", texel " << j);
      const auto east = static_cast<size_t>(j * size + size - 1) * 3, west = static_cast<size_t>(j * size) * 3;
      for (size_t band = 0; band < 3; ++band) CHECK(std::abs(a[east + band] - b[west + band]) <= 12);
    }
  }
}

TEST_CASE("A TMS folder is one picture of its finest level's tiles") {
  TestFolder folder;
  const std::string tiles = writeTiles(folder, false);
  for (const std::string& source : {tiles, folder.path.string()}) {  // itself, and found in another folder
    const auto imagery = ImageryMosaic::open({source});
    INFO((imagery ? std::string() : imagery.error().message));
    REQUIRE(imagery);
    REQUIRE((*imagery)->files().size() == 1);
    CHECK((*imagery)->files()[0].grid.columns == 256);
    checkShowsGlobe(**imagery);
  }
}

TEST_CASE("Where a TMS folder lacks a tile the next source shows") {
  TestFolder folder;
  const auto imagery = std::move(*ImageryMosaic::open({writeTiles(folder, true)}));
  CHECK(sampleAt(*imagery, 40, 45).a == Approx(1));
  CHECK(sampleAt(*imagery, 40, 135).a == 0);
}

TEST_CASE("A TMS folder that makes no sense is refused, with what is wrong") {
  TestFolder folder;
  const std::filesystem::path tms = folder.path / "tms";
  std::filesystem::create_directories(tms);
  const auto refusal = [&](const std::string& xml) {
    std::ofstream(tms / "tilemapresource.xml") << xml;
    const auto imagery = ImageryMosaic::open({tms.string()});
    REQUIRE_FALSE(imagery);
    return imagery.error().message;
  };
  CHECK(refusal("<nonsense>").find("no TileMap") != std::string::npos);
  CHECK(refusal("<TileMap><SRS>http://example.com/srs</SRS></TileMap>").find("SRS") != std::string::npos);
  CHECK(refusal("<TileMap><SRS>EPSG:4326</SRS></TileMap>").find("lacks") != std::string::npos);
  CHECK(refusal(tileMap("png")).find("no tile") != std::string::npos);
  // A tile that is none, and tiles that lie a world apart.
  std::filesystem::create_directories(tms / "1" / "0");
  std::ofstream(tms / "1" / "0" / "0.png") << "no picture";
  CHECK(refusal(tileMap("png")).find("0.png") != std::string::npos);
  std::filesystem::create_directories(tms / "1" / "2000000000");
  std::ofstream(tms / "1" / "2000000000" / "0.png") << "no picture";
  CHECK(refusal(tileMap("png")).find("pixels apart") != std::string::npos);
}

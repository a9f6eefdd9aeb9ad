#include <catch2/catch.hpp>
#include <cmath>

#include "bake/bake_plan.h"
#include "bake/elevation_mosaic.h"
#include "bake/palette.h"
#include "bake/tile_painter.h"
#include "raster_files.h"

using namespace eye;

namespace {

using ColourFunction = std::function<glm::vec4(double latDeg, double lonDeg)>;

std::string writePicture(const std::string& path, const GeoGrid& grid, const ColourFunction& colour) {
  std::vector<uint8_t> rgba;
  for (int row = grid.rows - 1; row >= 0; --row) {
    for (int column = 0; column < grid.columns; ++column) {
      const glm::vec4 c = colour(grid.southDeg + row * grid.latStepDeg, grid.westDeg + column * grid.lonStepDeg);
      for (int band = 0; band < 4; ++band) rgba.push_back(static_cast<uint8_t>(c[band]));
    }
  }
  REQUIRE(writeImagery(path, grid, rgba));
  return path;
}

glm::vec4 sampleOne(const ImageryMosaic& imagery, double lat, double lon, double texelDeg) {
  const TileBounds region{lat - 0.01, lat + 0.01, lon - 0.01, lon + 0.01};
  return imagery.sample(region, texelDeg, texelDeg, {{lat, lon}}).value()[0];
}

glm::vec3 texel(const std::vector<uint8_t>& rgb, int size, int i, int j) {
  const auto at = static_cast<size_t>(j * size + i) * 3;
  return {float(rgb[at]), float(rgb[at + 1]), float(rgb[at + 2])};
}

}  // namespace

TEST_CASE("Imagery is interpolated when it is coarser than the texels, averaged when it is finer") {
  TestFolder folder;
  const auto stripes = [](double, double lon) {
    return std::lround(lon * 1000) % 2 ? glm::vec4(200, 100, 40, 255) : glm::vec4(100, 60, 20, 255);
  };
  const auto imagery =
      std::move(*ImageryMosaic::open({writePicture(folder.file("a.tif"), postGrid(49, 20, 0.001, 200, 200), stripes)}));
  CHECK(imagery->finestPixelDeg({49.05, 49.06, 20.05, 20.06}) == Approx(0.001));
  CHECK(imagery->finestPixelDeg({50.05, 50.06, 20.05, 20.06}) == 0);
  CHECK(sampleOne(*imagery, 49.1, 20.1, 0.0005).r == Approx(100).margin(1));
  CHECK(sampleOne(*imagery, 49.1, 20.101, 0.0005).r == Approx(200).margin(1));
  CHECK(sampleOne(*imagery, 49.1, 20.1005, 0.0005).r == Approx(150).margin(2));
  CHECK(sampleOne(*imagery, 49.1, 20.1, 0.02).r == Approx(150).margin(8));
  CHECK(sampleOne(*imagery, 49.1, 20.1, 0.0005).a == Approx(1));
}

TEST_CASE("Transparent imagery lets the next source through, at last the palette") {
  TestFolder folder;
  const auto half = [](double, double lon) { return glm::vec4(250, 10, 10, lon < 20.1 ? 255 : 0); };
  const auto blue = [](double, double) { return glm::vec4(10, 10, 250, 255); };
  const std::string top = writePicture(folder.file("top.tif"), postGrid(49, 20, 0.001, 200, 200), half);
  const std::string below = writePicture(folder.file("below.tif"), postGrid(49, 20, 0.01, 15, 15), blue);
  const auto imagery = std::move(*ImageryMosaic::open({top, below}));
  CHECK(sampleOne(*imagery, 49.05, 20.05, 0.001).r == Approx(250).margin(1));
  CHECK(sampleOne(*imagery, 49.05, 20.12, 0.001).b == Approx(250).margin(1));
  CHECK(sampleOne(*imagery, 49.18, 20.18, 0.001).a == 0);
}

TEST_CASE("Imagery without georeference or with deep channels is refused with a cure") {
  TestFolder folder;
  const std::string heights = writeHeights(folder.file("h.tif"), postGrid(49, 20, 0.01, 10, 10), hillsM);
  const auto deep = ImageryMosaic::open({heights});
  REQUIRE(!deep);
  CHECK(deep.error().message.find("-ot Byte") != std::string::npos);
}

TEST_CASE("A tile's picture has its south-west texel first and texels at its corners") {
  TestFolder folder;
  const TileKey key = TileKey::containing(10.1, 20.1, 6);
  const TileBounds b = key.bounds();
  const auto ramp = [&](double lat, double lon) {
    const double s = (lon - b.westDeg) / (b.eastDeg - b.westDeg), t = (lat - b.southDeg) / (b.northDeg - b.southDeg);
    return glm::vec4(std::clamp(20 + 200 * s, 0.0, 255.0), std::clamp(20 + 200 * t, 0.0, 255.0), 0, 255);
  };
  const auto imagery = std::move(*ImageryMosaic::open(
      {writePicture(folder.file("a.tif"), postGrid(b.southDeg - 0.1, b.westDeg - 0.1, 0.005, 330, 330), ramp)}));
  const auto surface =
      std::move(*ElevationMosaic::open({writeHeights(folder.file("h.tif"), postGrid(5, 15, 0.5, 20, 20), hillsM)}));
  const auto rgb = paintTile(key, 64, *surface, imagery.get()).value();
  CHECK(texel(rgb, 64, 0, 0).r == Approx(20).margin(3));
  CHECK(texel(rgb, 64, 63, 0).r == Approx(220).margin(3));
  CHECK(texel(rgb, 64, 0, 63).g == Approx(220).margin(3));
  CHECK(texel(rgb, 64, 0, 63).r == Approx(20).margin(3));
}

TEST_CASE("Neighbours' pictures agree along their common edge, across the date line and at the poles") {
  TestFolder folder;
  const auto surface = std::move(*ElevationMosaic::open(
      {writeHeights(folder.file("h.tif"), postGrid(-89.5, -179.5, 1, 180, 360), [](double lat, double lon) {
        return 800 + 700 * std::sin(lat * 0.1) * std::cos(lon * 0.017453292519943295 * 3);
      })}));
  const int size = 32;
  const TileKey west = TileKey::containing(10, 179.9, 4), east = TileKey::containing(10, -179.9, 4);
  const auto a = paintTile(west, size, *surface, nullptr).value(), c = paintTile(east, size, *surface, nullptr).value();
  for (int j = 0; j < size; ++j) CHECK(glm::distance(texel(a, size, size - 1, j), texel(c, size, 0, j)) <= 2.0f);
  // All pole cells show one colour at the pole.
  const auto pole = paintTile(TileKey::containing(89.9, 10, 4), size, *surface, nullptr).value();
  const auto opposite = paintTile(TileKey::containing(89.9, -100, 4), size, *surface, nullptr).value();
  CHECK(glm::distance(texel(pole, size, 0, 0), texel(opposite, size, 0, 0)) <= 4.0f);
}

TEST_CASE("The palette: sea, woods, rock and snow where they belong") {
  const auto at = [](double heightM, double slope, double latDeg) {
    GroundSample ground;
    ground.heightM = heightM;
    ground.slope = slope;
    ground.latDeg = latDeg;
    return groundColour(ground);
  };
  const glm::vec3 sea = at(0, 0, 45), deep = at(-4000, 0, 45);
  CHECK(sea.b > sea.r);
  CHECK(deep.b < sea.b);
  const glm::vec3 plain = at(200, 0.01, 48);
  CHECK(plain.g > plain.b);
  const glm::vec3 snow = at(4500, 0.2, 46);
  CHECK(std::min({snow.r, snow.g, snow.b}) > 0.75f);
  CHECK(at(4500, 0.2, 0).g < 0.7f);    // below the snow line at the equator
  CHECK(at(1200, 0.1, 75).g > 0.75f);  // above it in the far north
  const glm::vec3 cliff = at(1000, 1.5, 48);
  CHECK(std::abs(cliff.r - cliff.g) < 0.08f);  // grey
  CHECK(snowlineM(0) > snowlineM(60));
  CHECK(treelineM(48) < snowlineM(48));
  // Above the beach, heights change colour without steps.
  glm::vec3 last = at(-50, 0.02, 48);
  for (double height = -50; height < 5000; height += 1) {
    const glm::vec3 colour = at(height, 0.02, 48);
    CHECK(glm::distance(colour, last) < (std::abs(height) < 6 ? 0.65f : 0.05f));
    last = colour;
  }
}

TEST_CASE("The plan: levels, tolerances and pictures follow the sources") {
  TestFolder folder;
  const auto surface = std::move(
      *ElevationMosaic::open({writeHeights(folder.file("h.tif"), postGrid(49, 20, 1.0 / 1200, 241, 241), hillsM)}));
  PlanOptions options;
  options.textureSize = 128;
  const BakePlan plan = makePlan(*surface, nullptr, surface->spacingsDeg(), options);
  CHECK(plan.maxLevel == 14);  // 90 / 2^14 degrees are 6.6 posts of 3 arc-seconds
  CHECK(plan.finest().toleranceM(14) == kFinestErrorM);
  CHECK(plan.finest().toleranceM(9) >= 2 * plan.finest().toleranceM(10));
  CHECK(plan.finest().toleranceM(9) <= 2.26 * plan.finest().toleranceM(10));
  CHECK(plan.hasImagery(TileKey::octantRoot(3)));
  CHECK(plan.hasImagery(TileKey::containing(89.99, 10, 9)));
  CHECK(plan.hasImagery(TileKey::containing(49.1, 20.1, 11)));
  CHECK(!plan.hasImagery(TileKey::containing(49.1, 20.1, 12)));
  CHECK(!plan.hasImagery(TileKey::containing(-30, 20.1, 5)));
  CHECK(plan.texelErrorM(TileKey::containing(49.1, 20.1, 10)) > 0);
  CHECK(plan.texelErrorM(TileKey::containing(49.1, 20.1, 11)) == 0);
  CHECK(plan.wantsChildren(TileKey::containing(49.1, 20.1, 13), 1));
  CHECK(!plan.wantsChildren(TileKey::containing(49.1, 20.1, 13), 0.1));
  CHECK(!plan.wantsChildren(TileKey::containing(49.1, 20.1, 14), 1));
  CHECK(!plan.wantsChildren(TileKey::containing(-30, 20.1, 3), 100));

  // Cut short at a coarser level, it is at least as exact there as an uncut one.
  options.maxLevel = 11;
  const BakePlan shallow = makePlan(*surface, nullptr, surface->spacingsDeg(), options);
  CHECK(shallow.finest().toleranceM(11) <= plan.finest().toleranceM(11));
  CHECK(shallow.finest().toleranceM(11) > plan.finest().toleranceM(13));
  options.errorM = 3;
  CHECK(makePlan(*surface, nullptr, surface->spacingsDeg(), options).finest().toleranceM(11) == 3);
}

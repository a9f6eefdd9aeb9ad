#include "bake/elevation_mosaic.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <catch2/catch.hpp>
#include <limits>
#include <random>
#include <thread>

#include "bake/vertical_datum.h"
#include "raster/encode.h"
#include "raster_files.h"
#include "support/places.h"

using namespace eye;

namespace {

constexpr float kVoid = std::numeric_limits<float>::quiet_NaN();

std::unique_ptr<ElevationMosaic> openMosaic(const std::vector<std::string>& sources) {
  auto mosaic = ElevationMosaic::open(sources);
  INFO((mosaic ? std::string() : mosaic.error().message));
  REQUIRE(mosaic);
  return std::move(*mosaic);
}

// A file in UTM zone 33 N (central meridian 15 E), `stepM` apart, from an easting and northing of its south-west post.
void writeUtm(const std::string& path, double eastM, double northM, double stepM, int size,
              const HeightFunction& heightM) {
  std::vector<float> heights(static_cast<size_t>(size) * static_cast<size_t>(size));
  OGRSpatialReference utm, wgs84;
  utm.importFromEPSG(32633);
  wgs84.importFromEPSG(4326);
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> toGeographic(OGRCreateCoordinateTransformation(&utm, &wgs84));
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      double x = eastM + column * stepM, y = northM + (size - 1 - row) * stepM;
      REQUIRE(toGeographic->Transform(1, &x, &y));
      heights[static_cast<size_t>(row * size + column)] = static_cast<float>(heightM(y, x));
    }
  }
  const Dataset source = wrapPixels(heights.data(), size, size, 1, GDT_Float32, 4, 4);
  double transform[6] = {eastM - stepM / 2, stepM, 0, northM + (size - 0.5) * stepM, 0, -stepM};
  source->SetGeoTransform(transform);
  source->SetSpatialRef(&utm);
  REQUIRE(encodeToFile(*source, "GTiff", nullptr, path));
}

}  // namespace

TEST_CASE("The surface is the posts, and bilinear between them") {
  TestFolder folder;
  const GeoGrid grid = postGrid(49, 20, 1.0 / 1200, 121, 121);
  const auto mosaic = openMosaic({writeHeights(folder.file("a.tif"), grid, hillsM)});
  const auto post = [&](int row, int column) {
    return double(float(hillsM(49 + row * grid.latStepDeg, 20 + column * grid.lonStepDeg)));
  };
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const int row = int(random() % 120), column = int(random() % 120);
    const double lat = 49 + row / 1200.0, lon = 20 + column / 1200.0, half = 0.5 / 1200;
    CHECK(mosaic->heightM(lat, lon) == Approx(post(row, column)).margin(1e-6));
    const double centre =
        (post(row, column) + post(row + 1, column) + post(row, column + 1) + post(row + 1, column + 1)) / 4;
    CHECK(mosaic->heightM(lat + half, lon + half) == Approx(centre).margin(1e-6));
    CHECK(mosaic->heightM(lat + half / 2, lon) ==
          Approx(0.75 * post(row, column) + 0.25 * post(row + 1, column)).margin(1e-6));
  }
  CHECK(mosaic->finestSpacingDeg({49, 50, 20, 21}) == Approx(1.0 / 1200));
  CHECK(mosaic->finestSpacingDeg({-10, -9, 20, 21}) == 0);
  const PostLines lines = mosaic->postLines({49.01, 49.02, 20.03, 20.05});
  REQUIRE(lines.latDeg.size() == 11);
  CHECK(lines.lonDeg.size() == 23);
  CHECK(lines.latDeg.front() == Approx(49.01 + 1.0 / 1200).margin(1e-9));
}

TEST_CASE("Outside every source is the sea, reached over sixteen posts") {
  TestFolder folder;
  const GeoGrid grid = postGrid(10, 20, 0.01, 101, 101);
  const auto mosaic = openMosaic({writeHeights(folder.file("a.tif"), grid, [](double, double) { return 500; })});
  CHECK(mosaic->heightM(10, 20.5) == Approx(500));
  CHECK(mosaic->heightM(10 - 0.17, 20.5) == 0);
  CHECK(mosaic->heightM(-60, 100) == 0);
  double last = 500;
  for (double south = 0; south <= 0.17; south += 0.001) {
    const double height = mosaic->heightM(10 - south, 20.5);
    CHECK(height <= last + 1e-9);
    CHECK(last - height < 12);  // no step
    last = height;
  }
  CHECK(mosaic->heightM(10 - 0.08, 20.5) == Approx(250).margin(1));
  // The rim of the fade is a bend, so it is a post line.
  const PostLines lines = mosaic->postLines({9.8, 9.9, 19.8, 19.9});
  REQUIRE(!lines.latDeg.empty());
  CHECK(lines.latDeg.front() == Approx(9.84).margin(1e-9));
  CHECK(lines.lonDeg.front() == Approx(19.84).margin(1e-9));
}

TEST_CASE("Neighbouring files form one surface: no seam, rows that differ are averaged") {
  TestFolder folder;
  const GeoGrid west = postGrid(49, 20, 0.01, 101, 101), east = postGrid(49, 21, 0.01, 101, 101);
  writeHeights(folder.file("west.tif"), west, [](double, double) { return 100; });
  writeHeights(folder.file("east.tif"), east, [](double, double) { return 104; });
  const auto mosaic = openMosaic({folder.path});
  CHECK(mosaic->layers().size() == 1);
  CHECK(mosaic->heightM(49.5, 20.985) == Approx(100));
  CHECK(mosaic->heightM(49.5, 21) == Approx(102));
  CHECK(mosaic->heightM(49.5, 21.005) == Approx(103));
  CHECK(mosaic->heightM(49.5, 21.01) == Approx(104));
  // Given one by one they are the same layer.
  CHECK(openMosaic({folder.file("west.tif"), folder.file("east.tif")})->layers().size() == 1);
  CHECK(mosaic->dataBounds().eastDeg == Approx(22));
}

TEST_CASE("The preferred source wins inside its extent and fades into the next outside") {
  TestFolder folder;
  const GeoGrid fine = postGrid(49.4, 20.4, 0.002, 101, 101), coarse = postGrid(48, 19, 0.05, 61, 61);
  const std::string fineFile = writeHeights(folder.file("fine.tif"), fine, [](double, double) { return 800; });
  const std::string coarseFile =
      writeHeights(folder.file("coarse.tif"), coarse, [](double lat, double) { return 100 + 10 * (lat - 48); });
  const auto mosaic = openMosaic({fineFile, coarseFile});
  CHECK(mosaic->heightM(49.5, 20.5) == Approx(800));
  CHECK(mosaic->heightM(49.4, 20.4) == Approx(800));
  CHECK(mosaic->heightM(49.5, 20.3) == Approx(115).margin(1e-4));
  double last = 800;
  for (double lon = 20.4; lon > 20.35; lon -= 0.0001) {
    const double height = mosaic->heightM(49.5, lon);
    CHECK(std::abs(height - last) < 5);
    last = height;
  }
  // The other way around the coarse one hides the fine one.
  CHECK(openMosaic({coarseFile, fineFile})->heightM(49.5, 20.5) == Approx(115).margin(1e-4));
  CHECK(mosaic->finestSpacingDeg({49.45, 49.5, 20.45, 20.5}) == Approx(0.002));
  CHECK(mosaic->finestSpacingDeg({48.1, 48.2, 19.1, 19.2}) == Approx(0.05));
}

TEST_CASE("Voids are filled from the next source, or interpolated where there is none") {
  TestFolder folder;
  const GeoGrid grid = postGrid(49, 20, 0.005, 81, 81);
  // A plane with a hole of 21 x 21 posts.
  const auto plane = [](double lat, double lon) { return 1000 * (lat - 49) + 500 * (lon - 20); };
  const auto holed = [&](double lat, double lon) {
    return std::abs(lat - 49.2) < 0.0501 && std::abs(lon - 20.2) < 0.0501 ? double(kVoid) : plane(lat, lon);
  };
  const std::string file = writeHeights(folder.file("holed.tif"), grid, holed);
  const auto alone = openMosaic({file});
  CHECK(alone->layers()[0].files()[0].voids == 21 * 21);
  CHECK(alone->layers()[0].files()[0].collar == 0);
  for (double offset = -0.05; offset <= 0.05; offset += 0.0025) {
    CHECK(alone->heightM(49.2 + offset, 20.2) == Approx(plane(49.2 + offset, 20.2)).margin(35));
  }
  // A source below: its relief in the hole, without a step at the rim.
  const GeoGrid below = postGrid(48, 19, 0.05, 61, 61);
  const auto filled =
      openMosaic({file, writeHeights(folder.file("below.tif"), below, [](double, double) { return 700; })});
  CHECK(filled->heightM(49.2, 20.145) == Approx(plane(49.2, 20.145)).margin(1e-3));
  double last = filled->heightM(49.2, 20.14);
  for (double lon = 20.14; lon < 20.26; lon += 0.0005) {
    const double height = filled->heightM(49.2, lon);
    CHECK(std::abs(height - last) < 8);
    last = height;
  }
  CHECK(filled->heightM(49.2, 20.2) > 400);  // the hole's rim is at 250 to 350: its middle is on the way to 700
}

TEST_CASE("Missing posts around the data are no voids") {
  TestFolder folder;
  const GeoGrid grid = postGrid(49, 20, 0.01, 101, 101);
  const auto round = [](double lat, double lon) {
    return std::hypot(lat - 49.5, lon - 20.5) > 0.4 ? double(kVoid) : 600;
  };
  const auto mosaic = openMosaic({writeHeights(folder.file("round.tif"), grid, round)});
  CHECK(mosaic->layers()[0].files()[0].voids == 0);
  CHECK(mosaic->heightM(49.5, 20.5) == Approx(600));
  CHECK(mosaic->heightM(49.02, 20.02) == 0);
}

TEST_CASE("A global raster goes across the date line and to the poles") {
  TestFolder folder;
  // Cell-centred, 2 degrees.
  GeoGrid grid = postGrid(-89, -179, 2, 90, 180);
  const auto heights = [](double lat, double lon) {
    return 1000 + 5 * lat + 300 * std::cos(lon * 0.017453292519943295) * std::cos(lat * 0.017453292519943295);
  };
  const auto mosaic = openMosaic({writeHeights(folder.file("globe.tif"), grid, heights)});
  CHECK(mosaic->heightM(10, 180) == mosaic->heightM(10, -180));
  CHECK(mosaic->heightM(11, 180) == Approx((heights(11, 179) + heights(11, -179)) / 2).margin(1e-3));
  CHECK(mosaic->heightM(11, 179.5) == Approx(heights(11, 179) * 0.75 + heights(11, -179) * 0.25).margin(1e-3));
  CHECK(mosaic->heightM(11, -179.5) == Approx(heights(11, -179) * 0.75 + heights(11, 179) * 0.25).margin(1e-3));
  CHECK(mosaic->heightM(90, 0) == mosaic->heightM(90, 123.4));
  CHECK(mosaic->heightM(90, 0) == Approx(1000 + 5 * 89).margin(0.1));
  CHECK(mosaic->heightM(-90, 77) == Approx(1000 - 5 * 89).margin(0.1));
  CHECK(mosaic->heightM(89.999, 0) == Approx(mosaic->heightM(90, 0)).margin(0.1));
  // The same from 0 to 360.
  grid.westDeg = 1;
  const auto shifted = openMosaic({writeHeights(folder.file("globe360.tif"), grid, heights)});
  for (double lon = -180; lon <= 180; lon += 7.3)
    CHECK(shifted->heightM(33.3, lon) == Approx(mosaic->heightM(33.3, lon)).margin(1e-3));
}

TEST_CASE("Files on both sides of the date line meet there") {
  TestFolder folder;
  writeHeights(folder.file("e.tif"), postGrid(10, 179, 0.01, 101, 101), [](double, double) { return 200; });
  writeHeights(folder.file("w.tif"), postGrid(10, -180, 0.01, 101, 101), [](double, double) { return 210; });
  const auto mosaic = openMosaic({folder.path});
  CHECK(mosaic->layers().size() == 1);
  CHECK(mosaic->heightM(10.5, 180) == Approx(205));
  CHECK(mosaic->heightM(10.5, -180) == mosaic->heightM(10.5, 180));
  CHECK(mosaic->heightM(10.5, 179.995) == Approx(202.5).margin(1e-6));
  CHECK(mosaic->heightM(10.5, -179.995) == Approx(207.5).margin(1e-6));
}

TEST_CASE("A projected source is warped to latitude and longitude") {
  TestFolder folder;
  const auto smoothM = [](double lat, double lon) {
    return 500 + 2000 * (lat - 47) + 1000 * (lon - 15) + 200 * std::sin(lat * 20);
  };
  writeUtm(folder.file("utm.tif"), 480000, 5200000, 30, 400, smoothM);
  const auto mosaic = openMosaic({folder.file("utm.tif")});
  const ElevationFile& file = mosaic->layers()[0].files()[0];
  CHECK(file.warped);
  CHECK(file.voids == 0);
  CHECK(file.collar > 0);
  // The middle of the file: some 30 m spacing, heights to a few centimetres (the slope over what the warp rounds).
  CHECK(file.grid.latStepDeg * 111195 == Approx(30).epsilon(0.12));
  const double lat = 46.95 + 0.055, lon = 14.737 + 0.078;
  for (int i = -50; i <= 50; ++i) {
    const double at = lat + i * 0.0004, along = lon + i * 0.0006;
    CHECK(mosaic->heightM(at, along) == Approx(smoothM(at, along)).margin(0.3));
  }
}

TEST_CASE("What cannot be used is an error that names the file and the cure") {
  TestFolder folder;
  const std::string picture = folder.file("plain.tif");
  const std::vector<float> heights(16, 1.0f);
  const Dataset source = wrapPixels(heights.data(), 4, 4, 1, GDT_Float32, 4, 4);
  REQUIRE(encodeToFile(*source, "GTiff", nullptr, picture));
  const auto plain = ElevationMosaic::open({picture});
  REQUIRE(!plain);
  CHECK(plain.error().message.find(picture) != std::string::npos);
  CHECK(plain.error().message.find("gdal_edit.py") != std::string::npos);
  CHECK(plain.error().message.find("-a_ullr") != std::string::npos);

  const std::string empty =
      writeHeights(folder.file("empty.tif"), postGrid(1, 1, 0.1, 5, 5), [](double, double) { return double(kVoid); });
  CHECK(ElevationMosaic::open({empty}).error().message.find("no valid height") != std::string::npos);
  std::filesystem::create_directory(folder.file("none"));
  CHECK(ElevationMosaic::open({folder.file("none")}).error().kind == ErrorKind::notFound);
  CHECK(ElevationMosaic::open({folder.file("gone.tif")}).error().kind == ErrorKind::notFound);

  // Cut short: found before the bake, not in it.
  const std::string cut = writeHeights(folder.file("cut.tif"), postGrid(1, 1, 0.01, 600, 600), hillsM);
  std::filesystem::resize_file(cut, std::filesystem::file_size(cut) / 2);
  CHECK(ElevationMosaic::open({cut}).error().kind == ErrorKind::badData);
}

TEST_CASE("Pages that a small memory drops come back the same, from any thread") {
  TestFolder folder;
  const std::string file = writeHeights(folder.file("a.tif"), postGrid(0, 0, 0.001, 2500, 2500), hillsM);
  MosaicOptions small;
  small.cacheBytes = 5 << 20;  // one page
  const auto tight = std::move(*ElevationMosaic::open({file}, small));
  const auto roomy = openMosaic({file});
  std::vector<std::jthread> threads;
  std::atomic<int> wrong{0};
  for (unsigned seed = 0; seed < 3; ++seed) {
    threads.emplace_back([&, seed] {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> place(0, 2.49);
      for (int i = 0; i < 25; ++i) {
        const double lat = place(random), lon = place(random);
        if (tight->heightM(lat, lon) != roomy->heightM(lat, lon)) ++wrong;
      }
    });
  }
  threads.clear();
  CHECK(wrong == 0);
}

TEST_CASE("A vertical datum lifts heights by its undulation") {
  TestFolder folder;
  const std::string geoid = writeHeights(folder.file("geoid.tif"), postGrid(48, 19, 1, 4, 4),
                                         [](double lat, double) { return 40 + (lat - 48); });
  const auto correction = loadVerticalDatum(geoid);
  REQUIRE(correction);
  MosaicOptions options;
  options.correctionM = *correction;
  const std::string file =
      writeHeights(folder.file("a.tif"), postGrid(49, 20, 0.01, 101, 101), [](double, double) { return 100; });
  const auto mosaic = std::move(*ElevationMosaic::open({file}, options));
  CHECK(mosaic->heightM(49, 20) == Approx(141));
  CHECK(mosaic->heightM(49.5, 20.5) == Approx(141.5).margin(1e-4));
  CHECK(mosaic->heightM(50.5, 20.5) == Approx(42.5).margin(1e-4));  // the sea
  CHECK(loadVerticalDatum("egm0").error().kind == ErrorKind::notFound);
}

TEST_CASE("Real tiles: twelve files make one layer with posts at whole arc-seconds") {
  const std::string folder = eye::test::kTestData + "/dem/carpathia";
  if (!std::filesystem::exists(folder)) {
    WARN("no real elevation in " << folder);
    return;
  }
  const auto mosaic = openMosaic({folder});
  REQUIRE(mosaic->layers().size() == 1);
  CHECK(mosaic->layers()[0].lattice().lat.perDegree == 1200);
  CHECK(mosaic->layers()[0].lattice().lat.phase == 0);
  CHECK(mosaic->heightM(49.17917, 20.08833) > 2300);  // Rysy
  const TileBounds bounds = mosaic->dataBounds();
  CHECK(bounds.southDeg == Approx(48).margin(1e-9));
  CHECK(bounds.eastDeg == Approx(22).margin(1e-9));
}

TEST_CASE("Many heights at once are the same as one by one") {
  TestFolder folder;
  const std::string fine = writeHeights(folder.file("fine.tif"), postGrid(49.4, 20.4, 0.002, 101, 101), hillsM);
  GeoGrid world = postGrid(-89, -179, 2, 90, 180);
  const std::string globe = writeHeights(folder.file("globe.tif"), world, hillsM);
  const auto mosaic = openMosaic({fine, globe});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> lat(-90, 90), lon(-180, 180), near(-0.3, 0.3);
  std::vector<LatLon> points{{90, 0}, {-90, 20}, {0, 180}, {0, -180}, {89.5, 179.99}, {49.5, 20.5}};
  for (int i = 0; i < 3000; ++i) points.push_back({lat(random), lon(random)});
  for (int i = 0; i < 3000; ++i) points.push_back({49.5 + near(random), 20.5 + near(random)});
  std::vector<double> heights;
  mosaic->heightsM(points, heights);
  int wrong = 0;
  for (size_t i = 0; i < points.size(); ++i) wrong += heights[i] != mosaic->heightM(points[i].latDeg, points[i].lonDeg);
  CHECK(wrong == 0);
}

#include "bench/globe_blocks.h"

#include <spdlog/spdlog.h>
#include <catch2/catch.hpp>

#include "bake/bake_job.h"
#include "bake/raster_files.h"
#include "bench/globe_published.h"

namespace eye {
namespace {

// A flat globe, as deep as level 4.
const std::string& flatGlobe() {
  static const TestFolder folder;
  static const std::string path = [] {
    spdlog::set_level(spdlog::level::warn);
    BakeJob job;
    job.elevation = {
        writeHeights(folder.file("flat.tif"), postGrid(-89.5, -179.5, 1, 180, 360), [](double, double) { return 0; })};
    job.out = folder.file("flat.eyt");
    job.plan.maxLevel = 4;
    job.plan.errorM = 900;
    job.plan.textureSize = 16;
    BakeControl control;
    control.jobs = 2;
    REQUIRE(runBake(job, control));
    return job.out;
  }();
  return path;
}

View straightDown(double latDeg, double lonDeg, double altM, double fovDeg) {
  return makeView({{latDeg, lonDeg, altM}, 0, -90, 0}, symmetricFrustum(fovDeg, 512, 512, 1), 512, 512);
}

}  // namespace

TEST_CASE("Equation (7) gives the paper's five levels, with its signs of finer levels below") {
  for (const PublishedGlobe& row : kPublishedGlobe) {
    INFO(row.distanceKm);
    CHECK(levelByDistance(512, 768, 7, row.distanceKm * 1000) == row.level);
    CHECK(levelByDistance(1024, 256, 45, row.distanceKm * 1000) == row.level);
  }
  CHECK(levelByDistance(512, 768, 7, 1e12) == 0);
  CHECK(levelByDistance(512, 768, 7, 0) == kMaxLevel);
  // Half the distance, one level more.
  CHECK(levelByDistance(512, 768, 7, 4'936'000 / 2.0) == 5);
}

TEST_CASE("Blocks of a level: all of them counted, those behind the Earth and beside the view culled") {
  const auto reader = DatabaseReader::open(flatGlobe()).value();
  GlobeBlocks blocks(reader);
  for (int level = 0; level <= 4; ++level) {
    const View view = straightDown(0, 0, kPublishedGlobe[static_cast<size_t>(level)].distanceKm * 1000, 7);
    const auto counts = blocks.count(level, view, HorizonTest::ellipsoid).value();
    INFO("level " << level << ": " << counts.visible << " of " << counts.blocks);
    CHECK(counts.blocks == tilesInLevel(level));
    CHECK(counts.visible == 4);  // round the corner below; the far octants lie behind the Earth
    const auto paper = blocks.count(level, view, HorizonTest::paper).value();
    CHECK(paper.visible >= counts.visible);
  }
  // The whole disc in view: never less than the visible cap's share of the globe.
  const double altM = 9'172'000, capShare = (1 - 6371 / (6371 + altM / 1000)) / 2;
  const auto disc = blocks.count(3, straightDown(0, 0, altM, 60), HorizonTest::ellipsoid).value();
  CHECK(static_cast<double>(disc.visible) > capShare * static_cast<double>(disc.blocks));
  CHECK(disc.visible < disc.blocks / 2);
}

}  // namespace eye

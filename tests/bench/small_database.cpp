#include "bench/small_database.h"

#include <spdlog/spdlog.h>
#include <catch2/catch.hpp>

#include "bake/bake_job.h"
#include "bake/raster_files.h"

namespace eye {

double swellsAndRidgesM(double latDeg, double lonDeg) {
  const double rough = latDeg > 49.3 && lonDeg > 20.3 ? 1 : 0;
  return 300 + 8 * std::sin(latDeg * 61) * std::cos(lonDeg * 47) +
         rough * 500 * (1 + std::sin(latDeg * 200) * std::cos(lonDeg * 150));
}

const std::string& smallDatabase() {
  static const TestFolder folder;
  static const std::string path = [] {
    spdlog::set_level(spdlog::level::warn);
    BakeJob job;
    job.elevation = {writeHeights(folder.file("ground.tif"), postGrid(49, 20, 1.0 / 200, 121, 121), swellsAndRidgesM)};
    job.out = folder.file("ground.eyt");
    job.plan.errorM = 4;
    job.plan.textureSize = 32;
    BakeControl control;
    control.jobs = 2;
    const auto outcome = runBake(job, control);
    INFO((outcome ? std::string() : outcome.error().message));
    REQUIRE(outcome);
    return job.out;
  }();
  return path;
}

}  // namespace eye

// A small database of ground that is known in closed form, for panoramas of it.
#pragma once

#include <string>

#include <spdlog/spdlog.h>
#include <catch2/catch.hpp>

#include "bake/bake_job.h"
#include "bake/raster_files.h"

namespace eye {

// The database's path; it lasts as long as the folder.
inline std::string bakeGround(const TestFolder& folder, const GeoGrid& grid, double (*heightM)(double, double),
                              double errorM) {
  spdlog::set_level(spdlog::level::warn);
  BakeJob job;
  job.elevation = {writeHeights(folder.file("ground.tif"), grid, heightM)};
  job.out = folder.file("ground.eyt");
  job.plan.errorM = errorM;
  job.plan.textureSize = 32;
  BakeControl control;
  control.jobs = 2;
  REQUIRE(runBake(job, control));
  return job.out;
}

}  // namespace eye

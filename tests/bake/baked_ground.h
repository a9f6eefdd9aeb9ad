// A database of made-up ground, baked by the test that wants it and gone with it.
#pragma once

#include <spdlog/spdlog.h>
#include <catch2/catch.hpp>

#include "bake/bake_job.h"
#include "bake/raster_files.h"

namespace eye {

struct BakedGround {
  TestFolder folder;
  std::string database = folder.file("ground.eyt");

  BakedGround(const GeoGrid& posts, const HeightFunction& heightM, double errorM, int textureSize = 32) {
    spdlog::set_level(spdlog::level::warn);
    BakeJob job;
    job.elevation = {writeHeights(folder.file("ground.tif"), posts, heightM)};
    job.out = database;
    job.plan.errorM = errorM;
    job.plan.textureSize = textureSize;
    BakeControl control;
    control.jobs = 2;
    const auto outcome = runBake(job, control);
    INFO((outcome ? std::string() : outcome.error().message));
    REQUIRE(outcome);
  }
};

}  // namespace eye

#include "bake/bake_job.h"

#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include "bake/elevation_mosaic.h"
#include "bake/shard.h"
#include "bake/vertical_datum.h"

namespace eye {

namespace {

// What a --resume must share with the bake that it goes on with, beside what DatabaseInfo has anyway.
std::string describe(const BakeJob& job) {
  std::string text = fmt::format("elevation: {}", fmt::join(job.elevation, ", "));
  if (!job.imagery.empty()) text += fmt::format("; imagery: {}", fmt::join(job.imagery, ", "));
  if (!job.verticalDatum.empty()) text += fmt::format("; vertical datum: {}", job.verticalDatum);
  if (job.plan.region) {
    const TileBounds& r = *job.plan.region;
    text += fmt::format("; region: {},{},{},{}", r.westDeg, r.southDeg, r.eastDeg, r.northDeg);
  }
  if (job.plan.shard) text += describeShard(*job.plan.shard);
  return text;
}

void report(const ElevationMosaic& mosaic) {
  for (const ElevationLayer& layer : mosaic.layers()) {
    for (const ElevationFile& file : layer.files()) {
      spdlog::info("{}: {} x {} posts {:.4g}\" apart, {:.0f} to {:.0f} m{}", file.path, file.grid.columns,
                   file.grid.rows, file.grid.latStepDeg * 3600, file.minM, file.maxM,
                   file.warped ? ", warped to WGS84" : "");
      if (file.voids > 0) {
        spdlog::info("{}: {} void posts ({:.3g} %), filled from the next source or interpolated", file.path, file.voids,
                     100.0 * static_cast<double>(file.voids) / static_cast<double>(file.posts));
      }
      if (file.collar > 0) spdlog::info("{}: {} posts around the data left to the next source", file.path, file.collar);
    }
  }
}

}  // namespace

Result<BakeOutcome> runBake(const BakeJob& job, BakeControl control) {
  std::error_code ignored;
  if (!job.resume && std::filesystem::exists(job.out, ignored)) {
    return fail(ErrorKind::usage, fmt::format("{}: exists already; go on with --resume, or delete it first", job.out));
  }
  MosaicOptions options;
  if (!job.verticalDatum.empty()) {
    auto correction = loadVerticalDatum(job.verticalDatum);
    if (!correction) return tl::unexpected(correction.error());
    options.correctionM = std::move(*correction);
  }
  const auto elevation = ElevationMosaic::open(job.elevation, options);
  if (!elevation) return tl::unexpected(elevation.error());
  const auto imagery = ImageryMosaic::open(job.imagery);
  if (!imagery) return tl::unexpected(imagery.error());
  const ElevationMosaic& surface = **elevation;
  report(surface);
  for (const ImageryFile& file : (*imagery)->files()) {
    spdlog::info("{}: {} x {} pixels of {:.4g}\"{}", file.path, file.grid.columns, file.grid.rows,
                 file.grid.latStepDeg * 3600,
                 file.warped          ? ", warped to WGS84"
                 : file.takenForGlobe ? ", without georeference: taken for the whole globe"
                                      : "");
  }

  const BakePlan plan =
      makePlan(surface, job.imagery.empty() ? nullptr : imagery->get(), surface.spacingsDeg(), job.plan);
  DatabaseInfo info;
  info.maxLevel = plan.maxLevel;
  info.finestErrorM = plan.finest().finestErrorM;
  info.textureSize = plan.textureSize;
  info.dataBounds = surface.dataBounds();
  info.description = describe(job);
  spdlog::info("{}: levels 0 to {}, finest error {:.3g} m, textures {} x {}", job.out, plan.maxLevel,
               plan.finest().finestErrorM, plan.textureSize, plan.textureSize);
  const bool exists = std::filesystem::exists(job.out, ignored);
  Result<DatabaseWriter> writer =
      exists ? DatabaseWriter::resume(job.out, info) : DatabaseWriter::create(job.out, info);
  if (!writer) return tl::unexpected(writer.error());
  control.sourceError = [&surface] { return surface.readError(); };
  return bake(plan, *writer, control);
}

}  // namespace eye

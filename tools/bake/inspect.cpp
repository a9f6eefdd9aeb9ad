#include "inspect.h"

#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "progress.h"
#include "terrain/database.h"

namespace eye {

Result<void> printInfo(const std::string& path, bool json) {
  const auto reader = DatabaseReader::open(path);
  if (!reader) return tl::unexpected(reader.error());
  const auto levels = reader->levels();
  if (!levels) return tl::unexpected(levels.error());
  const DatabaseInfo& info = reader->info();
  const TileBounds& bounds = info.dataBounds;
  uint64_t tiles = 0, meshBytes = 0, imageryBytes = 0;
  for (const auto& level : *levels) {
    tiles += level.tiles;
    meshBytes += level.meshBytes;
    imageryBytes += level.imageryBytes;
  }
  std::error_code ignored;
  const uint64_t fileBytes = std::filesystem::file_size(path, ignored);

  if (json) {
    nlohmann::ordered_json out;
    out["file"] = path;
    out["schema_version"] = info.schemaVersion;
    out["complete"] = info.complete;
    out["description"] = info.description;
    out["extent"] = {
        {"west", bounds.westDeg}, {"south", bounds.southDeg}, {"east", bounds.eastDeg}, {"north", bounds.northDeg}};
    out["max_level"] = info.maxLevel;
    out["finest_error_m"] = info.finestErrorM;
    out["texture_size"] = info.textureSize;
    out["tiles"] = tiles;
    out["bytes"] = {{"file", fileBytes}, {"mesh", meshBytes}, {"imagery", imageryBytes}};
    out["levels"] = nlohmann::ordered_json::array();
    for (const auto& level : *levels) {
      out["levels"].push_back({{"level", level.level},
                               {"tiles", level.tiles},
                               {"leaves", level.leaves},
                               {"mesh_bytes", level.meshBytes},
                               {"imagery_bytes", level.imageryBytes},
                               {"max_error_m", level.maxErrorM},
                               {"mean_error_m", level.meanErrorM}});
    }
    fmt::print("{}\n", out.dump(2));
    return {};
  }
  fmt::print("{}: schema {}, {}\n", path, info.schemaVersion,
             info.complete ? "complete" : "not complete: eyepoint flies it, eyepoint-bake --resume goes on");
  fmt::print("sources   {}\n", info.description);
  fmt::print("extent    {:.4f} to {:.4f} N, {:.4f} to {:.4f} E\n", bounds.southDeg, bounds.northDeg, bounds.westDeg,
             bounds.eastDeg);
  fmt::print("tiles     {} in levels 0 to {}, finest error {:.3g} m, textures {} x {}\n", tiles, info.maxLevel,
             info.finestErrorM, info.textureSize, info.textureSize);
  fmt::print("bytes     {:.1f} MB file, {:.1f} MB meshes, {:.1f} MB imagery\n\n", double(fileBytes) / 1e6,
             double(meshBytes) / 1e6, double(imageryBytes) / 1e6);
  fmt::print("level    tiles   leaves   mesh MB   imagery MB   max error m   mean error m\n");
  for (const auto& level : *levels) {
    fmt::print("{:5} {:8} {:8} {:9.2f} {:12.2f} {:13.2f} {:14.2f}\n", level.level, level.tiles, level.leaves,
               double(level.meshBytes) / 1e6, double(level.imageryBytes) / 1e6, level.maxErrorM, level.meanErrorM);
  }
  return {};
}

Result<void> verify(const std::string& path) {
  const auto reader = DatabaseReader::open(path);
  if (!reader) return tl::unexpected(reader.error());
  ProgressPrinter printer;
  return reader->verify([&](uint64_t done, uint64_t total) { printer.showShare("verified", done, total); });
}

}  // namespace eye

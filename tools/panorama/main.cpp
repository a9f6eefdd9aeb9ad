// eyepoint-panorama: the view all round from a place, as a picture with names and a map of distances.
#include <cstdio>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/options.h"
#include "app/process_setup.h"
#include "base/command_line.h"
#include "base/version.h"
#include "link/pose_limits.h"
#include "pano/run.h"

namespace {

using namespace eye;

struct Arguments {
  PanoramaJob job;
  std::string at, earth = "ellipsoid", depth = "range", logLevel = "warn";
  int widthPx = 8192;
  double verticalFovDeg = 40;
  bool onSummit = false;
};

void declareOptions(CLI::App& app, Arguments& args) {
  PanoramaOptions& options = args.job.options;
  app.add_option("--terrain", options.terrain, "Terrain database made by eyepoint-bake; else the embedded demo")
      ->type_name("FILE");
  app.add_option("--at", args.at, "The eye: lat,lon, with an altitude or with +height above the ground (default +2)")
      ->type_name("LAT,LON[,ALT|,+AGL]")
      ->required();
  app.add_flag("--summit", args.onSummit, "Stand on the summit: on the highest ground uphill within 250 m of --at");
  app.add_option("--width", args.widthPx, "Pixels all round, 360 to 16384")->type_name("PX")->capture_default_str();
  app.add_option("--vertical-fov", args.verticalFovDeg, "Degrees from the lowest row to the highest, 1 to 90")
      ->type_name("DEG")
      ->capture_default_str();
  app.add_option("--refraction", options.refraction, "The Earth's radius over a ray's, 0 (none) to 0.5")
      ->type_name("K")
      ->capture_default_str();
  app.add_option("--earth", args.earth, "Shape: ellipsoid (WGS84), or sphere, as published panoramas have it")
      ->check(CLI::IsMember({"ellipsoid", "sphere"}))
      ->capture_default_str();
  app.add_option("--depth", args.depth, "Distances: range, or paper: planar depth out of a 24-bit depth buffer")
      ->check(CLI::IsMember({"range", "paper"}))
      ->capture_default_str();
  app.add_option("--peaks", args.job.peaks, "Names: CSV, GeoJSON or GeoNames; may be given again")
      ->type_name("FILE")
      ->allow_extra_args(false);
  app.add_option("--out", args.job.out, "Writes BASE.png, BASE.distance.tif, BASE.peaks.csv")
      ->type_name("BASE")
      ->required();
  app.add_option("--time-of-day", options.timeOfDayH, "Local solar time at midsummer, hours: where the sun stands")
      ->type_name("H")
      ->capture_default_str();
  app.add_option("--visibility", options.visibilityM, "How far one sees through the haze")
      ->type_name("M")
      ->capture_default_str();
  app.add_option("--cache-gpu", options.cacheGpuMiB, "Memory for meshes and textures")
      ->type_name("MIB")
      ->capture_default_str();
  app.add_option("--device", options.device, "Part of a Vulkan device's name; eyepoint lists them")->type_name("NAME");
  app.add_option("--log-level", args.logLevel, "What is printed")
      ->check(CLI::IsMember({"trace", "debug", "info", "warn", "error", "off"}))
      ->capture_default_str();
  app.set_version_flag("--version", versionLine("eyepoint-panorama"));
  app.footer(
      "Examples:\n"
      "  eyepoint-panorama --terrain tatra.eyt --at 49.1795,20.0881 --summit --peaks summits.csv --out rysy\n"
      "  eyepoint-panorama --terrain alps.eyt --at 46.5,8.1,+300 --width 16384 --out over_the_valley");
}

// A comparison that NaN fails.
Result<void> within(const char* option, double value, double least, double most) {
  if (value >= least && value <= most) return {};
  return fail(ErrorKind::usage, fmt::format("{} {} is outside {} to {}", option, value, least, most));
}

Result<void> check(Arguments& args) {
  PanoramaOptions& options = args.job.options;
  for (const Result<void>& checked :
       {within("--width", args.widthPx, 360, 16384), within("--vertical-fov", args.verticalFovDeg, 1, 90),
        within("--refraction", options.refraction, 0, 0.5), within("--time-of-day", options.timeOfDayH, 0, 24),
        within("--visibility", options.visibilityM, kMinVisibilityM, kMaxVisibilityM),
        within("--cache-gpu", static_cast<double>(options.cacheGpuMiB), 16, 65536)})
    if (!checked) return checked;
  const Result<EyeWish> at = parseEyeWish(args.at);
  if (!at) return tl::unexpected(at.error());
  args.job.at = *at;
  args.job.at.onSummit = args.onSummit;
  options.frame = panoramaFrame(args.widthPx, args.verticalFovDeg);
  options.earth = args.earth == "sphere" ? EarthShape::sphere : EarthShape::ellipsoid;
  options.depth = args.depth == "paper" ? DepthKind::paper : DepthKind::range;
  if (options.terrain.empty()) options.terrain = defaultTerrainPath();
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  setUpProcess();
  CLI::App app("Draws the panorama from a place: names, and the distance of every pixel.", "eyepoint-panorama");
  Arguments args;
  declareOptions(app, args);
  if (const std::optional<int> status = parseArguments(app, argc, argv)) return *status;
  logToStderr("eyepoint-panorama", args.logLevel);
  if (const Result<void> fine = check(args); !fine) return complain("eyepoint-panorama", fine.error());
  if (const Result<void> done = runPanorama(args.job); !done) return complain("eyepoint-panorama", done.error());
  return 0;
}

// eyepoint-bake: options in, exit status out.
#include <csignal>
#include <cstdio>
#include <thread>

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include "bake/bake_job.h"
#include "bake/demo_terrain.h"
#include "bake/merge.h"
#include "bake/shard.h"
#include "base/command_line.h"
#include "base/user_folders.h"
#include "base/version.h"
#include "inspect.h"
#include "progress.h"

namespace {

using namespace eye;

std::atomic<bool> stopAsked{false};

extern "C" void askToStop(int) {
  stopAsked.store(true);
}

constexpr const char* kAbout =
    "Builds a terrain database (.eyt) for eyepoint from elevation and imagery.\n\n"
    "Examples:\n"
    "  eyepoint-bake --elevation N49E020.hgt --out tatra.eyt\n"
    "  eyepoint-bake --elevation lidar.tif srtm/ etopo.tif --imagery ortho.tif --out alps.eyt\n"
    "        in order of preference: where the lidar ends, the folder of tiles goes on, then the globe\n"
    "  eyepoint-bake --elevation srtm/ --region 19,49,21,50 --error 0.5 --out small.eyt\n"
    "  eyepoint-bake --elevation srtm/ --out alps.eyt --resume      after a kill or a full disk\n"
    "  eyepoint-bake --elevation srtm/ --shard 1/16 --out part1.eyt   one of 16 processes or machines\n"
    "  eyepoint-bake merge alps.eyt part*.eyt                       joins them\n"
    "  eyepoint-bake info alps.eyt\n"
    "  eyepoint-bake verify alps.eyt\n"
    "  eyepoint-bake demo           the embedded terrain, where eyepoint looks for it";

struct Arguments {
  BakeJob job;
  int jobs = 0;  // 0: one a core
  std::string region, shard;
  std::string logLevel = "info";
  std::string file;                 // of info and verify; what merge makes
  std::vector<std::string> shards;  // that merge joins
  bool json = false;
};

TileBounds parseRegion(const std::string& text) {
  TileBounds region{};
  int used = 0;
  const int read = std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf%n", &region.westDeg, &region.southDeg, &region.eastDeg,
                               &region.northDeg, &used);
  const bool valid = read == 4 && static_cast<size_t>(used) == text.size() && region.westDeg >= -180 &&
                     region.eastDeg <= 180 && region.southDeg >= -90 && region.northDeg <= 90 &&
                     region.westDeg < region.eastDeg && region.southDeg < region.northDeg;
  if (!valid) {
    throw CLI::ValidationError("--region",
                               fmt::format("'{}' is no region; give WEST,SOUTH,EAST,NORTH in degrees within "
                                           "-180,-90,180,90, such as 19,49,21,50",
                                           text));
  }
  return region;
}

std::string checkShard(const std::string& text) {
  return parseShard(text) ? ""
                          : fmt::format("'{}' is no shard; give I/N, such as 2/16, N at most {}", text, kMostShards);
}

std::string checkTextureSize(const std::string& text) {
  const int size = std::atoi(text.c_str());
  const bool valid = size >= 16 && size <= 2048 && (size & (size - 1)) == 0 && std::to_string(size) == text;
  return valid ? "" : "'" + text + "' is no power of two from 16 to 2048";
}

// CLI::Range lets NaN through, since NaN is not less than anything.
std::string checkError(const std::string& text) {
  char* end = nullptr;
  const double errorM = std::strtod(text.c_str(), &end);
  const bool valid = *end == '\0' && errorM >= 0.001 && errorM <= 10000;
  return valid ? "" : "'" + text + "' is no error from 0.001 to 10000 metres";
}

void addCommonOptions(CLI::App& app, Arguments& arguments) {
  app.add_option("--out", arguments.job.out, "The database to write; it must not exist, but for --resume")
      ->type_name("FILE.eyt");
  app.add_option("--jobs", arguments.jobs, "Threads; default: one a core")->check(CLI::Range(1, 1024))->type_name("N");
  app.add_flag("--resume", arguments.job.resume, "Go on with what an interrupted bake of the same sources left");
}

void addBakeOptions(CLI::App& app, Arguments& arguments) {
  BakeJob& job = arguments.job;
  app.add_option(
         "--elevation", job.elevation,
         "Elevation in order of preference: anything that GDAL opens, or folders of it. Voids are filled, edges "
         "blended, and outside everything is sea level")
      ->type_name("SRC...");
  app.add_option(
         "--imagery", job.imagery,
         "Imagery in order of preference, likewise. Where there is none, colour comes from elevation, slope and "
         "latitude")
      ->type_name("SRC...");
  addCommonOptions(app, arguments);
  app.add_option("--max-level", job.plan.maxLevel, "Finest level; default: what the sources have detail for")
      ->check(CLI::Range(0, kMaxLevel))
      ->type_name("N");
  app.add_option(
         "--error", job.plan.errorM,
         "Greatest error of the finest level in metres; default: 0.25 for 3-arc-second posts and finer, more for "
         "coarser ones")
      ->check(CLI::Validator(checkError, "0.001..10000"))
      ->type_name("M");
  app.add_option("--texture-size", job.plan.textureSize, "Texels along a tile's edge, a power of two (default 256)")
      ->check(CLI::Validator(checkTextureSize, "POWER OF TWO"))
      ->type_name("N");
  app.add_option("--region", arguments.region, "Refine only here, degrees")->type_name("W,S,E,N");
  app.add_option("--shard", arguments.shard, "Bake only part I of N; eyepoint-bake merge joins the parts")
      ->check(CLI::Validator(checkShard, ""))
      ->type_name("I/N");
  app.add_option("--vertical-datum", job.verticalDatum,
                 "What the heights are above: egm84, egm96, egm2008 or a file of geoid undulations (.gtx, .tif, .pgm); "
                 "they become heights above the WGS84 ellipsoid. Default: heights as they are")
      ->type_name("NAME/FILE");
}

Result<void> runJob(const Arguments& arguments) {
  BakeControl control;
  control.jobs =
      arguments.jobs > 0 ? arguments.jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  control.stop = &stopAsked;
  ProgressPrinter printer;
  control.progress = [&](const BakeProgress& progress) { printer.show(progress); };
  struct sigaction action {};
  action.sa_handler = askToStop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // the second one ends the program at once; the file stays valid
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);

  const auto outcome = runBake(arguments.job, control);
  if (!outcome) return tl::unexpected(outcome.error());
  if (*outcome == BakeOutcome::interrupted) {
    return fail(ErrorKind::io,
                fmt::format("interrupted; {} is valid as far as it got: repeat the command with --resume "
                            "to go on",
                            arguments.job.out));
  }
  spdlog::info("{}: done; look at it with: eyepoint --terrain {}", arguments.job.out, arguments.job.out);
  return {};
}

Result<void> runDemo(Arguments& arguments) {
  std::string& out = arguments.job.out;
  if (out.empty()) {
    out = defaultTerrainPath();
    std::error_code failed;  // the bake says it
    std::filesystem::create_directories(std::filesystem::path(out).parent_path(), failed);
  }
  auto sources = makeDemoSources();
  if (!sources) return tl::unexpected(sources.error());
  arguments.job.elevation = std::move(sources->elevation);
  arguments.job.imagery = std::move(sources->imagery);
  return runJob(arguments);
}

Result<void> runMerge(const Arguments& arguments) {
  ProgressPrinter printer;
  const Result<void> merged = mergeShards(arguments.file, arguments.shards, [&printer](uint64_t done, uint64_t total) {
    printer.showShare("merged", done, total);
  });
  if (merged) spdlog::info("{}: done; look at it with: eyepoint --terrain {}", arguments.file, arguments.file);
  return merged;
}

int report(const Result<void>& result) {
  return result ? 0 : complain("eyepoint-bake", result.error());
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{kAbout, "eyepoint-bake"};
  app.set_version_flag("--version", versionLine("eyepoint-bake"));
  app.add_option("--log-level", arguments.logLevel, "trace, debug, info, warn, error or off (default info)")
      ->check(CLI::IsMember({"trace", "debug", "info", "warn", "error", "off"}))
      ->type_name("LEVEL");
  app.fallthrough();
  addBakeOptions(app, arguments);
  CLI::App* info = app.add_subcommand("info", "Extent, levels, tiles, bytes and errors of a database");
  info->add_option("FILE", arguments.file, "The database")->required();
  info->add_flag("--json", arguments.json, "One JSON object");
  CLI::App* verifying = app.add_subcommand("verify", "Check every checksum and invariant; exit 1 on the first damage");
  verifying->add_option("FILE", arguments.file, "The database")->required();
  CLI::App* merge = app.add_subcommand("merge", "Join the shards of one bake");
  merge->add_option("OUT", arguments.file, "The database to write; it must not exist")->required();
  merge->add_option("IN", arguments.shards, "Every shard, see --shard")->required();
  CLI::App* demo =
      app.add_subcommand("demo", "Bake the embedded demo terrain; without --out, where eyepoint looks for it");
  addCommonOptions(*demo, arguments);
  app.require_subcommand(0, 1);
  try {
    app.parse(argc, argv);
    if (!arguments.region.empty()) arguments.job.plan.region = parseRegion(arguments.region);
    if (!arguments.shard.empty()) arguments.job.plan.shard = parseShard(arguments.shard);
    const bool bakes = !info->parsed() && !verifying->parsed() && !merge->parsed();
    if (bakes && !demo->parsed() && arguments.job.elevation.empty()) {
      throw CLI::RequiredError("--elevation SRC... (see --help for examples)");
    }
    if (bakes && !demo->parsed() && arguments.job.out.empty()) throw CLI::RequiredError("--out FILE.eyt");
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    fmt::print(stderr, "eyepoint-bake: {}\n", error.what());
    return 2;
  }
  const auto log = spdlog::stderr_color_mt("eyepoint-bake");
  log->set_pattern("%^%l%$: %v");
  spdlog::set_default_logger(log);
  spdlog::set_level(spdlog::level::from_str(arguments.logLevel));

  if (info->parsed()) return report(printInfo(arguments.file, arguments.json));
  if (verifying->parsed()) {
    const Result<void> sound = verify(arguments.file);
    if (sound) fmt::print("{}: sound\n", arguments.file);
    return report(sound);
  }
  if (merge->parsed()) return report(runMerge(arguments));
  return report(demo->parsed() ? runDemo(arguments) : runJob(arguments));
}

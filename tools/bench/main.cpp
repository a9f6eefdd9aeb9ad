// eyepoint-bench: suites of measurements over a terrain database, as report.json and report.html; reports compared.
#include <cstdio>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/process_setup.h"
#include "base/command_line.h"
#include "base/nearest_word.h"
#include "base/progress_line.h"
#include "base/version.h"
#include "bench/compare.h"
#include "bench/plot_json.h"
#include "bench/suites.h"
#include "telemetry/cpu_time.h"
#include "telemetry/trace.h"

namespace {

using namespace eye;

constexpr const char* kAll = "all";

struct Arguments {
  std::vector<std::string> names;
  std::string out, logLevel = "warn";
  SuiteOptions options;
  std::string report, baseline;  // of compare; report: of plots too
  bool update = false;
};

std::string suiteNames() {
  std::string names;
  for (const Suite& suite : suites()) names += fmt::format("  {:<10} {}\n", suite.name, suite.description);
  return names + fmt::format("  {:<10} each of them\n", kAll);
}

void declareOptions(CLI::App& app, Arguments& args) {
  app.add_option("suites", args.names, "What to measure, see below")->type_name("SUITE");
  app.add_option("--terrain", args.options.terrain, "Terrain database made by eyepoint-bake; else the embedded demo")
      ->type_name("FILE");
  app.add_option("--out", args.out, "Folder for report.json and report.html, or for plots; made where it is missing")
      ->type_name("DIR");
  app.add_option("--track", args.options.tracks,
                 "Recorded flight for the suite flight (CSV, IGC or pcap); may be given again")
      ->type_name("FILE")
      ->allow_extra_args(false);
  app.add_option("--peaks", args.options.peaks,
                 "Summits for the suite panorama (CSV, GeoJSON, GeoNames); may be given again; else the terrain's own")
      ->type_name("FILE")
      ->allow_extra_args(false);
  app.add_option(
         "--elevation", args.options.elevation,
         "What the terrain was baked from, the truth of the suite pareto; may be given again; else its finest meshes")
      ->type_name("SRC")
      ->allow_extra_args(false);
  app.add_flag("--quick", args.options.quick, "Fewer views and frames: seconds a suite, to see that it works");
  app.add_option("--device", args.options.device, "Part of a Vulkan device's name; eyepoint lists them")
      ->type_name("NAME");
  app.add_option("--log-level", args.logLevel, "What is printed")
      ->check(CLI::IsMember({"trace", "debug", "info", "warn", "error", "off"}))
      ->capture_default_str();
  app.set_version_flag("--version", versionLine("eyepoint-bench"));
  app.footer("Suites:\n" + suiteNames() +
             "\nExamples:\n"
             "  eyepoint-bench culling --terrain tatra.eyt --out culling\n"
             "  eyepoint-bench all --terrain tatra.eyt --out report --quick\n"
             "  eyepoint-bench compare report/report.json baseline.json --update     keeps this run's figures\n"
             "  eyepoint-bench compare report/report.json baseline.json              holds a later run against them\n"
             "  eyepoint-bench plots report/report.json --out pictures");
}

struct Subcommands {
  CLI::App *compare, *plots;
};

Subcommands declareSubcommands(CLI::App& app, Arguments& args) {
  CLI::App* compare = app.add_subcommand(
      "compare", "Hold a report against a baseline: counts exactly, CPU time after the machines' speed is divided out");
  compare->add_option("REPORT", args.report, "The report.json of a run")->required();
  compare->add_option("BASELINE", args.baseline, "What --update wrote, or another run's report.json")->required();
  compare->add_flag("--update", args.update, "Write the baseline from the report instead");
  CLI::App* plots = app.add_subcommand(
      "plots", "Every plot of a report as a picture of its own, DIR/SUITE-N.svg, its numbers beside it");
  plots->add_option("REPORT", args.report, "The report.json of a run")->required();
  plots->add_option("--out", args.out, "Folder for the pictures; made where it is missing")
      ->type_name("DIR")
      ->required();
  app.require_subcommand(0, 1);
  return {compare, plots};
}

// The suites that were named, each once, in the suites' own order.
Result<std::vector<const Suite*>> chosenSuites(const std::vector<std::string>& names) {
  std::vector<std::string> known{kAll};
  for (const Suite& suite : suites()) known.emplace_back(suite.name);
  for (const std::string& name : names) {
    if (std::ranges::find(known, name) != known.end()) continue;
    const std::string nearest = nearestWord(name, known);
    return fail(ErrorKind::usage,
                fmt::format("'{}' is no suite; {}", name,
                            nearest.empty() ? "see eyepoint-bench --help" : fmt::format("did you mean {}?", nearest)));
  }
  std::vector<const Suite*> chosen;
  for (const Suite& suite : suites()) {
    if (std::ranges::find(names, suite.name) != names.end() || std::ranges::find(names, kAll) != names.end())
      chosen.push_back(&suite);
  }
  return chosen;
}

Result<void> measure(const Arguments& args) {
  const Result<std::vector<const Suite*>> chosen = chosenSuites(args.names);
  if (!chosen) return tl::unexpected(chosen.error());
  Report report{.machine = machineLine(),
                .device = {},
                .commit = sourceCommit(),
                .settings = fmt::format("{}{}", args.options.terrain.empty() ? "embedded demo" : args.options.terrain,
                                        args.options.quick ? ", quick" : ""),
                .suites = {}};
  // The folder first: an hour's figures want a place.
  if (const Result<void> written = writeReport(report, args.out); !written) return written;
  Result<SpeedReference> reference = SpeedReference::create(args.options.device);
  if (!reference) return tl::unexpected(reference.error());
  for (const Suite* suite : *chosen) {
    ProgressLine line;
    SuiteOptions options = args.options;
    options.progress = [&](const std::string& what, double share) {
      if (line.isDue())
        line.print(fmt::format("{} {} {:.0f} %: {}", progressBar(share), suite->name, 100 * share, what));
    };
    const std::string before = loadLine();
    const Result<MachineSpeed> speedBefore = reference->measure();
    if (!speedBefore) return tl::unexpected(speedBefore.error());
    const double cpuBeganMs = processCpuMs();
    const int64_t beganNs = monotonicNs();
    Result<SuiteReport> done = suite->run(options);
    if (!done) return tl::unexpected(done.error());
    done->wallS = 1e-9 * static_cast<double>(monotonicNs() - beganNs);
    done->cpuS = 1e-3 * (processCpuMs() - cpuBeganMs);
    const Result<MachineSpeed> speedAfter = reference->measure();
    if (!speedAfter) return tl::unexpected(speedAfter.error());
    done->speed = meanOf(*speedBefore, *speedAfter);
    done->notes.push_back(fmt::format("It took {:.0f} s, {:.0f} s of CPU time.", done->wallS, done->cpuS));
    done->notes.push_back(fmt::format("Load average of the machine: {} before, {} after.", before, loadLine()));
    report.device = done->device;
    report.suites.push_back(std::move(*done));
    if (const Result<void> written = writeReport(report, args.out); !written) return written;
  }
  for (const SuiteReport& suite : report.suites) {
    fmt::print("{}\n", suite.title);
    for (const ReportTarget& target : suite.targets)
      fmt::print("  {} {}: {}\n", target.isReached ? "reached" : "missed ", target.what, target.measured);
    for (const ReportTable& table : suite.tables)
      if (table.isPrinted) fmt::print("\n{}", tableText(table));
  }
  fmt::print("{0}/report.html\n{0}/report.json\n", args.out);
  return {};
}

Result<void> run(const Arguments& args, const Subcommands& subcommands) {
  if (subcommands.compare->parsed()) return compareFiles(args.report, args.baseline, args.update);
  if (args.out.empty()) return fail(ErrorKind::usage, "--out DIR is missing (see --help)");
  if (subcommands.plots->parsed()) return writePlots(args.report, args.out);
  if (args.names.empty()) return fail(ErrorKind::usage, "name a suite, or all of them with 'all' (see --help)");
  return measure(args);
}

}  // namespace

int main(int argc, char** argv) {
  setUpProcess();
  CLI::App app("Measures the image generator over a terrain database, next to published figures.", "eyepoint-bench");
  Arguments args;
  declareOptions(app, args);
  const Subcommands subcommands = declareSubcommands(app, args);
  if (const std::optional<int> status = parseArguments(app, argc, argv)) return *status;
  logToStderr("eyepoint-bench", args.logLevel);
  if (const Result<void> done = run(args, subcommands); !done) return complain("eyepoint-bench", done.error());
  return 0;
}

// What the user asked for: the command line over the configuration file over the defaults.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "app/debug_view.h"
#include "base/error.h"
#include "base/user_folders.h"
#include "control/selector_rules.h"
#include "geo/sun.h"
#include "paging/lod_select.h"
#include "render/picture_quality.h"

namespace eye {

enum class CullingMode { none, frustum, dynamic };
enum class HostDelayMode { automatic, off, fixed };
enum class PredictorMode { none, kalman };
enum class DepthMapMode { automatic, off, fixed };

struct Options {
  // Terrain and where the state comes from.
  std::string terrain;  // empty: the embedded demo
  std::vector<std::string> hosts;
  std::string pose;

  // The channel's view.
  int widthPx = 800, heightPx = 600;
  double fovDeg = 60;
  std::optional<std::array<double, 4>> frustumDeg;     // left, right, bottom, top
  std::optional<std::array<bool, 2>> mirrors;          // left for right, up for down; unset: as the host wants it
  std::optional<std::array<double, 3>> viewOffsetDeg;  // heading, pitch, roll of the view against the aircraft
  double nearM = 1;

  // The window.
  bool headless = false, fullscreen = false, vsync = true;
  int monitor = 0;

  // The run.
  std::optional<uint64_t> frames;
  std::optional<double> durationS;
  std::optional<double> rateHz;  // unset: the default of the source; infinity: "max"
  bool rateOfHost = false;       // a frame for each message of the host
  bool redrawAlways = false, offline = false;

  // Quality and budgets.
  double ssePx = 1;
  TextureFilter sampler = TextureFilter::device;
  int samples = 1;  // a pixel: 1 or 4
  CullingMode culling = CullingMode::dynamic;
  DepthMapMode depthMap = DepthMapMode::automatic;  // read with dynamic culling alone
  glm::ivec2 depthMapPx{0, 0};                      // with DepthMapMode::fixed
  std::string selectorRules;                        // empty: the built-in ones
  std::optional<SelectorMode> selectorMode;         // instead of the rules' own
  HorizonTest horizon = HorizonTest::ellipsoid;
  uint64_t cacheRamMiB = 96, cacheGpuMiB = 160;
  PredictorMode predictor = PredictorMode::kalman;
  int predictorStates = 9;                                // 6, 9 or 12
  std::optional<double> processNoise, measurementSigmaM;  // of the predictor; unset: estimated from the flight
  double regionWidening = 1;  // of the distances within which terrain is loaded ahead; benchmarks compare others

  HostDelayMode hostDelay = HostDelayMode::automatic;
  double hostDelayMs = 0;  // with HostDelayMode::fixed

  // Light and air. Local solar time at the eye, or UTC, in hours of the date; none of the three set: the host's clock,
  // else 9 local. Unset visibility: the host's, else 60 km.
  std::optional<double> timeOfDayH, utcH;
  std::optional<CalendarDate> date;  // unset: kDefaultDate
  std::optional<double> visibilityM;
  std::optional<double> cloudBaseM;  // of one layer instead of the host's
  double cloudCover = 1;             // its share of the sky

  // Outputs.
  std::string screenshot, distanceMap, record, stats, summary, trace;
  std::string framesFolder;             // every frame as a PNG
  std::optional<glm::vec3> background;  // instead of sky and haze

  // Device and diagnosis.
  bool listDevices = false, validate = false, overlay = false;
  DebugView debugView;
  std::string device, logLevel = "info";
  int bands = 0;  // of the picture, drawn side by side by devices that are a CPU; 0: one a core, 4 at most

  std::string settingsLine() const;  // for the summary: what was in force, one line
};

// What main should do: run with `options`, or print `text` and leave with `status` (help, version, an error).
struct ParsedOptions {
  Options options;
  std::optional<int> exitStatus;
  std::string text;
};
ParsedOptions parseOptions(int argc, const char* const* argv);

}  // namespace eye

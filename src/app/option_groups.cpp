#include "app/option_groups.h"

#include <fmt/format.h>

#include "app/option_values.h"
#include "render/bands.h"

namespace eye {
namespace {

void addTerrainAndHost(CLI::App& app, Options& o) {
  const char* group = "Terrain and aircraft state";
  app.add_option("--terrain", o.terrain, "Terrain database made by eyepoint-bake; default: the embedded demo")
      ->type_name("FILE")
      ->group(group);
  app.add_option(
         "--host", o.hosts,
         "Where aircraft state comes from (may be given again):\n"
         "native-fdm://, cigi://, dis:// or xplane://ADDR:PORT, file://TRACK, demo://, pose://lat,lon,alt,h,p,r")
      ->type_name("URL")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group(group);
  app.add_option_function<std::string>(
         "--host-delay", [&o](const std::string& t) { setHostDelay(o, t); },
         "A live host's aircraft is drawn where it was, or will have been, this long before each\n"
         "frame: auto (default) by how unevenly packets come; off: where the newest packet has it")
      ->type_name("auto/off/MS")
      ->group(group);
  app.add_option("--pose", o.pose, "Holds still: lat,lon,alt,heading,pitch,roll (degrees, metres)")
      ->type_name("P")
      ->group(group);
}

void addView(CLI::App& app, Options& o) {
  const char* group = "View";
  app.add_option_function<std::string>(
         "--size", [&o](const std::string& t) { setSize(o, t); }, "Pixels; default 800x600")
      ->type_name("WxH")
      ->group(group);
  app.add_option("--fov", o.fovDeg, "Full horizontal angle, degrees; default 60")
      ->type_name("DEG")
      ->check(within(0.1, 170.0))
      ->group(group);
  app.add_option_function<std::string>(
         "--frustum", [&o](const std::string& t) { setFrustum(o, t); },
         "Off-axis view: left,right,bottom,top half-angles, signed degrees")
      ->type_name("L,R,B,T")
      ->group(group);
  app.add_option_function<std::string>(
         "--view-offset", [&o](const std::string& t) { setViewOffset(o, t); },
         "Where this channel looks from the aircraft's nose: heading,pitch,roll, degrees")
      ->type_name("H,P,R")
      ->group(group);
  app.add_option_function<std::string>(
         "--mirror", [&o](const std::string& t) { setMirror(o, t); },
         "The picture as in a mirror: across (h), upside down (v), both (hv); default: as the host wants it")
      ->type_name("none/h/v/hv")
      ->check(CLI::IsMember({"none", "h", "v", "hv"}))
      ->group(group);
  app.add_option("--near", o.nearM, "Near plane, metres; default 1")
      ->type_name("M")
      ->check(within(0.01, 1000.0))
      ->group(group);
  app.add_flag("--headless", o.headless, "No window; works without a display")->group(group);
  app.add_flag("--fullscreen", o.fullscreen, "The whole monitor (F11 switches)")->group(group);
  app.add_option("--monitor", o.monitor, "Which monitor, from 0")
      ->type_name("N")
      ->check(wholeWithin(0, 63))
      ->group(group);
  app.add_option_function<std::string>(
         "--vsync", [&o](const std::string& t) { o.vsync = onOff("--vsync", t); }, "on (default) or off")
      ->type_name("on/off")
      ->group(group);
  app.add_flag("--overlay", o.overlay, "Statistics over the picture from the start (F1 switches)")->group(group);
}

void addRun(CLI::App& app, Options& o) {
  const char* group = "Run";
  app.add_option("--frames", o.frames, "Stop after N frames")
      ->type_name("N")
      ->check(wholeWithin(1, 1'000'000'000'000'000))
      ->group(group);
  app.add_option("--duration", o.durationS, "Stop after S seconds")
      ->type_name("S")
      ->check(within(0.001, 1e9))
      ->group(group);
  app.add_option_function<std::string>(
         "--rate", [&o](const std::string& t) { setRate(o, t); },
         "Pace of frames: hertz, max, or host: one for each message of a live host; default 60,\n"
         "max with a fixed pose or --offline")
      ->type_name("HZ/max/host")
      ->group(group);
  app.add_option_function<std::string>(
         "--redraw", [&o](const std::string& t) { o.redrawAlways = t == "always"; },
         "changed (default): a frame like the last one is not drawn again; always")
      ->type_name("changed/always")
      ->check(CLI::IsMember({"changed", "always"}))
      ->group(group);
  app.add_flag("--offline", o.offline, "Deterministic: fixed 60 Hz clock, every frame waits for its terrain")
      ->group(group);
}

void addQuality(CLI::App& app, Options& o) {
  const char* group = "Quality and budgets";
  app.add_option("--sse", o.ssePx, "Tolerated screen-space error, pixels; default 1")
      ->type_name("PX")
      ->check(within(0.05, 64.0))
      ->group(group);
  app.add_option_function<std::string>(
         "--sampler", [&o](const std::string& t) { o.sampler = filterOf(t); },
         "How imagery is read: nearest, bilinear within the nearest level of detail, trilinear,\n"
         "anisotropic; auto (default): bilinear on a CPU, anisotropic on a GPU that can, else trilinear")
      ->type_name("auto/nearest/bilinear/trilinear/anisotropic")
      ->check(CLI::IsMember({"auto", "nearest", "bilinear", "trilinear", "anisotropic"}))
      ->group(group);
  app.add_option("--samples", o.samples, "Samples a pixel: 1 (default), or 4: smooth edges at about twice the time")
      ->type_name("1/4")
      ->check(wholeWithin(1, 4))
      ->check(CLI::IsMember({1, 4}))
      ->group(group);
  app.add_option_function<std::string>(
         "--culling", [&o](const std::string& t) { o.culling = cullingOf(t); },
         "none, frustum (view frustum and horizon), or dynamic (default): hidden and\n"
         "back-facing clusters too, where that pays; the picture is the same")
      ->type_name("none/frustum/dynamic")
      ->check(CLI::IsMember({"none", "frustum", "dynamic"}))
      ->group(group);
  app.add_option_function<std::string>(
         "--depth-map", [&o](const std::string& t) { setDepthMap(o, t); },
         "Size of dynamic culling's depth map: auto (default) chooses each frame, off, or WxH")
      ->type_name("auto/off/WxH")
      ->group(group);
  app.add_option_function<std::string>(
         "--selector",
         [&o](const std::string& t) { o.selectorMode = t == "paper" ? SelectorMode::paper : SelectorMode::adaptive; },
         "How auto chooses: adaptive (default) by what pays, paper by altitude and pitch")
      ->type_name("adaptive/paper")
      ->check(CLI::IsMember({"adaptive", "paper"}))
      ->group(group);
  app.add_option("--selector-rules", o.selectorRules, "Rules for auto, such as config/selector.toml; default built in")
      ->type_name("FILE.toml")
      ->group(group);
  app.add_option_function<std::string>(
         "--horizon",
         [&o](const std::string& t) { o.horizon = t == "paper" ? HorizonTest::paper : HorizonTest::ellipsoid; },
         "What hides chunks below the horizon: ellipsoid (default), or paper: a sphere, for comparison")
      ->type_name("ellipsoid/paper")
      ->check(CLI::IsMember({"ellipsoid", "paper"}))
      ->group(group);
  app.add_option_function<std::string>(
         "--predictor",
         [&o](const std::string& t) { o.predictor = t == "none" ? PredictorMode::none : PredictorMode::kalman; },
         "Terrain is loaded ahead along the predicted flight: kalman (default), or around the eye alone: none")
      ->type_name("kalman/none")
      ->check(CLI::IsMember({"kalman", "none"}))
      ->group(group);
  app.add_option("--predictor-states", o.predictorStates,
                 "The predictor's model: 6 (constant velocity), 9 (constant acceleration, default), 12 (constant jerk)")
      ->type_name("6/9/12")
      ->check(wholeWithin(6, 12))
      ->check(CLI::IsMember({6, 9, 12}))
      ->group(group);
  app.add_option("--process-noise", o.processNoise,
                 "What the predictor's model leaves out, m2/s5 with 9 states; default: estimated from the flight")
      ->type_name("Q")
      ->check(within(1e-9, 1e9))
      ->group(group);
  app.add_option("--measurement-sigma", o.measurementSigmaM,
                 "Noise of the host's positions, metres; default: estimated from the flight")
      ->type_name("M")
      ->check(within(1e-6, 1e4))
      ->group(group);
  app.add_option("--cache-ram", o.cacheRamMiB, "Budget for decoded terrain in memory; default 96")
      ->type_name("MIB")
      ->check(wholeWithin(8, 1 << 20))
      ->group(group);
  app.add_option("--cache-gpu", o.cacheGpuMiB, "Budget for terrain on the GPU; default 160")
      ->type_name("MIB")
      ->check(wholeWithin(16, 1 << 20))
      ->group(group);
  app.add_option("--time-of-day", o.timeOfDayH, "Local solar time at the eye, hours; default the host's, else 9")
      ->type_name("H")
      ->check(within(0.0, 24.0))
      ->group(group);
  app.add_option("--utc", o.utcH, "Universal time instead, hours: one sun for the whole globe")
      ->type_name("H")
      ->check(within(0.0, 24.0))
      ->group(group);
  app.add_option_function<std::string>(
         "--date", [&o](const std::string& t) { setDate(o, t); },
         "The sun's date, 1900 to 2100; default the host's, else 2026-03-20, an equinox")
      ->type_name("YYYY-MM-DD")
      ->group(group);
  app.add_option("--visibility", o.visibilityM, "Meteorological visibility, metres; default the host's, else 60000")
      ->type_name("M")
      ->check(within(10.0, 1.0e6))
      ->group(group);
  app.add_option("--cloud-base", o.cloudBaseM, "A layer of cloud, 300 m thick, from this height; default the host's")
      ->type_name("M")
      ->check(within(-1000.0, 20000.0))
      ->group(group);
  app.add_option("--cloud-cover", o.cloudCover, "Its share of the sky, 0 to 1; default 1, an overcast")
      ->type_name("SHARE")
      ->check(within(0.0, 1.0))
      ->group(group);
}

void addOutputs(CLI::App& app, Options& o) {
  const char* group = "Outputs";
  app.add_option("--screenshot", o.screenshot, "The last frame as a picture")->type_name("FILE.png")->group(group);
  app.add_option("--distance-map", o.distanceMap, "The last frame's slant range in metres, NaN for sky")
      ->type_name("FILE.tif")
      ->group(group);
  app.add_option("--record", o.record, "All frames as a film (needs ffmpeg)")->type_name("FILE.mp4")->group(group);
  app.add_option("--frames-dir", o.framesFolder, "All frames as pictures")->type_name("DIR")->group(group);
  app.add_option("--stats", o.stats, "One JSON object a frame")->type_name("FILE.jsonl")->group(group);
  app.add_option("--summary", o.summary, "One JSON object for the run")->type_name("FILE.json")->group(group);
  app.add_option("--trace", o.trace, "Chrome/Perfetto trace of threads and GPU passes")
      ->type_name("FILE.json")
      ->group(group);
}

void addDiagnosis(CLI::App& app, Options& o) {
  const char* group = "Device and diagnosis";
  app.add_flag("--list-devices", o.listDevices, "The Vulkan devices, and which can be used")->group(group);
  app.add_option("--device", o.device, "Use the device whose name contains NAME")->type_name("NAME")->group(group);
  app.add_option("--bands", o.bands,
                 "Where the device is a CPU the picture is drawn in N bands side by side, 1 to 4;\n"
                 "default: one a core")
      ->type_name("N")
      ->check(wholeWithin(1, kMostBands))
      ->group(group);
  app.add_flag("--validate", o.validate, "Vulkan validation on; any message fails the run")->group(group);
  app.add_option("--log-level", o.logLevel, "debug, info (default), warn or error")
      ->check(CLI::IsMember({"debug", "info", "warn", "error"}))
      ->group(group);
  app.add_option_function<std::string>(
         "--debug-view", [&o](const std::string& t) { setDebugView(o, t); },
         "What culling does: freeze what is drawn (F2), depth-map (F3), colours by level\n"
         "or by fate (F4); several with commas")
      ->type_name("V,...")
      ->group(group);
  app.add_option_function<std::string>(
         "--background", [&o](const std::string& t) { setBackground(o, t); },
         "A flat colour instead of sky and haze: shows holes")
      ->type_name("R,G,B")
      ->group(group);
}

}  // namespace

void addOptions(CLI::App& app, Options& options) {
  addTerrainAndHost(app, options);
  addView(app, options);
  addRun(app, options);
  addQuality(app, options);
  addOutputs(app, options);
  addDiagnosis(app, options);
}

}  // namespace eye

// The selector's rules: everything that config/selector.toml may set. The defaults below are the file's.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "control/depth_map_choice.h"
#include "control/membership.h"

namespace eye {

enum class SelectorMode { paper, adaptive };
enum class AltitudeReference { ground, sea };

// Paper 001. The bands' lower edges choose the sizes, smallest first; below the first: off.
struct PaperRules {
  AltitudeReference altitudeReference = AltitudeReference::ground;
  Membership altitudeFt{{4000, 5000, 6000, 7000, 8000}, {1, 0.6, 0.3, 0.1, 0}};
  Membership pitchDeg{{-30, 30}, {1, 0}};
  std::array<double, kDepthMapSizes> bands{0.1, 0.5, 1.0, 1.5};
  double hysteresis = 0.02;  // how far below the held band the sum must fall to leave it
  bool operator==(const PaperRules&) const = default;
};

struct AdaptiveRules {
  // Expectation: memberships, their weighted sum, and the share of triangles hidden that a sum stands for.
  Membership heightOverRelief{{0.1, 0.3, 0.6, 1.2, 2.5}, {1, 0.6, 0.3, 0.1, 0}};
  Membership pitchDeg{{-30, 30}, {1, 0}};
  double altitudeWeight = 1.5, pitchWeight = 0.5;
  Membership shareOfSum{{0.25, 0.4, 0.7, 1.15, 1.75, 2}, {0, 0.07, 0.2, 0.42, 0.68, 0.8}};
  double measurementReach = 0.3;  // a change of the sum that makes a measured share worth nothing

  // Costs, until they are measured.
  double triangleCostNs = 120;
  double triangleCostMaxNs = 300;
  double triangleCostTrust = 5000;  // occluded triangles that one measurement must have to
                                    // weigh as much as triangleCostNs
  std::array<double, kDepthMapSizes> passCostMs{0.5, 0.55, 0.7, 0.9};  // smallest first
  std::array<double, kDepthMapSizes> shareOfLargest{0.97, 0.985, 0.995, 1};

  // When to change and when to try, in frames and in shares of a frame's cost.
  double hysteresis = 0.005;
  int dwellFrames = 30;
  int settleFrames = 3;  // from off to a size: not learnt from, what is visible is known only then; other changes one
  int trialFrames = 3;   // after these: learnt from
  int firstIntervalFrames = 60, longestIntervalFrames = 960;
  double lossRate = 0.01;  // of a frame's cost, what trials and errors may cost on average
  double lossReserve = 1;  // frames' cost, what they may cost at once
  bool operator==(const AdaptiveRules&) const = default;
};

struct SelectorRules {
  SelectorMode mode = SelectorMode::adaptive;
  PaperRules paper;
  AdaptiveRules adaptive;
  bool operator==(const SelectorRules&) const = default;
};

// From TOML. Keys that are not given keep their defaults; what is unknown, mistyped, out of range or out of order is an
// error of kind usage, in one line with file (`path`), line and what would be right.
Result<SelectorRules> parseSelectorRules(std::string_view text, const std::string& path);
Result<SelectorRules> loadSelectorRules(const std::string& path);

}  // namespace eye

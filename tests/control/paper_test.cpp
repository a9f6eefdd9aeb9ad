#include <catch2/catch.hpp>

#include <cmath>
#include <utility>

#include "control/fuzzy_selector.h"

using namespace eye;

namespace {

constexpr double kMPerFt = 0.3048;

SelectorRules paperMode() {
  SelectorRules rules;
  rules.mode = SelectorMode::paper;
  return rules;
}

SelectorInput at(double altitudeFt, double pitchDeg) {
  SelectorInput input;
  input.heightAboveGroundM = altitudeFt * kMPerFt;
  input.pitchDeg = pitchDeg;
  return input;
}

Decision decideOnce(double altitudeFt, double pitchDeg) {
  return FuzzySelector(paperMode()).decide(at(altitudeFt, pitchDeg));
}

double thousandths(double value) {
  return std::round(value * 1000) / 1000;
}

}  // namespace

TEST_CASE("Table 1: altitude memberships, to the digit") {
  const std::vector<std::pair<double, double>> printed{{4000, 1.0},   {4010, 0.996}, {5000, 0.6}, {5010, 0.597},
                                                       {6000, 0.3},   {6010, 0.298}, {7000, 0.1}, {7010, 0.099},
                                                       {7990, 0.001}, {8000, 0.0}};
  for (const auto& [altitudeFt, membership] : printed) {
    INFO(altitudeFt << " ft");
    CHECK(thousandths(decideOnce(altitudeFt, 0).altitudeMembership) == Approx(membership).margin(1e-12));
  }
  CHECK(decideOnce(0, 0).altitudeMembership == 1);
  CHECK(decideOnce(-1400, 0).altitudeMembership == 1);
  CHECK(decideOnce(60000, 0).altitudeMembership == 0);
}

// Eq. (1), read with h_phase where it prints h_i the second time; x_offset / h_offset = 0.001 / (10 ft * 1,000 ft).
TEST_CASE("Table 1 is eq. (1)") {
  const std::array<double, 4> phaseFt{4000, 5000, 6000, 7000}, phaseMembership{1, 0.6, 0.3, 0.1};
  for (int altitudeFt = 4000; altitudeFt < 8000; ++altitudeFt) {
    const auto phase = static_cast<size_t>(altitudeFt / 1000 - 4);
    const double expected =
        phaseMembership[phase] - (altitudeFt - phaseFt[phase]) * (8000 - phaseFt[phase]) * 0.001 / (10 * 1000);
    REQUIRE(decideOnce(altitudeFt, 0).altitudeMembership == Approx(expected).margin(1e-9));
  }
}

// The paper prints 0.493 and 0.507 at 1 and -1 degrees: slips, for no curve has these and 0.017 at 29 degrees.
TEST_CASE("Table 1: pitch memberships, to the digit") {
  const std::vector<std::pair<double, double>> printed{{30, 0.0},   {29, 0.017},  {1, 0.483}, {0, 0.5},
                                                       {-1, 0.517}, {-29, 0.983}, {-30, 1.0}};
  for (const auto& [pitchDeg, membership] : printed) {
    INFO(pitchDeg << " degrees");
    CHECK(thousandths(decideOnce(9000, pitchDeg).pitchMembership) == Approx(membership).margin(1e-12));
  }
  CHECK(decideOnce(9000, 90).pitchMembership == 0);
  CHECK(decideOnce(9000, -90).pitchMembership == 1);
}

TEST_CASE("Table 2: the sum's half-open bands are the sizes") {
  const auto& bands = PaperRules{}.bands;
  using enum DepthMapChoice;
  const std::vector<std::pair<double, DepthMapChoice>> table{
      {2.0, size800x600}, {1.5, size800x600},    {1.4999, size640x480}, {1.0, size640x480}, {0.9999, size400x300},
      {0.5, size400x300}, {0.4999, size320x240}, {0.1, size320x240},    {0.0999, off},      {0.0, off}};
  for (const auto& [sum, choice] : table) {
    INFO("sum " << sum);
    CHECK(bandOf(bands, sum) == choice);
  }
  // Level flight, and climbs: the sum of both memberships decides.
  CHECK(decideOnce(4000, 0).choice == size800x600);
  CHECK(decideOnce(5000, 0).choice == size640x480);
  CHECK(decideOnce(6000, 0).choice == size400x300);
  CHECK(decideOnce(8000, 0).choice == size400x300);
  CHECK(decideOnce(8000, 1).choice == size320x240);
  CHECK(decideOnce(8000, 24.1).choice == off);
  CHECK(decideOnce(5000, -12).sum == Approx(1.3));
}

TEST_CASE("names and pixels of the sizes") {
  CHECK(nameOf(DepthMapChoice::off) == "off");
  CHECK(nameOf(DepthMapChoice::size400x300) == "400x300");
  for (const DepthMapChoice size : kDepthMaps)
    CHECK(std::to_string(sizeOf(size).widthPx) + "x" + std::to_string(sizeOf(size).heightPx) == nameOf(size));
}

TEST_CASE("a band is left downwards only below its edge by the hysteresis, and entered at the edge") {
  using enum DepthMapChoice;
  FuzzySelector selector(paperMode());
  const auto atSum = [&](double sum) { return selector.decide(at(9000, 30 - 60 * sum)).choice; };  // 0 to 1 by pitch
  CHECK(atSum(0.51) == size400x300);
  CHECK(atSum(0.49) == size400x300);
  CHECK(atSum(0.479) == size320x240);
  CHECK(atSum(0.49) == size320x240);
  CHECK(atSum(0.501) == size400x300);
  CHECK(atSum(0.081) == size320x240);
  CHECK(atSum(0.079) == off);
  // A sum that trembles by less than the hysteresis changes nothing.
  CHECK(atSum(0.505) == size400x300);
  for (int frame = 0; frame < 100; ++frame) CHECK(atSum(frame % 2 ? 0.505 : 0.49) == size400x300);
}

TEST_CASE("altitude above the sea where the rules say so") {
  SelectorRules rules = paperMode();
  rules.paper.altitudeReference = AltitudeReference::sea;
  SelectorInput input = at(0, 0);
  input.altitudeMslM = 8000 * kMPerFt;
  CHECK(FuzzySelector(rules).decide(input).altitudeMembership == Approx(0).margin(1e-9));
  CHECK(FuzzySelector(paperMode()).decide(input).altitudeMembership == 1);
}

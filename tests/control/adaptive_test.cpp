#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulated_flight.h"

using namespace eye;

namespace {

constexpr int kMinuteFrames = 3600;

// Five minutes: take-off over a plain, low over mountains, up to 8,000 ft, down into valleys, and home.
Place mountainFlight(int frame) {
  const double minute = frame / static_cast<double>(kMinuteFrames);
  const Membership height{{0, 0.5, 1, 1.5, 2, 2.6, 3, 3.3, 4.2, 4.6, 5},
                          {2, 300, 600, 150, 120, 2400, 2400, 200, 80, 400, 2}};
  const Membership relief{{0, 0.7, 1.2, 4.3, 4.8, 5}, {40, 80, 1400, 1700, 200, 40}};
  Place place;
  place.heightAboveGroundM = membershipAt(height, minute) + 20 + 20 * std::sin(frame * 0.02);
  place.reliefM = membershipAt(relief, minute) * (1 + 0.2 * std::sin(frame * 0.004));
  place.pitchDeg = 8 * std::sin(frame * 0.005);
  place.triangles = 40000 + 10000 * std::sin(frame * 0.003);
  // Other ground than the rules expect: valleys hide more and less than their height over relief says.
  place.hiddenShare = std::clamp(typicalHiddenShare(place.heightAboveGroundM, place.reliefM) *
                                     (0.8 + 0.35 * std::sin(frame * 0.0017) + 0.1 * std::sin(frame * 0.05)),
                                 0.0, 1.0);
  return place;
}

// The eye 30 m over ground that hides next to nothing.
Place plainFlight(int frame) {
  Place place;
  place.heightAboveGroundM = 30;
  place.reliefM = 25 + 15 * std::sin(frame * 0.01);
  place.triangles = 30000;
  place.hiddenShare = 0.02;
  return place;
}

// All inputs promise mountains, again and again anew, and nothing is ever hidden.
Place lyingFlight(int frame) {
  Place place;
  place.heightAboveGroundM = 800 + 780 * std::sin(frame * 0.02);
  place.reliefM = 1500;
  place.pitchDeg = 20 * std::sin(frame * 0.013);
  place.triangles = 30000;
  return place;
}

// Much is hidden for some seconds, nothing for the next; no input tells.
Place flickeringFlight(int frame) {
  Place place = lyingFlight(0);
  place.hiddenShare = frame / 420 % 2 ? 0.5 : 0.0;
  return place;
}

}  // namespace

TEST_CASE("over mountains and plains the adaptive selector is within 3 % of the best choice of every frame") {
  for (const Machine& machine : {pyramidMachine(), reuseMachine(), cardMachine()}) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
      const FlightResult result = fly(mountainFlight, machine, 5 * kMinuteFrames, {}, seed);
      INFO("pass at 800x600 costs " << machine.passMs[3] << " ms, seed " << seed);
      CHECK(result.regret < 0.006);
      CHECK(result.overOff < -0.005);
      CHECK(result.worstOver < 0.02);
      CHECK(result.switches < 5 * 20);  // held choices a minute
      CHECK(result.changes < 5 * 60);   // a trial is two
    }
  }
}

TEST_CASE("it gains where the paper's rules lose") {
  SelectorRules paper;
  paper.mode = SelectorMode::paper;
  const FlightResult byPaper = fly(mountainFlight, pyramidMachine(), 5 * kMinuteFrames, paper);
  const FlightResult adaptive = fly(mountainFlight, pyramidMachine(), 5 * kMinuteFrames);
  CHECK(byPaper.regret > 0.04);
  CHECK(byPaper.worstOver > 0.05);
  CHECK(adaptive.regret < byPaper.regret / 10);
}

TEST_CASE("where occlusion never pays it is never 2 % slower than off in any 600 frames") {
  for (const Flight& flight : {Flight(plainFlight), Flight(lyingFlight), Flight(flickeringFlight)}) {
    for (Machine machine : {pyramidMachine(), reuseMachine(), cardMachine()}) {
      for (const double noise : {0.02, 0.08}) {
        machine.noise = noise;
        const FlightResult result = fly(flight, machine, 3 * kMinuteFrames);
        INFO("pass at 800x600 costs " << machine.passMs[3] << " ms, hidden " << flight(420).hiddenShare);
        CHECK(result.worstOver < 0.02);
        CHECK(result.changes < 3 * 180);
      }
    }
  }
  CHECK(fly(plainFlight, pyramidMachine(), 5 * kMinuteFrames).switches == 0);
}

TEST_CASE("a pass that costs more than the frame is found out within the budget") {
  Machine machine = cardMachine();
  machine.passMs = {1, 2, 3, 4};
  const FlightResult result = fly(lyingFlight, machine, 3 * kMinuteFrames);
  CHECK(result.worstOver < 0.035);  // the first trial alone takes more than the budget, and is repaid
  CHECK(result.overOff < 0.0115);
}

TEST_CASE("measurements may come some frames late") {
  Machine machine = pyramidMachine();
  machine.lateFrames = 3;
  const FlightResult result = fly(mountainFlight, machine, 5 * kMinuteFrames);
  CHECK(result.regret < 0.03);
  CHECK(result.worstOver < 0.02);
}

TEST_CASE("what trials over a plain have found is not held against mountains") {
  const int mountainsFrame = 3 * kMinuteFrames;
  const auto flight = [](int frame) {
    Place place;
    const bool isPlain = frame < mountainsFrame;
    place.reliefM = isPlain ? 600 : 1500;
    place.heightAboveGroundM = isPlain ? 700 : 100;
    place.triangles = 60000;
    place.hiddenShare = isPlain ? 0.3 : 0.7;
    if (isPlain) place.occludedNs = 0;  // they lie between pixels' centres
    return place;
  };
  for (unsigned seed = 1; seed <= 4; ++seed) {
    INFO("seed " << seed);
    const FlightResult result = fly(flight, pyramidMachine(), mountainsFrame + 600, {}, seed);
    const auto first = result.choices.begin() + mountainsFrame;
    CHECK(std::count(first - 1000, first, DepthMapChoice::off) >= 980);
    CHECK(std::count(first + 80, result.choices.end(), DepthMapChoice::off) < 520 * 3 / 100);
  }
}

TEST_CASE("set down in mountains by its host it does not compare them with the plain that it comes from") {
  const int mountainsFrame = kMinuteFrames;
  const auto flight = [](int frame) {
    Place place;
    const bool isPlain = frame < mountainsFrame;
    place.reliefM = isPlain ? 100 : 1500;
    place.heightAboveGroundM = isPlain ? 2400 : 30;
    place.triangles = isPlain ? 20000 : 150000;
    place.hiddenShare = isPlain ? 0 : 0.8;
    return place;
  };
  for (unsigned seed = 1; seed <= 4; ++seed) {
    INFO("seed " << seed);
    const FlightResult result = fly(flight, pyramidMachine(), mountainsFrame + 600, {}, seed);
    const auto first = result.choices.begin() + mountainsFrame;
    CHECK(std::count(first + 80, result.choices.end(), DepthMapChoice::off) < 520 * 3 / 100);
  }
}

TEST_CASE("descending into mountains it tries at once, not when its interval has passed") {
  const int descentFrame = 2 * kMinuteFrames;
  const auto descent = [](int frame) {
    Place place;
    place.reliefM = 1500;
    place.heightAboveGroundM = frame < descentFrame ? 6000 : 100;
    place.triangles = 40000;
    place.hiddenShare = typicalHiddenShare(place.heightAboveGroundM, place.reliefM);
    return place;
  };
  const FlightResult result = fly(descent, pyramidMachine(), descentFrame + 600);
  const auto first = result.choices.begin() + descentFrame;
  CHECK(std::count(first - 600, first, DepthMapChoice::off) >= 590);
  const auto on = std::find_if(first, result.choices.end(), [](DepthMapChoice c) { return c != DepthMapChoice::off; });
  CHECK(on - first <= 60);
  // From then on it is off in trials alone.
  const AdaptiveRules rules;
  int inRow = 0;
  for (auto choice = on; choice != result.choices.end(); ++choice) {
    inRow = *choice == DepthMapChoice::off ? inRow + 1 : 0;
    CHECK(inRow <= 1 + rules.trialFrames);
  }
  CHECK(std::count(on, result.choices.end(), DepthMapChoice::off) < 600 * 3 / 100);
}

TEST_CASE("the same flight gives the same choices") {
  CHECK(fly(mountainFlight, pyramidMachine(), kMinuteFrames).choices ==
        fly(mountainFlight, pyramidMachine(), kMinuteFrames).choices);
}

TEST_CASE("numbers that are none give off, and nothing is learnt from them") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (const SelectorMode mode : {SelectorMode::paper, SelectorMode::adaptive}) {
    SelectorRules rules;
    rules.mode = mode;
    FuzzySelector selector(rules);
    SelectorInput good;
    good.heightAboveGroundM = 100;
    good.reliefM = 1500;
    good.submittedTriangles = 40000;
    uint64_t hidden = 25000;
    const auto drawOne = [&](const SelectorInput& at) {
      const Decision decision = selector.decide(at);
      good.used = decision.choice;
      const bool on = good.used != DepthMapChoice::off;
      good.occludedTriangles = on ? hidden : 0;
      good.passCostMs = on ? 0.3 : 0;
      good.frameCostMs = 7 - (on ? static_cast<double>(hidden) * 120e-6 - 0.3 : 0);
      return decision;
    };
    for (int frame = 0; frame < 600; ++frame) drawOne(good);
    for (double SelectorInput::*member :
         {&SelectorInput::heightAboveGroundM, &SelectorInput::pitchDeg, &SelectorInput::reliefM,
          &SelectorInput::passCostMs, &SelectorInput::frameCostMs}) {
      const bool poseItself = member == &SelectorInput::heightAboveGroundM || member == &SelectorInput::pitchDeg;
      for (const double value : {nan, infinite, -infinite, 1e308, -1e308}) {
        SelectorInput bad = good;
        bad.*member = value;
        const Decision decision = drawOne(bad);
        CHECK(std::isfinite(decision.sum));
        CHECK(std::isfinite(decision.expectedGainMs));
        if (poseItself && !std::isfinite(value)) CHECK(decision.choice == DepthMapChoice::off);
        for (int frame = 0; frame < 12; ++frame) drawOne(good);
      }
    }
    int on = 0;
    for (int frame = 0; frame < 600; ++frame) on += drawOne(good).choice != DepthMapChoice::off;
    CHECK(on > 580);
    if (mode == SelectorMode::paper) continue;
    hidden = 0;  // and it still sees when the pass does not pay any more
    SelectorInput impossible = good;
    impossible.occludedTriangles = std::numeric_limits<uint64_t>::max();
    drawOne(impossible);
    on = 0;
    for (int frame = 0; frame < 600; ++frame) on += drawOne(good).choice != DepthMapChoice::off;
    CHECK(on < 100);
  }
}

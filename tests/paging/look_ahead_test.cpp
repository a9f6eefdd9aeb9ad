// The pager with a look-ahead: flights over the made-up globe, in frames as fast as the test runs.
#include <catch2/catch.hpp>
#include <chrono>
#include <random>
#include <thread>

#include "paging/fake_store.h"
#include "paging/pager.h"
#include "paging/synthetic_forest.h"

namespace eye {
namespace {

constexpr double kLatDeg = 50, kLonDeg = 20, kSsePx = 2;
constexpr uint64_t kPlenty = uint64_t{1} << 30;

const ForestFile& sharedForest() {
  static const ForestFile forest(around(kLatDeg, kLonDeg, 4, 9));
  return forest;
}

// The test knows where it will be: a perfect predictor.
using Path = std::function<View(double timeS)>;

View viewAt(double latDeg, double lonDeg, double altM, double headingDeg, double pitchDeg = -10) {
  return makeView({{latDeg, lonDeg, altM}, headingDeg, pitchDeg, 0}, symmetricFrustum(60, 800, 600, 1), 800, 600);
}

LookAhead lookAhead(const Path& path, double nowS, double speedMS, bool jumped) {
  LookAhead look;
  look.nowS = nowS;
  look.speedMS = speedMS;
  look.jumped = jumped;
  const View view = path(nowS);
  look.region.pixelsPerRadian = pixelsPerRadian(view);
  look.region.ssePx = kSsePx;
  look.region.halfFovRad = std::atan(std::hypot(view.frustum.tanRight, view.frustum.tanTop));
  look.at = [path, nowS](double inS) {
    const View at = path(nowS + inS);
    return ViewpointAhead{.inS = inS,
                          .ecefM = at.eyeEcefM,
                          .heightM = geodeticFromEcef(at.eyeEcefM).altM,
                          .radius98M = 0,
                          .forwardEcef = glm::transpose(at.eyeFromEcef) * Vec3d(0, 0, 1),
                          .turnRateRadS = 0};
  };
  return look;
}

struct Flown {
  int missingFrames = 0;
  uint32_t mostMissing = 0;
};

// One frame every `stepS` of flight; `restMs` of real time for the paging thread in each.
Flown fly(Pager& pager, const Path& path, double fromS, double toS, double speedMS, double restMs,
          const std::function<void(const Selection&)>& eachFrame = {}, bool looks = true, double stepS = 1 / 60.0) {
  Flown flown;
  Selection selection;
  for (double timeS = fromS; timeS < toS; timeS += stepS) {
    pager.cache().beginFrame();
    selectChunks(pager.cache(), path(timeS), {.ssePx = kSsePx, .coarsening = pager.coarsening()}, selection);
    if (looks) {
      LookAhead look = lookAhead(path, timeS, speedMS, false);
      look.frameRateHz = 1 / stepS;
      pager.exchange(selection, &look);
    } else {
      pager.exchange(selection);
    }
    flown.missingFrames += selection.counts.missing > 0;
    flown.mostMissing = std::max(flown.mostMissing, selection.counts.missing);
    if (eachFrame) eachFrame(selection);
    if (restMs > 0) std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(restMs));
  }
  return flown;
}

std::unique_ptr<Pager> open(FakeStore& gpu, const PagerOptions& options) {
  Result<std::unique_ptr<Pager>> pager = Pager::create(sharedForest().path(), gpu, options);
  REQUIRE(pager.has_value());
  return std::move(*pager);
}

// North over the forest's middle, fast.
constexpr double kFastMS = 3000;
View alongMeridian(double timeS) {
  return viewAt(kLatDeg - 1.5 + kFastMS * timeS / 111200, kLonDeg, 3000, 0);
}

// Round the forest's middle.
constexpr double kRoundS = 40, kRadiusDeg = 0.4;
View aroundMiddle(double timeS) {
  const double angle = timeS * 2 * 3.14159265358979 / kRoundS;
  return viewAt(kLatDeg + kRadiusDeg * std::cos(angle), kLonDeg + kRadiusDeg * std::sin(angle) / 0.64, 4000,
                angle * 180 / 3.14159265358979 + 90);
}
constexpr double kRoundMS = kRadiusDeg * 111200 * 2 * 3.14159265358979 / kRoundS;

}  // namespace

TEST_CASE("what is ahead is there when the eye is: hardly a frame misses a chunk, where it would without") {
  int missing[2] = {};
  for (bool looks : {false, true}) {
    FakeStore gpu(kPlenty);
    const auto pager = open(gpu, {});
    fly(
        *pager, [](double) { return alongMeridian(0); }, 0, 2, 0, 2, {}, looks);  // a start from rest, settled
    missing[looks] = fly(
                         *pager, [](double t) { return alongMeridian(t - 2); }, 2, 12, kFastMS, 5, {}, looks)
                         .missingFrames;
  }
  INFO(missing[0] << " and " << missing[1] << " frames");
  CHECK(missing[0] >= 5);
  CHECK(missing[1] * 4 < missing[0]);
}

TEST_CASE("round and round at a budget just large enough, nothing is loaded twice; with less it is coarser") {
  FakeStore roomy(kPlenty);
  uint64_t needed = 0;
  {
    const auto pager = open(roomy, {});
    fly(*pager, aroundMiddle, 0, 2 * kRoundS, kRoundMS, 0.2);
    needed = roomy.bytesResident();
  }
  SECTION("just large enough") {
    FakeStore gpu(needed);
    const auto pager = open(gpu, {.ramBudgetBytes = 2'000'000});
    double fromS = 0;
    PagingCounts settled;
    do {  // as many rounds as a busy machine's paging thread needs
      settled = pager->counts();
      fly(*pager, aroundMiddle, fromS, fromS + kRoundS, kRoundMS, 0.2);
      fromS += kRoundS;
    } while (pager->counts().loaded != settled.loaded && fromS < 20 * kRoundS);
    settled = pager->counts();
    const Flown flown = fly(*pager, aroundMiddle, fromS, fromS + 2 * kRoundS, kRoundMS, 0.2);
    CHECK(flown.missingFrames == 0);
    CHECK(pager->counts().loaded == settled.loaded);
    CHECK(pager->counts().evicted == settled.evicted);
    CHECK(pager->counts().bytesRead == settled.bytesRead);
    CHECK(pager->coarsening() == 1);
  }
  SECTION("far too small: coarser, and detail returns within a second where it fits, however fast frames come") {
    const double stepS = GENERATE(1 / 60.0, 1 / 15.0);
    FakeStore gpu(needed / 2);
    const auto pager = open(gpu, {.ramBudgetBytes = 2'000'000});
    double coarsest = 1;
    fly(
        *pager, aroundMiddle, 0, kRoundS, kRoundMS, 0.2,
        [&](const Selection&) { coarsest = std::max(coarsest, pager->coarsening()); }, true, stepS);
    INFO("of " << needed << " bytes, coarsest " << coarsest);
    CHECK(coarsest > 1.1);
    CHECK(coarsest < 20);
    // The whole disc from afar.
    const Path far = [](double) { return viewAt(-30, -120, 4e7, 0, -90); };
    fly(*pager, far, 100, 101, 0, 1, {}, true, stepS);
    CHECK(pager->coarsening() == 1);
    CHECK(fly(*pager, far, 101, 101.2, 0, 1, {}, true, stepS).missingFrames == 0);
  }
}

TEST_CASE("a hundred random flights keep to their budgets, whatever these are, and leave no hole") {
  std::mt19937 random(11);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  uint64_t loaded = 0, evicted = 0;
  for (int flight = 0; flight < 100; ++flight) {
    const auto gpuBytes = static_cast<uint64_t>(std::pow(10, uniform(4.8, 7)));
    const auto ramBytes = static_cast<uint64_t>(std::pow(10, uniform(0, 7)));
    INFO("flight " << flight << ", GPU " << gpuBytes << ", RAM " << ramBytes);
    FakeStore gpu(gpuBytes);
    const auto pager = open(gpu, {.ramBudgetBytes = ramBytes, .uploadBytesPerFrame = 200'000});
    const double latDeg = flight % 4 == 0 ? uniform(-89, 89) : kLatDeg, lonDeg = uniform(kLonDeg - 2, kLonDeg + 2);
    const double altM = std::pow(10, uniform(3.3, 6)), headingDeg = uniform(0, 360), turnDegS = uniform(-20, 20);
    const double degS = uniform(0, 0.1);
    const Path path = [=](double t) {
      const double h = (headingDeg + turnDegS * t) * 3.14159265358979 / 180;
      return viewAt(std::clamp(latDeg + degS * t * std::cos(h), -89.9, 89.9), lonDeg + degS * t * std::sin(h), altM,
                    headingDeg + turnDegS * t, -15);
    };
    fly(*pager, path, 0, 1, degS * 111200, 0.5, [&](const Selection& selection) {
      for (const DrawnChunk& draw : selection.draws)
        REQUIRE(pager->cache().find(pager->cache().node(draw.node).meta.key));
      const PagingCounts counts = pager->counts();
      REQUIRE(counts.ramBytes <= ramBytes);
      REQUIRE(counts.gpuBytes <= gpuBytes);
      REQUIRE(counts.resident == gpu.live());
      REQUIRE(counts.resident == 8 + counts.loaded - counts.evicted);
    });
    // Everything counts as drawn once: no hole, no overlap.
    Selection all;
    pager->cache().beginFrame();
    selectChunks(pager->cache(), path(1), {.ssePx = kSsePx, .culling = CullingScheme::none}, all);
    double sum = 0;
    for (const DrawnChunk& draw : all.draws) {
      double part = 1;
      for (std::optional<TileKey> parent = pager->cache().node(draw.node).meta.key.parent(); parent;
           parent = parent->parent())
        part /= parent->children().count;
      sum += part;
    }
    REQUIRE(sum == Approx(8));
    loaded += pager->counts().loaded;
    evicted += pager->counts().evicted;
  }
  CHECK(loaded > 2000);
  CHECK(evicted > 20);
}

TEST_CASE("a teleport a second across the globe: each time it recovers, and nothing leaks") {
  std::mt19937 random(5);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  FakeStore gpu(600'000);
  const auto pager = open(gpu, {.ramBudgetBytes = 1'000'000});
  for (int jump = 0; jump < 60; ++jump) {
    const double latDeg = jump % 3 == 0 ? kLatDeg : uniform(-80, 80),
                 lonDeg = jump % 3 == 0 ? kLonDeg : uniform(-180, 180);
    const View view = viewAt(latDeg, lonDeg, 5000, uniform(0, 360));
    const Path path = [&view](double) { return view; };
    Selection selection;
    // A second on a clock, in frames of a millisecond: the paging thread of a busy machine gets its time.
    for (int frame = 0; frame < 60 || (frame < 1000 && selection.counts.missing > 0); ++frame) {
      pager->cache().beginFrame();
      selectChunks(pager->cache(), view, {.ssePx = kSsePx, .coarsening = pager->coarsening()}, selection);
      const LookAhead look = lookAhead(path, jump + frame / 60.0, 0, frame == 0);
      pager->exchange(selection, &look);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    INFO("jump " << jump);
    CHECK(selection.counts.missing == 0);
    REQUIRE(pager->counts().gpuBytes <= 600'000);
    REQUIRE(pager->counts().ramBytes <= 1'000'000);
    REQUIRE(pager->counts().resident == gpu.live());
  }
}

TEST_CASE("a still eye comes to rest whatever the budget") {
  const Path still = [](double) { return aroundMiddle(3); };
  for (uint64_t gpuBytes = 60'000; gpuBytes <= 640'000; gpuBytes = gpuBytes * 5 / 4) {
    // Bytes are short, or, as in a renderer's pools, places for imagery.
    const bool layersShort = gpuBytes % 2 == 0;
    FakeStore gpu(layersShort ? kPlenty : gpuBytes, layersShort ? gpuBytes / 6000 : kPlenty);
    const auto pager = open(gpu, {.ramBudgetBytes = 2'000'000});
    double fromS = 0;
    PagingCounts before;
    do {
      before = pager->counts();
      fly(*pager, still, fromS, fromS + 2, 0, 0.5);
      fromS += 2;
    } while ((pager->counts().loaded != before.loaded || pager->counts().requested != before.requested) && fromS < 60);
    INFO("budget " << gpuBytes << ", coarser by " << pager->coarsening());
    fly(*pager, still, fromS, fromS + 10, 0, 0);
    CHECK(pager->counts().loaded == before.loaded);
    CHECK(pager->counts().evicted == before.evicted);
    CHECK(pager->counts().requested == before.requested);
  }
}

TEST_CASE("where places for imagery are short, others do not go in vain") {
  for (uint64_t layers : {32u, 40u, 48u}) {
    FakeStore gpu(kPlenty, layers);
    const auto pager = open(gpu, {.ramBudgetBytes = 2'000'000});
    fly(*pager, aroundMiddle, 0, kRoundS / 2, kRoundMS, 0.3);
    INFO(layers << " layers, coarser by " << pager->coarsening());
    const PagingCounts counts = pager->counts();
    CHECK(counts.resident > layers);
    // Where the detail is: what has no imagery of its own needs none of what is short.
    Selection selection;
    pager->cache().beginFrame();
    selectChunks(pager->cache(), aroundMiddle(kRoundS / 2), {.ssePx = kSsePx, .coarsening = pager->coarsening()},
                 selection);
    int finest = 0;
    for (const DrawnChunk& draw : selection.draws)
      finest = std::max(finest, pager->cache().node(draw.node).meta.key.level());
    CHECK(finest >= 6);
  }
}

}  // namespace eye

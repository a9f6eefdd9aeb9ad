// Culling never changes a pixel: pictures and depths of every way of culling against those without any, byte by byte,
// over real mountains and over the whole globe. And the GPU decides as its CPU mirror does, cluster by cluster.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "app/depth_map_control.h"
#include "culling/culling_rig.h"
#include "culling/poses.h"
#include "render/cull_mirror.h"
#include "shared/cull_types.h"
#include "support/places.h"

namespace eye::test {
namespace {

// Those of the selector, some that no picture is a multiple of, and the least; the first few are enough for a machine
// without much time.
constexpr glm::ivec2 kMaps[] = {{320, 240}, {97, 61}, {640, 480}, {1, 1}, {400, 300}, {800, 600}, {33, 7}};
constexpr int kMirrorEvery = 8;  // frames: reading back takes longer than drawing

struct Sums {
  uint64_t pictures = 0, mirrored = 0, withTerrain = 0, maps = 0, buried = 0;
  uint64_t considered = 0, drawn = 0, occluded = 0, outside = 0, backFacing = 0;
};

void add(Sums& sums, const CullCounts& counts) {
  sums.considered += counts.considered;
  sums.drawn += counts.drawn;
  sums.occluded += counts.occluded;
  sums.outside += counts.outside;
  sums.backFacing += counts.backFacing;
}

class Comparison {
 public:
  // `ssePx`: small pictures with the terrain of larger ones have more to cull.
  Comparison(CullingRig& rig, int widthPx, int heightPx, double ssePx)
      : rig_(rig), widthPx_(widthPx), heightPx_(heightPx), ssePx_(ssePx) {
    auto control = DepthMapControl::create({});
    if (!control) FAIL(control.error().message);
    control_ = std::move(*control);
  }

  // Every way of culling against none. `load`: what each may load before it draws; with nothing and with once all draw
  // from the same, perhaps incomplete, terrain.
  void compare(const Eye& eye, CullingRig::Load load) {
    const View view = eye.view(widthPx_, heightPx_);
    INFO("pose " << eye.text());
    const bool settles = load == CullingRig::Load::settle;
    const LodOptions none{.ssePx = ssePx_, .culling = CullingScheme::none}, frustum{.ssePx = ssePx_};
    std::optional<Picture> before;
    // What the frustum wants comes first: without culling far more is resident, which must change nothing either.
    rig_.select(view, frustum, load);
    if (settles) before = rig_.draw(view, {});
    rig_.select(view, none, settles ? load : CullingRig::Load::nothing);
    if (isBuried(eye.pose.position)) {
      ++sums_.buried;
      return;
    }
    const Picture whole = rig_.draw(view, {}, true);
    sums_.withTerrain += std::ranges::any_of(whole.depth, [](float depth) { return depth > 0; });
    if (before) check("frustum, before the rest was loaded", whole, *before);
    rig_.select(view, frustum, CullingRig::Load::nothing);
    check("frustum", whole, rig_.draw(view, {}));
    for (int frame = 0; frame < (settles ? 3 : 1); ++frame) {
      const glm::ivec2 mapPx = kMaps[sums_.maps++ % std::size(kMaps)];
      dynamic(view, whole, mapPx, fmt::format("dynamic {}x{}", mapPx.x, mapPx.y));
    }
    // The selector's own choice, which it makes from what it measures.
    const std::optional<glm::ivec2> chosen = control_.choose(eye.pose, rig_.terrain(), rig_.selection());
    dynamic(view, whole, chosen, "dynamic auto");
    control_.learn(rig_.output(), 0);
  }

  const Sums& sums() const { return sums_; }

 private:
  // Under terrain that is still coarse one sees through the ground, which hides nothing then.
  bool isBuried(const Geodetic& eye) const {
    for (int level = 0; level <= kMaxLevel; ++level) {
      const auto node = rig_.terrain().find(TileKey::containing(eye.latDeg, eye.lonDeg, level));
      if (!node) break;
      const CacheNode& found = rig_.terrain().node(*node);
      if (found.visit == Visit::drawn && found.usedFrame == rig_.terrain().frame())
        return eye.altM < found.meta.maxHeightM;
    }
    return false;
  }

  void check(const std::string& way, const Picture& whole, const Picture& found) {
    INFO(way);
    const std::string differs = difference(whole, found, widthPx_);
    ++sums_.pictures;
    CHECK(differs == "");
  }

  void dynamic(const View& view, const Picture& whole, std::optional<glm::ivec2> mapPx, const std::string& way) {
    const Picture found = rig_.draw(view, mapPx);
    check(way, whole, found);
    add(sums_, found.clusters);
    if (found.clusters.considered > 0 && ++culled_ % kMirrorEvery == 0) mirror(way);
  }

  void mirror(const std::string& way) {
    INFO(way);
    const CullReadBack gpu = rig_.renderer().readCulling();
    const CullMirror cpu = mirrorOf(gpu);
    CHECK((gpu.pyramid == cpu.pyramid));
    CHECK((gpu.fates == cpu.fates));
    CHECK(wrongDraws(gpu) == "");
    ++sums_.mirrored;
  }

  CullingRig& rig_;
  const int widthPx_, heightPx_;
  const double ssePx_;
  DepthMapControl control_;
  uint64_t culled_ = 0;
  Sums sums_;
};

// The least shares of clusters that the tests must have found, lest they prove nothing.
void report(const std::string& name, const Sums& sums) {
  fmt::print(
      "{}: {} pictures compared, {} poses under coarse ground, {} frames mirrored; of {} clusters {} drawn, {} "
      "occluded, {} outside, {} back-facing\n",
      name, sums.pictures, sums.buried, sums.mirrored, sums.considered, sums.drawn, sums.occluded, sums.outside,
      sums.backFacing);
  CHECK(sums.occluded > sums.considered / 200);
  CHECK(sums.drawn > 0);
  CHECK(sums.mirrored > 0);
}

void compareEyes(const std::string& database, int places, int eyesEach, int widthPx, int heightPx, double ssePx,
                 CullBy cullBy, uint32_t seed) {
  const auto rig = CullingRig::open(database, widthPx, heightPx, cullBy);
  if (!rig) return;
  Comparison comparison(*rig, widthPx, heightPx, ssePx);
  const Ground ground(database);
  std::mt19937 random(seed);
  for (int place = 0; place < places; ++place) {
    const TileBounds* near = place % 3 == 2 ? nullptr : &rig->info().dataBounds;
    Eye eye = randomEye(random, ground, near);
    for (int i = 0; i < eyesEach; ++i) {
      // The first with the terrain of the place before, most of it far away and coarse here.
      if (i == 0) comparison.compare(eye, CullingRig::Load::nothing);
      comparison.compare(eye, CullingRig::Load::settle);
      eye = turned(random, eye);
    }
  }
  CHECK(comparison.sums().withTerrain > static_cast<uint64_t>(places * eyesEach / 2));
  report("eyes", comparison.sums());
}

void compareFlight(const std::string& database, int frames, int widthPx, int heightPx, double ssePx, CullBy cullBy) {
  const auto rig = CullingRig::open(database, widthPx, heightPx, cullBy);
  if (!rig) return;
  Comparison comparison(*rig, widthPx, heightPx, ssePx);
  const Ground ground(database);
  for (int number = 0; number < frames; ++number)
    comparison.compare(flightEye(number, ground, rig->info().dataBounds), CullingRig::Load::once);
  CHECK(comparison.sums().withTerrain == static_cast<uint64_t>(frames) - comparison.sums().buried);
  CHECK(comparison.sums().buried < static_cast<uint64_t>(frames / 10));
  report("flight", comparison.sums());
}

// Of four SRTM tiles of the Tatras; empty, with a warning, where they are not here.
std::string tatras() {
  const std::string path = eye::test::kTestFiles + "/carpathia.eyt";
  if (std::filesystem::exists(path)) return path;
  WARN("no elevation of the Tatras in " << eye::test::kTestData << ": culling is not tested over real mountains");
  return {};
}

}  // namespace

TEST_CASE("culling changes no pixel: eyes from 30 m above the ground to 62,763 km, in any attitude") {
  const std::string database = tatras();
  if (!database.empty()) compareEyes(database, 30, 10, 160, 120, 0.25, CullBy::host, 1);
}

TEST_CASE("culling changes no pixel: a flight between ridges in hard turns, its terrain still loading") {
  const std::string database = tatras();
  if (!database.empty()) compareFlight(database, 300, 160, 120, 0.25, CullBy::compute);
}

// By hand: EYE_CULLING_DATABASE=FILE.eyt test_culling "[by hand]"; without it over the Tatras.
TEST_CASE("culling changes no pixel: a thousand eyes and two thousand frames at 640x480", "[.][by hand]") {
  const char* given = std::getenv("EYE_CULLING_DATABASE");
  const std::string database = given != nullptr ? given : tatras();
  REQUIRE(!database.empty());
  compareEyes(database, 100, 10, 640, 480, 1, CullBy::host, 2);
  compareFlight(database, 2000, 640, 480, 1, CullBy::compute);
}

}  // namespace eye::test

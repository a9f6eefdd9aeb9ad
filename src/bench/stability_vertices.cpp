// Vertices: floats against doubles.
#include <algorithm>
#include <cmath>
#include <random>

#include "bench/stability.h"
#include "render/frame_data.h"

namespace eye {
namespace {

constexpr int kWidthPx = 1280, kHeightPx = 720;
constexpr double kMostOffPx = 0.1;  // nobody sees a tenth of a pixel
constexpr double kMostDepthOff = 1e-6;
constexpr double kMillimetreM = 0.001;
// A chunk is about as far away as it is wide, or farther; the level of such a chunk is the finest that matters.
constexpr double kRootWidthM = 1e7;

struct Landed {
  glm::dvec2 px{};
  double distanceM = 0;  // along the view
  bool isInView = false;
};

Landed landed(const glm::dvec4& clip, double nearM) {
  const glm::dvec2 ndc = glm::dvec2(clip) / clip.w;
  return {.px = (ndc + 1.0) * 0.5 * glm::dvec2(kWidthPx, kHeightPx),
          .distanceM = nearM / (clip.z / clip.w),
          .isInView = clip.w > nearM && std::abs(ndc.x) <= 1 && std::abs(ndc.y) <= 1};
}

// A vertex of a chunk, in lattice steps.
struct Vertex {
  LatticePoint originLattice;
  glm::ivec3 offset;
  double stepM;
};

// As shaders/terrain.vert does it.
Landed drawn(const View& view, const Vertex& vertex) {
  FrameInput input;
  input.view = view;
  ChunkDraw chunk;
  chunk.originLattice = vertex.originLattice;
  chunk.stepM = vertex.stepM;
  const shader::FrameData frame = frameData(input);
  const shader::DrawData data = drawData(chunk, view.eyeEcefM, 256);
  const glm::vec3 positionEcef = glm::vec3(vertex.offset + data.originMinusEyeCell) * data.stepM - data.eyeFractionM;
  const glm::vec4 clip = frame.clipFromEcef * glm::vec4(positionEcef, 1.0f);
  return landed(glm::dvec4(clip), view.frustum.nearM);
}

Landed exact(const View& view, const Vertex& vertex) {
  const Vec3d ecefM = ecefFromLattice(vertex.originLattice + LatticePoint(vertex.offset), vertex.stepM);
  const Vec3d eye = view.eyeFromEcef * (ecefM - view.eyeEcefM);
  const Frustum& f = view.frustum;
  const glm::dvec4 clip((2 * eye.x - (f.tanRight + f.tanLeft) * eye.z) / (f.tanRight - f.tanLeft),
                        (2 * eye.y + (f.tanTop + f.tanBottom) * eye.z) / (f.tanTop - f.tanBottom), f.nearM, eye.z);
  return landed(clip, f.nearM);
}

class Sampler {
 public:
  explicit Sampler(int samples) : samples_(samples) {}

  struct Range {
    double from, to;
  };
  struct Case {
    Range latDeg{-90, 90}, lonDeg{-180, 180}, altM{0, 10'000}, fovDeg{60, 60}, nearM{1, 1};
    double farthestM = 100'000;
  };
  struct Worst {
    double offPx = 0, depthOff = 0, stepOffPx = 0;
  };
  Worst worst(const Case& at) {
    Worst worst;
    for (int i = 0; i < samples_; ++i) {
      const Pose pose{{uniform(at.latDeg), uniform(at.lonDeg), uniform(at.altM)},
                      uniform({0, 360}),
                      uniform({-90, 90}),
                      uniform({-180, 180})};
      const double nearM = powerBetween(at.nearM);
      const View view =
          makeView(pose, symmetricFrustum(powerBetween(at.fovDeg), kWidthPx, kHeightPx, nearM), kWidthPx, kHeightPx);
      const Vertex vertex = vertexInView(view, powerBetween({std::max(2.0, 2 * nearM), at.farthestM}));
      const Landed floats = drawn(view, vertex), doubles = exact(view, vertex);
      if (!doubles.isInView) continue;
      worst.offPx = std::max(worst.offPx, glm::length(floats.px - doubles.px));
      worst.depthOff = std::max(worst.depthOff, std::abs(floats.distanceM / doubles.distanceM - 1));
      View next = view;
      next.eyeEcefM += kMillimetreM * glm::normalize(Vec3d(uniform({-1, 1}), uniform({-1, 1}), uniform({-1, 1})));
      const glm::dvec2 moved = drawn(next, vertex).px - floats.px, should = exact(next, vertex).px - doubles.px;
      worst.stepOffPx = std::max(worst.stepOffPx, glm::length(moved - should));
    }
    return worst;
  }

 private:
  double uniform(const Range& range) { return std::uniform_real_distribution<>(range.from, range.to)(random_); }
  double powerBetween(const Range& range) {
    return range.from == range.to ? range.from : std::exp(uniform({std::log(range.from), std::log(range.to)}));
  }
  // At that distance behind a random pixel, as a vertex somewhere in a chunk of the level that one would see there.
  Vertex vertexInView(const View& view, double distanceM) {
    const Vec3d rayEye =
        rayThroughPixel(view.frustum, kWidthPx, kHeightPx, static_cast<int>(uniform({0, kWidthPx - 1})),
                        static_cast<int>(uniform({0, kHeightPx - 1})));
    const Vec3d ecefM = view.eyeEcefM + glm::transpose(view.eyeFromEcef) * rayEye * distanceM;
    const double stepM =
        latticeStepM(std::clamp(static_cast<int>(std::ceil(std::log2(kRootWidthM / distanceM))), 0, kMaxLevel));
    constexpr double kReach = 30'000;  // of 16-bit offsets
    const glm::ivec3 offset(uniform({-kReach, kReach}), uniform({-kReach, kReach}), uniform({-kReach, kReach}));
    return {latticeFromEcef(ecefM, stepM) - LatticePoint(offset), offset, stepM};
  }

  const int samples_;
  std::mt19937 random_{1};
};

}  // namespace

std::vector<StabilityFigure> vertexFigures(int samples) {
  using Case = Sampler::Case;
  Sampler sampler(samples);
  std::vector<StabilityFigure> figures;
  const auto add = [&](const std::string& name, const Case& at) {
    const Sampler::Worst worst = sampler.worst(at);
    figures.push_back({"vertices off, " + name, worst.offPx, kMostOffPx, "px"});
    figures.push_back({"distances off, " + name, worst.depthOff, kMostDepthOff, "of the distance"});
    return worst;
  };
  const auto addSteps = [&](const std::string& name, const Case& at) {
    const Sampler::Worst worst = add(name, at);
    figures.push_back({"steps of 1 mm off, " + name, worst.stepOffPx, kMostOffPx, "px"});
  };
  addSteps("-400 to 0 m", {.altM = {-400, 0}, .farthestM = 10'000});
  addSteps("0 to 100 m", {.altM = {0, 100}, .farthestM = 50'000});
  add("100 m to 20 km", {.altM = {100, 20'000}, .farthestM = 500'000});
  add("20 to 1,000 km", {.altM = {20'000, 1e6}, .farthestM = 5e6});
  add("1,000 to 100,000 km", {.altM = {1e6, 1e8}, .farthestM = 1.1e8});
  addSteps("the north pole", {.latDeg = {90, 90}, .altM = {0, 100}});
  addSteps("the south pole", {.latDeg = {-90, -90}, .altM = {0, 100}});
  addSteps("a metre from a pole", {.latDeg = {89.99999, 90}, .altM = {0, 100}});
  addSteps("the date line", {.lonDeg = {179.99999, 180.00001}, .altM = {0, 100}});
  addSteps("edges of octants", {.latDeg = {-0.00001, 0.00001}, .lonDeg = {89.99999, 90.00001}, .altM = {0, 100}});
  add("fields of view of 1 to 10 degrees", {.fovDeg = {1, 10}});
  add("fields of view of 100 to 150 degrees", {.fovDeg = {100, 150}});
  add("near planes of 1 to 10 cm", {.nearM = {0.01, 0.1}});
  add("near planes of 100 to 1,000 m", {.nearM = {100, 1000}});
  return figures;
}

}  // namespace eye

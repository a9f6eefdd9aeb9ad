#include "render/bands.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"

namespace eye {
namespace {

// Of the way to where the bands were even, in a frame: what other programs do to one frame shall not move much.
constexpr double kGain = 0.25;
// Of a step: as near to that an edge stays, lest it swing between two places.
constexpr double kNear = 0.75;

constexpr int kRasterTilePx = 64;  // lavapipe's

int roundedTo(double px, int stepPx) {
  return static_cast<int>(std::lround(px / stepPx)) * stepPx;
}

// From an edge towards where it should be.
int moveBy(double offPx, int stepPx) {
  const int part = roundedTo(kGain * offPx, stepPx);
  if (part != 0 || std::abs(offPx) <= kNear * stepPx) return part;
  return offPx > 0 ? stepPx : -stepPx;
}

// At least a step between two edges. Where there are not columns for that the last bands have none.
void part(std::vector<int>& edges, int stepPx) {
  const int steps = (edges.back() + stepPx - 1) / stepPx;
  const size_t used = std::min(edges.size() - 1, static_cast<size_t>(steps));
  for (size_t i = 1; i < used; ++i) edges[i] = std::max(edges[i], edges[i - 1] + stepPx);
  int most = steps * stepPx;
  for (size_t i = used - 1; i > 0; --i) edges[i] = most = std::min(edges[i], most - stepPx);
  for (size_t i = used; i + 1 < edges.size(); ++i) edges[i] = edges.back();
}

float reachOf(const glm::vec3& plane, const shader::CullBox& box) {
  return std::abs(glm::dot(plane, box.x_ecef)) + std::abs(glm::dot(plane, box.y_ecef)) +
         std::abs(glm::dot(plane, box.z_ecef));
}

}  // namespace

BandPlan planBands(int asked, int cores) {
  const int bands = std::clamp(asked > 0 ? asked : cores, 1, kMostBands);
  const int threads = cores / bands;
  return {bands, threads > 1 ? threads : 0};
}

int seamStepPx(int samples) {
  return samples > 1 ? kRasterTilePx : EYE_DEPTH_GROUP;
}

std::vector<int> evenEdges(int widthPx, int bands, int stepPx) {
  std::vector<int> edges{0};
  for (int i = 1; i < bands; ++i) edges.push_back(roundedTo(double(widthPx) * i / bands, stepPx));
  edges.push_back(widthPx);
  part(edges, stepPx);
  return edges;
}

std::vector<int> balancedEdges(std::span<const int> edgesPx, std::span<const double> ms, int stepPx) {
  EYE_CHECK(edgesPx.size() == ms.size() + 1);
  const double all = std::accumulate(ms.begin(), ms.end(), 0.0);
  std::vector<int> edges(edgesPx.begin(), edgesPx.end());
  if (!(all > 0)) return edges;
  // Within a band the time is taken to be even.
  size_t band = 0;
  double before = 0;
  for (size_t i = 1; i < ms.size(); ++i) {
    const double wanted = all * double(i) / double(ms.size());
    while (band + 1 < ms.size() && before + ms[band] < wanted) before += ms[band++];
    const double share = ms[band] > 0 ? std::clamp((wanted - before) / ms[band], 0.0, 1.0) : 0;
    const double even = edgesPx[band] + share * (edgesPx[band + 1] - edgesPx[band]);
    edges[i] = edgesPx[i] + moveBy(even - edgesPx[i], stepPx);
  }
  part(edges, stepPx);
  return edges;
}

BandTest::BandTest(std::span<const int> edgesPx, const glm::vec3& clipX, const glm::vec3& clipW) {
  for (size_t i = 1; i + 1 < edgesPx.size(); ++i) {
    const auto ndc = [&](int px) { return 2.0f * float(px) / float(edgesPx.back()) - 1.0f; };
    edges_.push_back({clipX - ndc(edgesPx[i] - 1) * clipW, clipX - ndc(edgesPx[i] + 1) * clipW});
  }
}

uint32_t BandTest::bandsOf(const shader::CullBox& box, float marginM) const {
  uint32_t bands = 1;
  for (size_t i = 0; i < edges_.size(); ++i) {
    const glm::vec3 &right = edges_[i].right, &left = edges_[i].left;
    if (glm::dot(right, box.centre_ecef) + reachOf(right, box) + marginM * glm::length(right) > 0) bands |= 2u << i;
    // All of it right of this edge: none of it in the bands before.
    if (glm::dot(left, box.centre_ecef) - reachOf(left, box) - marginM * glm::length(left) >= 0)
      bands &= ~0u << (i + 1);
  }
  return bands;
}

}  // namespace eye

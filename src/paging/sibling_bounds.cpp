#include "paging/sibling_bounds.h"

#include <cmath>

namespace eye {
namespace {

using Lanes = SiblingBounds::Lanes;

// A float's rounding is 6e-8 of what it rounds; sums of three products, a difference and a quotient come to a dozen of
// those.
constexpr double kRounding = 2e-6;

float sumOfSizes(const glm::vec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

// As std::min and std::max, lane by lane; what is no number loses.
Lanes lesser(Lanes candidate, Lanes other) {
  return candidate < other ? candidate : other;
}
Lanes greater(Lanes candidate, Lanes other) {
  return candidate > other ? candidate : other;
}

}  // namespace

Sight sightBetween(const Vec3d& fromEcefM, const Vec3d& toEcefM) {
  const Vec3d way = toEcefM - fromEcefM;
  return {fromEcefM, way, glm::vec3(way)};
}

void SiblingBounds::set(uint32_t lane, const OrientedBox& box, double reachM) {
  if (!hasOrigin_) originEcefM_ = box.centreEcefM;
  hasOrigin_ = true;
  const Vec3d centreM = box.centreEcefM - originEcefM_;
  for (size_t i = 0; i < slabs_.size(); ++i) {
    const double halfM = glm::length(box.halfAxesEcefM[i]);
    const Vec3d axis = halfM > 0 ? box.halfAxesEcefM[i] / halfM : Vec3d(0.0);  // one of 0 parts nothing
    const double alongM = glm::dot(axis, centreM), extentM = halfM + reachM;
    slabs_[i].x[lane] = static_cast<float>(axis.x);
    slabs_[i].y[lane] = static_cast<float>(axis.y);
    slabs_[i].z[lane] = static_cast<float>(axis.z);
    slabs_[i].centreM[lane] = static_cast<float>(alongM);
    slabs_[i].extentM[lane] = static_cast<float>(extentM + kRounding * (extentM + std::abs(alongM)));
  }
}

// Clipped by one pair of faces after the other (Kay and Kajiya 1986). A way along the faces is divided by as well:
// IEEE's infinities then say what they should.
SiblingBounds::Entries SiblingBounds::entriesOf(const Sight& sight, float untilAlong) const {
  const glm::vec3 from(sight.fromEcefM - originEcefM_), way = sight.wayM;
  const auto slackM = static_cast<float>(kRounding) * (sumOfSizes(from) + sumOfSizes(way));
  Lanes enters{}, leaves{untilAlong, untilAlong, untilAlong, untilAlong};
  for (const Slab& slab : slabs_) {
    const Lanes at = along(slab, from) - slab.centreM;
    const Lanes per = 1 / along(slab, way);
    const Lanes extent = slab.extentM + slackM, first = (-extent - at) * per, second = (extent - at) * per;
    enters = greater(lesser(first, second), enters);
    leaves = lesser(greater(first, second), leaves);
  }
  return {enters, enters <= leaves};
}

SiblingBounds::Mask SiblingBounds::reachInto(const Ball& ball) const {
  const glm::vec3 centre(ball.centreEcefM - originEcefM_);
  const float slackM = static_cast<float>(kRounding) * sumOfSizes(centre);
  Lanes apartSquared{};
  for (const Slab& slab : slabs_) {
    const Lanes at = along(slab, centre) - slab.centreM, aside = greater(at, -at);
    const Lanes apart = greater(aside - slab.extentM - slackM, Lanes{});
    apartSquared += apart * apart;
  }
  const float radiusM = static_cast<float>(ball.radiusM) * (1 + static_cast<float>(kRounding));
  return apartSquared <= radiusM * radiusM;
}

}  // namespace eye

#include "link/track.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "link/angles.h"

namespace eye {
namespace {

using Vec4d = glm::dvec4;

// What is interpolated, for one sample.
struct Node {
  double timeS = 0;
  Vec3d ecefM{};
  double altM = 0;
  Vec4d attitude{};  // quaternion body to ecef: has no singularity anywhere, at the poles neither
};

Node nodeOf(const TrackSample& sample) {
  const glm::dquat q = glm::quat_cast(ecefFromBody(sample.pose));
  return {sample.timeS, ecefFromGeodetic(sample.pose.position), sample.pose.position.altM, Vec4d(q.w, q.x, q.y, q.z)};
}

double lengthOf(double v) {
  return std::abs(v);
}
template <class V>
double lengthOf(const V& v) {
  return glm::length(v);
}

// The derivative at `now` from its neighbours: of the parabola through the three, but at most three times the slope on
// either side (Fritsch and Carlson's bound), so that an aircraft that stops does not swing past its place.
template <class V>
V slopeAt(double beforeS, const V& before, double nowS, const V& now, double afterS, const V& after) {
  const double leftS = nowS - beforeS, rightS = afterS - nowS;
  if (leftS <= 0 || rightS <= 0) {  // at an end: one neighbour only, given twice
    if (leftS > 0) return (now - before) / leftS;
    return rightS > 0 ? (after - now) / rightS : now * 0.0;
  }
  const V left = (now - before) / leftS, right = (after - now) / rightS;
  const V slope = (left * rightS + right * leftS) / (leftS + rightS);
  const double bound = 3 * std::min(lengthOf(left), lengthOf(right)), length = lengthOf(slope);
  return length > bound ? slope * (bound / length) : slope;
}

// Cubic Hermite segment over `stepS` seconds, u in [0, 1].
template <class V>
V hermite(const V& from, const V& fromSlope, const V& to, const V& toSlope, double stepS, double u) {
  const double u2 = u * u, u3 = u2 * u;
  return from * (2 * u3 - 3 * u2 + 1) + fromSlope * ((u3 - 2 * u2 + u) * stepS) + to * (3 * u2 - 2 * u3) +
         toSlope * ((u3 - u2) * stepS);
}

template <class Member>
auto interpolated(const Node (&n)[4], double u, Member member) {
  const auto fromSlope = slopeAt(n[0].timeS, n[0].*member, n[1].timeS, n[1].*member, n[2].timeS, n[2].*member);
  const auto toSlope = slopeAt(n[1].timeS, n[1].*member, n[2].timeS, n[2].*member, n[3].timeS, n[3].*member);
  return hermite(n[1].*member, fromSlope, n[2].*member, toSlope, n[2].timeS - n[1].timeS, u);
}

// q and -q are the same rotation: turn each to the side of the one before, which makes the short way the straight one.
void takeShortWay(Node (&n)[4]) {
  if (glm::dot(n[0].attitude, n[1].attitude) < 0) n[0].attitude = -n[0].attitude;
  if (glm::dot(n[1].attitude, n[2].attitude) < 0) n[2].attitude = -n[2].attitude;
  if (glm::dot(n[2].attitude, n[3].attitude) < 0) n[3].attitude = -n[3].attitude;
}

}  // namespace

Track::Track(std::vector<TrackSample> samples) : samples_(std::move(samples)) {
  EYE_CHECK(!samples_.empty());
  const double startS = samples_.front().timeS;
  for (size_t i = 0; i < samples_.size(); ++i) {
    samples_[i].timeS -= startS;
    EYE_CHECK(i == 0 || samples_[i].timeS > samples_[i - 1].timeS);
  }
}

Pose Track::at(double timeS) const {
  if (!(timeS > 0)) return samples_.front().pose;
  if (timeS >= durationS()) return samples_.back().pose;
  const auto next = std::upper_bound(samples_.begin(), samples_.end(), timeS,
                                     [](double t, const TrackSample& sample) { return t < sample.timeS; });
  const auto i = static_cast<size_t>(next - samples_.begin()) - 1;  // the sample at or before timeS
  if (timeS == samples_[i].timeS) return samples_[i].pose;

  Node n[4] = {nodeOf(samples_[i > 0 ? i - 1 : i]), nodeOf(samples_[i]), nodeOf(samples_[i + 1]),
               nodeOf(samples_[std::min(i + 2, samples_.size() - 1)])};
  takeShortWay(n);
  const double u = (timeS - n[1].timeS) / (n[2].timeS - n[1].timeS);

  Geodetic position = geodeticFromEcef(interpolated(n, u, &Node::ecefM));
  position.altM = interpolated(n, u, &Node::altM);
  Vec4d attitude = interpolated(n, u, &Node::attitude);
  // Neighbours on one side are at most 90 degrees apart in quaternion space, so the sum cannot vanish; if it did: hold.
  if (glm::length(attitude) < 1e-3) attitude = n[1].attitude;
  attitude = glm::normalize(attitude);
  return poseFromBody(position, glm::mat3_cast(glm::dquat(attitude.x, attitude.y, attitude.z, attitude.w)));
}

}  // namespace eye

// Boxes of up to four siblings, held against a line all at once: a lane for each, in floats from a place among them.
// Conservative: rounding may find a line in a box that it passes by, never past one that it meets. Pure.
#pragma once

#include <array>
#include <cstdint>

#include "terrain/chunk.h"

namespace eye {

// A line between two points, with what all its tests share.
struct Sight {
  Vec3d fromEcefM{}, wayEcefM{};
  glm::vec3 wayM{};  // the same
};
Sight sightBetween(const Vec3d& fromEcefM, const Vec3d& toEcefM);

struct Ball {
  Vec3d centreEcefM{};
  double radiusM = 0;
};

class SiblingBounds {
 public:
  static constexpr uint32_t kLanes = 4;
  using Lanes [[gnu::vector_size(sizeof(float) * kLanes)]] = float;
  using Mask [[gnu::vector_size(sizeof(int32_t) * kLanes)]] = int32_t;
  struct Entries {
    Lanes along;  // as a share of the line's way; means nothing where the box is not met
    Mask met;     // -1 or 0
  };

  // A chunk's box, widened by `reachM` on every side.
  void set(uint32_t lane, const OrientedBox& box, double reachM);
  // Where the line enters each box, up to a share of its way. Lanes never set say nothing.
  Entries entriesOf(const Sight& sight, float untilAlong) const;
  // -1 for boxes that reach into a ball, 0 for others. Lanes never set say nothing.
  Mask reachInto(const Ball& ball) const;

 private:
  // Across one pair of faces: the unit axis, where the centre lies along it, and half the box's length.
  struct Slab {
    Lanes x{}, y{}, z{}, centreM{}, extentM{};
  };
  static Lanes along(const Slab& slab, const glm::vec3& v) { return slab.x * v.x + slab.y * v.y + slab.z * v.z; }

  bool hasOrigin_ = false;
  Vec3d originEcefM_{};
  std::array<Slab, 3> slabs_;
};

}  // namespace eye

// Questions about the ground that a CIGI host asks (height, line of sight), with their points resolved, and who answers
// them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "geo/frames.h"
#include "link/cigi_packets.h"

namespace eye {

// The ground under or over a point, or where a ray meets it.
struct GroundPoint {
  Geodetic position;
  Vec3d normalEcef{};  // unit, outwards
};

// Answers from the finest terrain there is, in double precision. One thread at a time; may read from disk.
class GroundProbe {
 public:
  virtual ~GroundProbe() = default;
  // Nothing where there is no terrain that can be read.
  virtual std::optional<GroundPoint> under(double latDeg, double lonDeg) = 0;
  // The first hit on the way from one point to the other; an error where terrain on the way cannot be read, or the way
  // is too long to be looked at.
  virtual Result<std::optional<GroundPoint>> between(const Vec3d& fromEcefM, const Vec3d& toEcefM) = 0;
};

namespace cigi {

using GroundRequest = std::variant<HeightRequest, SightSegmentRequest, SightVectorRequest>;

// A request with its points resolved; absent where an entity that it names has no place.
struct GroundQuestion {
  GroundRequest request;
  uint8_t hostFrameNibble = 0;
  std::optional<Geodetic> at;                            // of a height
  std::optional<Vec3d> sourceEcefM, fromEcefM, toEcefM;  // of a ray: its source, and between which points it counts
  std::optional<Vec3d> bodyEcefM;                        // the entity in whose body frame the hit is wanted
  Mat3d ecefFromBody{1.0};
};

// The packet that answers; not valid where `probe` is null or cannot say.
Packet answerTo(const GroundQuestion& question, GroundProbe* probe);

}  // namespace cigi
}  // namespace eye

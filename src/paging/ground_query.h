// Heights and lines of sight in the finest terrain of a database, whatever is drawn: double precision, on triangles.
// One thread at a time.
#pragma once

#include <optional>

#include "paging/ground_tree.h"

namespace eye {

struct GroundHit {
  Geodetic position;
  Vec3d ecefM{};
  Vec3d normalEcef{};  // of the triangle; unit, outwards
};

class GroundQuery {
 public:
  static Result<GroundQuery> open(const std::string& databasePath);

  // The ground under or over a point. Outside the database's data that is sea level, exactly; unsupported where the
  // terrain is known less well than to kCoarsestM.
  Result<GroundHit> under(double latDeg, double lonDeg);
  // The first triangle on the way between two points, either side of it. unsupported where the way leads through more
  // chunks than kMostChunks, or ends on one that is coarser than kCoarsestM.
  Result<std::optional<GroundHit>> between(const Vec3d& fromEcefM, const Vec3d& toEcefM);

  static constexpr int kMostChunks = 4000;   // looked at for one line of sight, by their boxes
  static constexpr double kCoarsestM = 150;  // geometric error: beyond, an answer would be none

 private:
  explicit GroundQuery(DatabaseReader reader) : tree_(std::move(reader)) {}

  GroundTree tree_;
};

}  // namespace eye

#include "app/terrain_probe.h"

#include "paging/ground_query.h"

namespace eye {
namespace {

class TerrainProbe : public GroundProbe {
 public:
  explicit TerrainProbe(GroundQuery query) : query_(std::move(query)) {}
  std::optional<GroundPoint> under(double latDeg, double lonDeg) override {
    const Result<GroundHit> hit = query_.under(latDeg, lonDeg);
    if (!hit) return std::nullopt;
    return GroundPoint{hit->position, hit->normalEcef};
  }
  Result<std::optional<GroundPoint>> between(const Vec3d& fromEcefM, const Vec3d& toEcefM) override {
    const Result<std::optional<GroundHit>> hit = query_.between(fromEcefM, toEcefM);
    if (!hit) return tl::unexpected(hit.error());
    if (!*hit) return std::nullopt;
    return GroundPoint{(*hit)->position, (*hit)->normalEcef};
  }

 private:
  GroundQuery query_;
};

}  // namespace

Result<std::unique_ptr<GroundProbe>> openTerrainProbe(const std::string& databasePath) {
  Result<GroundQuery> query = GroundQuery::open(databasePath);
  if (!query) return tl::unexpected(query.error());
  return std::make_unique<TerrainProbe>(std::move(*query));
}

}  // namespace eye

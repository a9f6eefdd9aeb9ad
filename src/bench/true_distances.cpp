#include "bench/true_distances.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bake/elevation_mosaic.h"
#include "bench/drawn_triangles.h"
#include "bench/triangle_ids.h"
#include "terrain/extent.h"

namespace eye {
namespace {

// Every way from a place: beyond it lies nothing that an eye at 8,000 ft over mountains sees more than a pixel of.
constexpr double kReachDeg = 3;
// Posts of the grid: 4 bytes each, and as much again while its pyramid is made.
constexpr double kMostPosts = 60e6;
// Meshes whose error shows less than this count as exact: a thirtieth of what an error of one pixel may be.
constexpr double kMeshErrorPx = 1.0 / 32;

bool isWithin(const TileBounds& b, const LatLon& at) {
  return at.latDeg > b.southDeg && at.latDeg < b.northDeg && at.lonDeg > b.westDeg && at.lonDeg < b.eastDeg;
}

// Rays on the source.
class SourceTruth final : public TrueDistances {
 public:
  static Result<std::unique_ptr<TrueDistances>> open(const std::vector<std::string>& elevation,
                                                     const std::vector<LatLon>& around) {
    Result<std::unique_ptr<ElevationMosaic>> mosaic = ElevationMosaic::open(elevation);
    if (!mosaic) return tl::unexpected(mosaic.error());
    const TileBounds data = (*mosaic)->dataBounds();
    TileBounds region{90, -90, 180, -180};
    for (const LatLon& at : around) {
      if (!isWithin(data, at))
        return fail(ErrorKind::usage,
                    fmt::format("{}: does not reach {:.3f} N {:.3f} E, where the database is measured; give the "
                                "elevation that it was baked from",
                                elevation.front(), at.latDeg, at.lonDeg));
      region.southDeg = std::min(region.southDeg, at.latDeg - kReachDeg);
      region.northDeg = std::max(region.northDeg, at.latDeg + kReachDeg);
      region.westDeg = std::min(region.westDeg, at.lonDeg - kReachDeg);
      region.eastDeg = std::max(region.eastDeg, at.lonDeg + kReachDeg);
    }
    region = {std::max(region.southDeg, data.southDeg), std::min(region.northDeg, data.northDeg),
              std::max(region.westDeg, data.westDeg), std::min(region.eastDeg, data.eastDeg)};
    const double stepDeg = (*mosaic)->finestSpacingDeg(region);
    // On the source's posts.
    region.southDeg = data.southDeg + std::round((region.southDeg - data.southDeg) / stepDeg) * stepDeg;
    region.westDeg = data.westDeg + std::round((region.westDeg - data.westDeg) / stepDeg) * stepDeg;
    truth::GridShape shape;
    shape.stepDeg = stepDeg;
    shape.southDeg = region.southDeg;
    shape.westDeg = region.westDeg;
    shape.rows = static_cast<int>(std::lround((region.northDeg - region.southDeg) / stepDeg)) + 1;
    shape.columns = static_cast<int>(std::lround((region.eastDeg - region.westDeg) / stepDeg)) + 1;
    if (double(shape.rows) * shape.columns > kMostPosts)
      return fail(ErrorKind::usage, fmt::format("{}: {} x {} posts about the views are too many; give a part of the "
                                                "elevation, or none",
                                                elevation.front(), shape.rows, shape.columns));
    std::vector<double> row;
    std::vector<LatLon> points(static_cast<size_t>(shape.columns));
    int filled = -1;
    const auto heightM = [&](int r, int c) {
      if (filled != r) {
        for (int i = 0; i < shape.columns; ++i)
          points[static_cast<size_t>(i)] = {std::min(shape.southDeg + r * stepDeg, region.northDeg),
                                            std::min(shape.westDeg + i * stepDeg, region.eastDeg)};
        (*mosaic)->heightsM(points, row);
        filled = r;
      }
      return row[static_cast<size_t>(c)];
    };
    auto made = std::make_unique<SourceTruth>(truth::HeightGrid::fromPosts(shape, heightM));
    if (const auto error = (*mosaic)->readError()) return tl::unexpected(*error);
    made->description_ = fmt::format("rays cast in doubles on {}, bilinear between posts {:.1f} arc-seconds apart",
                                     fmt::join(elevation, ", "), stepDeg * 3600);
    return made;
  }
  explicit SourceTruth(truth::HeightGrid grid) : grid_(std::move(grid)) {}

  std::string description() const override { return description_; }
  Result<truth::TruthImage> image(const Pose& pose, double fovDeg, int widthPx, int heightPx) override {
    const Geodetic& at = pose.position;
    return truth::castImage(grid_, {{at.latDeg, at.lonDeg, at.altM}, pose.headingDeg, pose.pitchDeg, pose.rollDeg},
                            fovDeg, widthPx, heightPx);
  }

 private:
  truth::HeightGrid grid_;
  std::string description_;
};

// The finest meshes, drawn in doubles.
class MeshTruth final : public TrueDistances {
 public:
  explicit MeshTruth(const DatabaseReader& reader) : reader_(reader) {}
  std::string description() const override {
    return fmt::format(
        "the finest meshes of {}, drawn in doubles; without --elevation what a bake itself leaves out is "
        "not seen",
        reader_.path());
  }

  Result<truth::TruthImage> image(const Pose& pose, double fovDeg, int widthPx, int heightPx) override {
    // One pixel more on each side.
    const double pixel = 2 * std::tan(radFromDeg(fovDeg / 2)) / widthPx;
    Frustum frustum = symmetricFrustum(fovDeg, widthPx, heightPx, 1);
    frustum.tanLeft -= pixel;
    frustum.tanRight += pixel;
    frustum.tanBottom -= pixel;
    frustum.tanTop += pixel;
    const View view = makeView(pose, frustum, widthPx + 2, heightPx + 2);
    TriangleIds pixels(view);
    for (int octant = 0; octant < kOctants; ++octant)
      if (const Result<void> drawn = draw(TileKey::octantRoot(octant), view, pixels); !drawn)
        return tl::unexpected(drawn.error());
    truth::TruthImage image{widthPx, heightPx, {}};
    const std::span<const double> inverseZ = pixels.inverseZ();
    for (size_t i = 0; i < inverseZ.size(); ++i) {
      const int row = static_cast<int>(i) / view.widthPx, column = static_cast<int>(i) % view.widthPx;
      const Vec3d ray = rayThroughPixel(view.frustum, view.widthPx, view.heightPx, column, row);
      image.hits.push_back(inverseZ[i] > 0 ? truth::Hit{truth::HitKind::terrain, glm::length(ray) / inverseZ[i]}
                                           : truth::Hit{truth::HitKind::sky, 0});
    }
    return image;
  }

 private:
  Result<void> draw(const TileKey& key, const View& view, TriangleIds& pixels) {
    const Result<ChunkMeta> meta = reader_.readMeta(key);
    if (!meta) return tl::unexpected(meta.error());
    const FrustumPlanes planes = frustumPlanes(view);
    for (size_t i = 0; i < planes.normalsEcef.size(); ++i) {
      const double reachM = meta->sphereRadiusM + 2 * meta->geometricErrorM;
      if (glm::dot(planes.normalsEcef[i], meta->sphereCentreEcefM - view.eyeEcefM) + reachM < planes.offsetsM[i])
        return {};
    }
    const double distanceM = std::max(1.0, distanceToBox(view.eyeEcefM, meta->box));
    if (meta->childCount > 0 && meta->geometricErrorM * pixelsPerRadian(view) > kMeshErrorPx * distanceM) {
      for (const TileKey& child : key.children())
        if (const Result<void> drawn = draw(child, view, pixels); !drawn) return drawn;
      return {};
    }
    const Result<StoredChunk> stored = reader_.read(key);
    if (!stored) return tl::unexpected(stored.error());
    const Result<ChunkMesh> mesh = decodeMesh(stored->mesh, key);
    if (!mesh) return tl::unexpected(mesh.error());
    const Vec3d originM = ecefFromLattice(stored->meta.originLattice, stored->meta.stepM()) - view.eyeEcefM;
    std::vector<Vec3d> at;
    at.reserve(mesh->vertices.size());
    for (const ChunkVertex& v : mesh->vertices) at.push_back(originM + Vec3d(v.x, v.y, v.z) * stored->meta.stepM());
    for (size_t i = 0; i + 2 < mesh->indices.size(); i += 3) {
      const std::array<Vec3d, 3> corners{at[mesh->indices[i]], at[mesh->indices[i + 1]], at[mesh->indices[i + 2]]};
      if (!isOffScreen(planes, corners)) pixels.draw(corners[0], corners[1], corners[2], 0);
    }
    return {};
  }

  const DatabaseReader& reader_;
};

// Rows from the top to the first terrain; the picture's height where there is none.
template <class IsTerrain>
int skyRows(int column, int heightPx, const IsTerrain& isTerrain) {
  int row = 0;
  while (row < heightPx && !isTerrain(row, column)) ++row;
  return row;
}

}  // namespace

Result<std::unique_ptr<TrueDistances>> openTrueDistances(const DatabaseReader& reader,
                                                         const std::vector<std::string>& elevation,
                                                         const std::vector<LatLon>& around) {
  if (elevation.empty()) return std::make_unique<MeshTruth>(reader);
  return SourceTruth::open(elevation, around);
}

double skylineErrorPx(const truth::TruthImage& truth, std::span<const float> renderedM) {
  double sum = 0;
  int columns = 0;
  for (int column = 0; column < truth.widthPx; ++column) {
    const int trueRows =
        skyRows(column, truth.heightPx, [&](int row, int c) { return truth.at(row, c).kind != truth::HitKind::sky; });
    const int drawnRows = skyRows(column, truth.heightPx, [&](int row, int c) {
      return !std::isnan(
          renderedM[static_cast<size_t>(row) * static_cast<size_t>(truth.widthPx) + static_cast<size_t>(c)]);
    });
    if (trueRows == 0 && drawnRows == 0) continue;
    sum += std::abs(trueRows - drawnRows);
    ++columns;
  }
  return columns > 0 ? sum / columns : 0;
}

}  // namespace eye

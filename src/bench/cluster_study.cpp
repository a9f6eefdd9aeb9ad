#include "bench/cluster_study.h"

#include <chrono>
#include <cmath>
#include <functional>
#include <unordered_map>

#include <fmt/format.h>

#include "bench/cluster_methods.h"
#include "bench/depth_probe.h"
#include "paging/pager.h"
#include "terrain/chunk_codec.h"

namespace eye {
namespace {

constexpr uint32_t kSizes[] = {32, 64, 128, 256};  // triangles at most

struct Method {
  std::string name;
  uint32_t mostTriangles = 0;
  std::function<TriangleGroups(const ChunkMesh&, const MeshPlace&)> group;
};

std::vector<Method> methods() {
  std::vector<Method> all;
  for (const uint32_t most : kSizes) {
    all.push_back({"place", most, [most](const ChunkMesh& mesh, const MeshPlace& place) {
                     return groupByPlace(triangleShapes(mesh, place), most);
                   }});
    for (const float weight : {0.25f, 1.0f}) {
      all.push_back({fmt::format("meshlets {}", weight), most,
                     [=](const ChunkMesh& mesh, const MeshPlace&) { return groupByMeshlets(mesh, most, weight); }});
    }
    for (const int sectors : {4, 8}) {
      all.push_back({fmt::format("aspect {}", sectors), most, [=](const ChunkMesh& mesh, const MeshPlace& place) {
                       return groupByAspect(triangleShapes(mesh, place), most, sectors);
                     }});
    }
    for (const double weight : {0.5, 1.0}) {
      all.push_back(
          {fmt::format("place and facing {}", weight), most, [=](const ChunkMesh& mesh, const MeshPlace& place) {
             return groupByPlaceAndFacing(triangleShapes(mesh, place), most, weight);
           }});
    }
  }
  return all;
}

struct StudyChunk {
  ChunkMesh mesh;
  MeshPlace place;
  std::vector<std::vector<ChunkCluster>> clusters;  // by method
};

// Sums over every cluster of a method, for the means that no view changes.
struct Shape {
  double diagonalRatio = 0, flatness = 0, buildS = 0;
  uint64_t clusters = 0, chunks = 0;
};

Vec3d offsetM(const StudyChunk& chunk, uint16_t vertex) {
  const ChunkVertex& v = chunk.mesh.vertices[vertex];
  return Vec3d(v.x, v.y, v.z) * chunk.place.stepM;
}

void addShape(const StudyChunk& chunk, const std::vector<ChunkCluster>& clusters, const ChunkMesh& ordered,
              Shape& shape) {
  for (const ChunkCluster& cluster : clusters) {
    double areaM2 = 0;
    for (size_t i = cluster.firstIndex; i < cluster.firstIndex + cluster.indexCount; i += 3) {
      const Vec3d a = offsetM(chunk, ordered.indices[i]);
      areaM2 += 0.5 * glm::length(glm::cross(offsetM(chunk, ordered.indices[i + 1]) - a,
                                             offsetM(chunk, ordered.indices[i + 2]) - a));
    }
    const OrientedBox box = clusterBox(chunk.place.box, cluster);
    double squares = 0;
    for (const Vec3d& axis : box.halfAxesEcefM) squares += 4 * glm::dot(axis, axis);
    if (areaM2 <= 0) continue;
    shape.diagonalRatio += std::sqrt(squares / areaM2);
    shape.flatness += 2 * glm::length(box.halfAxesEcefM[2]) / std::sqrt(squares);
    ++shape.clusters;
  }
}

// Takes every chunk that the pager hands over, without limit, and cuts it in all ways.
class StudyStore final : public GpuStore {
 public:
  bool hasRoomFor(std::span<const LoadedChunk>) override { return true; }
  bool wouldHelp(const GpuChunk&) const override { return false; }
  explicit StudyStore(const std::vector<Method>& methods) : methods_(methods), shapes(methods.size()) {}

  std::optional<GpuChunk> upload(const LoadedChunk& loaded) override {
    StudyChunk chunk;
    chunk.place = placeOf(loaded.meta);
    chunk.mesh = loaded.mesh;
    chunk.mesh.indices.resize(loaded.surfaceIndexCount);
    for (size_t m = 0; m < methods_.size(); ++m) {
      ChunkMesh mesh = chunk.mesh;
      const auto begin = std::chrono::steady_clock::now();
      setClusters(methods_[m].group(mesh, chunk.place), chunk.place, mesh);
      shapes[m].buildS += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      ++shapes[m].chunks;
      addShape(chunk, mesh.clusters, mesh, shapes[m]);
      chunk.clusters.push_back(std::move(mesh.clusters));
    }
    chunks_.emplace(loaded.meta.key, std::move(chunk));
    return GpuChunk{};
  }
  void release(const GpuChunk&) override {}
  uint64_t bytesResident() const override { return 0; }
  const StudyChunk& chunk(const TileKey& key) const { return chunks_.at(key); }

 private:
  const std::vector<Method>& methods_;
  std::unordered_map<TileKey, StudyChunk> chunks_;

 public:
  std::vector<Shape> shapes;
};

// Lowest and highest vertex of the finest tile at a place.
Result<std::array<Geodetic, 2>> lowestAndHighest(const DatabaseReader& reader, LatLon at) {
  for (int level = reader.info().maxLevel; level >= 0; --level) {
    const TileKey key = TileKey::containing(at.latDeg, at.lonDeg, level);
    const Result<StoredChunk> stored = reader.read(key);
    if (!stored && stored.error().kind == ErrorKind::notFound) continue;
    if (!stored) return tl::unexpected(stored.error());
    const Result<ChunkMesh> mesh = decodeMesh(stored->mesh, key);
    if (!mesh) return tl::unexpected(mesh.error());
    std::array<Geodetic, 2> ends{Geodetic{0, 0, 1e9}, Geodetic{0, 0, -1e9}};
    for (const ChunkVertex& v : mesh->vertices) {
      const LatticePoint p = stored->meta.originLattice + LatticePoint(v.x, v.y, v.z);
      const Geodetic g = geodeticFromEcef(ecefFromLattice(p, stored->meta.stepM()));
      if (g.altM < ends[0].altM) ends[0] = g;
      if (g.altM > ends[1].altM) ends[1] = g;
    }
    return ends;
  }
  return fail(ErrorKind::notFound, reader.path() + ": has no roots; bake it again");
}

void selectAll(Pager& pager, const View& view, double ssePx, Selection& selection) {
  do {
    pager.cache().beginFrame();
    selectChunks(pager.cache(), view, {.ssePx = ssePx}, selection);
  } while (pager.exchange(selection) > 0);
}

// Draws what faces the eye; returns how many triangles do not.
uint64_t drawFacing(const StudyChunk& chunk, const View& view, DepthProbe& probe) {
  const Vec3d originM = ecefFromLattice(chunk.place.originLattice, chunk.place.stepM) - view.eyeEcefM;
  uint64_t away = 0;
  for (size_t i = 0; i < chunk.mesh.indices.size(); i += 3) {
    const Vec3d a = originM + offsetM(chunk, chunk.mesh.indices[i]);
    const Vec3d b = originM + offsetM(chunk, chunk.mesh.indices[i + 1]);
    const Vec3d c = originM + offsetM(chunk, chunk.mesh.indices[i + 2]);
    if (glm::dot(glm::cross(b - a, c - a), a) >= 0) {
      ++away;
    } else {
      probe.draw(a, b, c);
    }
  }
  return away;
}

void addView(const std::vector<const StudyChunk*>& drawn, const View& view, std::vector<ClusterStudyRow*>& rows) {
  DepthProbe probe(view);
  uint64_t triangles = 0, away = 0;
  for (const StudyChunk* chunk : drawn) {
    triangles += chunk->mesh.indices.size() / 3;
    away += drawFacing(*chunk, view, probe);
  }
  const auto share = [triangles](uint64_t part) { return static_cast<double>(part) / static_cast<double>(triangles); };
  for (size_t m = 0; m < rows.size(); ++m) {
    uint64_t cone = 0, outside = 0, occluded = 0, any = 0, clusters = 0, kept = 0;
    for (const StudyChunk* chunk : drawn) {
      for (const ChunkCluster& cluster : chunk->clusters[m]) {
        const OrientedBox box = clusterBox(chunk->place.box, cluster);
        const uint64_t size = cluster.indexCount / 3;
        const BoxVerdict verdict = probe.judge(box);
        const bool isAway = facesAway(cluster, box, view.eyeEcefM);
        const bool isCulled = isAway || verdict != BoxVerdict::visible;
        cone += isAway ? size : 0;
        outside += verdict == BoxVerdict::outside ? size : 0;
        occluded += verdict == BoxVerdict::occluded ? size : 0;
        any += isCulled ? size : 0;
        kept += isCulled ? 0 : 1;
        ++clusters;
      }
    }
    ClusterStudyRow& row = *rows[m];
    row.chunks += static_cast<double>(drawn.size());
    row.triangles += static_cast<double>(triangles);
    row.clusters += static_cast<double>(clusters);
    row.keptClusters += static_cast<double>(kept);
    row.facingAway += share(away);
    row.coneCulled += share(cone);
    row.frustumCulled += share(outside);
    row.occluded += share(occluded);
    row.anyCulled += share(any);
  }
}

}  // namespace

Result<std::vector<ClusterStudyRow>> studyClusters(const ClusterStudyOptions& options) {
  Result<DatabaseReader> reader = DatabaseReader::open(options.databasePath);
  if (!reader) return tl::unexpected(reader.error());
  std::vector<Geodetic> grounds;
  for (const LatLon& place : options.places) {
    const auto ends = lowestAndHighest(*reader, place);
    if (!ends) return tl::unexpected(ends.error());
    grounds.insert(grounds.end(), ends->begin(), ends->end());
  }
  const std::vector<Method> all = methods();
  StudyStore store(all);
  auto pager = Pager::create(options.databasePath, store, {.wait = true});
  if (!pager) return tl::unexpected(pager.error());

  std::vector<ClusterStudyRow> rows;
  for (const double heightM : options.heightsM) {
    for (const Method& method : all)
      rows.push_back({.method = method.name, .mostTriangles = method.mostTriangles, .heightM = heightM});
  }
  Selection selection;
  for (size_t h = 0; h < options.heightsM.size(); ++h) {
    std::vector<ClusterStudyRow*> here;
    for (size_t m = 0; m < all.size(); ++m) here.push_back(&rows[h * all.size() + m]);
    double views = 0;
    for (const Geodetic& ground : grounds) {
      for (const double headingDeg : {0.0, 90.0, 180.0, 270.0}) {
        const Pose pose{{ground.latDeg, ground.lonDeg, ground.altM + options.heightsM[h]}, headingDeg, 0, 0};
        const View view = makeView(pose, symmetricFrustum(90, options.widthPx, options.heightPx, 1), options.widthPx,
                                   options.heightPx);
        selectAll(**pager, view, options.ssePx, selection);
        std::vector<const StudyChunk*> drawn;
        for (const DrawnChunk& draw : selection.draws)
          drawn.push_back(&store.chunk((*pager)->cache().node(draw.node).meta.key));
        addView(drawn, view, here);
        ++views;
      }
    }
    for (ClusterStudyRow* row : here) {
      for (double* mean : {&row->chunks, &row->triangles, &row->clusters, &row->keptClusters, &row->facingAway,
                           &row->coneCulled, &row->frustumCulled, &row->occluded, &row->anyCulled}) {
        *mean /= views;
      }
    }
  }
  for (size_t i = 0; i < rows.size(); ++i) {
    const Shape& shape = store.shapes[i % all.size()];
    rows[i].diagonalRatio = shape.diagonalRatio / static_cast<double>(shape.clusters);
    rows[i].flatness = shape.flatness / static_cast<double>(shape.clusters);
    rows[i].buildMs = 1e3 * shape.buildS / static_cast<double>(shape.chunks);
  }
  return rows;
}

}  // namespace eye

// Inserts vertices where a mesh departs most from the surface until it is within a tolerance.
// Greedy insertion: Garland & Heckbert (1995), algorithm III: every triangle owns the samples above it.
#pragma once

#include "bake/tile_mesh.h"

namespace eye {

class MeshRefiner {
 public:
  // Starts on a mesh that has its boundary alone, which must outlive what is done to it here.
  void reset(TileMesh& mesh);

  // A point of the surface for the greedy phase to look at; outside the mesh it is dropped.
  void addSample(LatLon place, double heightM, const PlanePoint& plane);
  // Inserts the worst samples until none is off by more than the tolerance.
  void insertSamples(double toleranceM);
  // The same for the departures along the edges. The grid must cover the mesh.
  void insertAlongEdges(const SampleGrid& grid, double toleranceM);

  // For surfaces too large for one grid: measure each part in turn, then insert where the tolerance is exceeded.
  // Triangles that were measured before are not measured again.
  void beginMeasure();
  // Whether triangles not measured yet reach into a region.
  bool needsMeasure(const TileBounds& region) const;
  void measurePart(const SampleGrid& grid, double toleranceM);
  // False when nothing exceeds the tolerance or nothing can be inserted.
  bool insertMeasured(double toleranceM);

  // Greatest departure found so far in the mesh as it is.
  double greatestErrorM() const;

 private:
  struct Sample {
    PlanePoint plane;
    double metresPerZ, latDeg, lonDeg, heightM;
    int32_t next;  // in its triangle's list
    bool isTried;  // is a vertex, or was refused
  };
  struct Work {  // of one triangle
    int32_t firstSample = -1, worstSample = -1;
    double worstM = 0;                        // of samples not tried yet
    double samplesM = 0;                      // of all samples
    std::array<double, 3> edgeM{-1, -1, -1};  // by side; negative: not measured
    uint32_t version = 0;
    double postsM = 0;     // of posts measured part by part
    ChordError unsampled;  // the worst of these that found no room among the samples
    bool isMeasured = false;
  };
  struct Ranked {
    double errorM;
    int32_t triangle;
    uint32_t version;
    bool operator<(const Ranked& o) const { return errorM != o.errorM ? errorM < o.errorM : triangle < o.triangle; }
  };
  struct Exceeding {
    ChordError error;
    int32_t triangle;
    uint32_t version;
  };
  Work& work(int32_t triangle) { return work_[static_cast<size_t>(triangle)]; }
  void own(int32_t triangle, int32_t sample);
  void rank(int32_t triangle);
  void measurePosts(const SampleGrid& grid, double toleranceM);
  void measureEdge(const SampleGrid& grid, int32_t triangle, size_t side, double toleranceM);
  bool insert(LatLon place, double heightM, int32_t near);
  bool insertOnEdge(const SampleGrid& grid, int32_t triangle, double toleranceM);

  TileMesh* mesh_ = nullptr;
  std::vector<Sample> samples_;
  std::vector<Work> work_;           // by triangle
  std::vector<Ranked> queue_;        // a heap, stale entries included
  std::vector<int32_t> unmeasured_;  // triangles whose edges are to be measured
  std::vector<int32_t> pool_;        // samples to be shared out
  std::vector<PlanePoint> rim_;      // of the cavity being filled
  std::vector<Meridian> meridians_;
  std::vector<Exceeding> exceeding_;  // edges found by measurePart, one entry a part
  std::vector<TileBounds> reach_;     // of triangles to be measured
  int32_t lastTriangle_ = 0;          // where the last sample was put
};

}  // namespace eye

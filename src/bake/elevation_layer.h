// Files of one lattice as one surface without seams, read page by page.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bake/elevation_file.h"
#include "bake/post_fill.h"
#include "bake/post_lattice.h"
#include "terrain/tile_key.h"

namespace eye {

inline constexpr int kPagePosts = 1024;  // cells along a page's edge

// A square of cells with the posts around them. Immutable once made.
struct ElevationPage {
  int64_t south = 0, west = 0;  // of its first post
  int rows = 0, columns = 0;    // posts; both 0 where the layer has nothing here
  std::vector<float> heightM;
  std::vector<float> weight;  // of this layer against those below, 0..1; empty: 1 everywhere
  size_t bytes() const { return sizeof(*this) + (heightM.size() + weight.size()) * sizeof(float); }
};

// What lies below a layer at a point: height, and how much of it (0..1) comes from a source rather than the sea.
struct HeightBelow {
  double heightM = 0, cover = 0;
};
// Metres to add to a source's height, e.g. a geoid's undulation; empty for none.
using HeightCorrection = std::function<double(double latDeg, double lonDeg)>;
using SurfaceBelow = std::function<HeightBelow(double latDeg, double lonDeg)>;

// Thread: any number at once; nothing changes after the files are added.
class ElevationLayer {
 public:
  explicit ElevationLayer(const PostLattice& lattice) : lattice_(lattice) {}
  const PostLattice& lattice() const { return lattice_; }
  const std::vector<ElevationFile>& files() const { return files_; }
  const PostRect& bounds() const { return bounds_; }  // around all of its posts
  double latStepDeg() const { return 1 / lattice_.lat.perDegree; }

  // True where the file's posts lie on the lattice and overlap no file here by more than a shared row or column.
  bool accepts(const GeoGrid& grid) const;
  void add(ElevationFile file);
  // After the last file: the heights at the poles, for layers around the whole globe.
  Result<void> findPoles(const HeightCorrection& correctionM);

  // The cell that holds a point and the place in it; the column may need no wrapping any more.
  struct Place {
    int64_t row = 0, column = 0;
    double north = 0, east = 0;  // 0..1 in the cell
    double poleShare = 0;        // beyond the last row of a global layer: 0 at the row, 1 at the pole
    double poleM = 0;
  };
  // False where the layer has surely nothing.
  bool locate(double latDeg, double lonDeg, Place& place) const;

  // The page that holds the cell. `correctionM` is added to every post (a geoid's undulation; may be empty).
  Result<ElevationPage> makePage(int64_t pageRow, int64_t pageColumn, const SurfaceBelow& below,
                                 const HeightCorrection& correctionM) const;

  // Whether a file meets the region's inside, its fade included; whether files hold all of it.
  bool meets(const TileBounds& region, int marginPosts) const;
  bool covers(const TileBounds& region) const;
  // Adds the layer's post lines strictly inside the region.
  void addPostLines(const TileBounds& region, std::vector<double>& latDeg, std::vector<double>& lonDeg) const;

 private:
  // Columns by which a file's rectangle may be moved to overlap another: turns of the globe.
  std::vector<int64_t> turns() const;
  Result<void> readFile(size_t file, int64_t shift, const PostRect& window, std::vector<float>& sum,
                        std::vector<uint16_t>& count, std::vector<uint8_t>& isVoid) const;

  PostLattice lattice_;
  std::vector<ElevationFile> files_;
  std::vector<PostRect> rects_;  // of the files
  PostRect bounds_;              // around all of them
  bool global_ = false;          // some file goes all around
  bool hasNorthPole_ = false, hasSouthPole_ = false;
  double northPoleM_ = 0, southPoleM_ = 0;
};

}  // namespace eye

// The surface over part of a tile as a grid of heights on its own post lines: what a mesh is measured against.
#pragma once

#include <vector>

#include "bake/elevation.h"

namespace eye {

// Cells are bilinear. Lines are post lines, the region's borders, and more where those are far apart, so that over a
// cell the Earth bends by no more than `bendM`.
struct SampleGrid {
  // What bends a straight line in geodetic coordinates at a parallel.
  struct Curvature {
    double meridianM, primeM, sinLat, cosLat;
  };
  std::vector<double> latDeg, lonDeg;  // ascending
  std::vector<double> heightM;         // row by row, south first
  std::vector<Curvature> curvature;    // by row
  double bendM = 0;

  double at(size_t row, size_t column) const { return heightM[row * lonDeg.size() + column]; }
};

// A part of a tile small enough for one grid.
struct SampleBlock {
  TileBounds region;
  double spacingDeg;  // of its finest posts; 0 where it has none
};

// Cuts a region into blocks of at most `maxSide` posts a side; regions without data stay whole. The middle of a block's
// side may be a post line of no source.
std::vector<SampleBlock> planBlocks(const ElevationSurface& surface, const TileBounds& region, double maxSide);

// `maxBendM` bounds the grid's bendM.
void fillGrid(const ElevationSurface& surface, const SampleBlock& block, double maxBendM, SampleGrid& grid);

}  // namespace eye

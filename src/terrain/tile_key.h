// The tile grid: surface cells of SDOG-ESSG (paper 004; Yu & Wu 2009). Eight octants, each split at the middles of
// latitude and longitude; a cell that touches the pole (LG) has one LG child at the pole, spanning all its longitudes,
// and two children towards the equator (NG); an NG cell has four. Cells in the whole level L: 8 + 16 (4^L - 1) / 3. So
// a level has 2^L rows from the equator to each pole, and the number of columns in an octant halves at 45, 67.5, 78.75
// ... degrees of latitude: a cell may have two neighbours of its own level on its equator side.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "base/error.h"

namespace eye {

// 64-bit codes: 1 | octant (3 bits) | 3 bits a digit. The Earth's surface is the outer boundary of an octant's inner SG
// cell (R0 = 2 R), so the first digit is always 4 and a cell of surface level L has L + 1 digits; 20 digits fit.
inline constexpr int kMaxLevel = 19;
inline constexpr int kOctants = 8;

enum class Side : uint8_t { south = 0, east = 1, north = 2, west = 3 };  // geographic, in both hemispheres
inline constexpr std::array<Side, 4> kSides{Side::south, Side::east, Side::north, Side::west};

struct TileBounds {
  double southDeg, northDeg, westDeg, eastDeg;  // south < north, west < east, within [-90, 90] x [-180, 180]
};

class TileKey;

template <size_t N>
struct TileList {  // a short list without allocation
  std::array<TileKey, N> items;
  int count = 0;
  const TileKey* begin() const { return items.data(); }
  const TileKey* end() const { return items.data() + count; }
};

class TileKey {
 public:
  TileKey() = default;  // octant 0, level 0
  static TileKey octantRoot(int octant);
  // Row 0 touches the equator, row 2^level - 1 the pole; column 0 is at the octant's smallest |longitude|.
  static TileKey fromGrid(int level, int octant, uint32_t row, uint32_t column);
  // The exact inverse of code(); anything that is no surface cell's code is badData.
  static Result<TileKey> fromCode(uint64_t code);
  // The one cell of the level that owns the point. Cells own their south and west edges; the north pole, the poleward
  // side and longitude 180 (the same as -180) fall to the cell that touches them.
  static TileKey containing(double latDeg, double lonDeg, int level);

  uint64_t code() const;
  int level() const { return level_; }
  int octant() const { return octant_; }  // +4 south, bit 1 west, bit 0 |longitude| > 90
  uint32_t row() const { return row_; }
  uint32_t column() const { return column_; }
  bool isSouthern() const { return octant_ >= 4; }
  bool isPolar() const { return row_ == (uint32_t{1} << level_) - 1; }  // an LG cell
  TileBounds bounds() const;
  // Columns in the octant at this row.
  uint32_t columns() const;

  std::optional<TileKey> parent() const;  // none at level 0
  TileList<4> children() const;           // three of a polar cell, else four; EYE_CHECKs level < kMaxLevel
  // Cells of the same level across a side, ordered west to east: none across a pole cell's poleward side, two where
  // the columns double, else one (which may touch along half of its own side only).
  TileList<2> neighbours(Side side) const;

  std::string name() const;  // "L7 octant 0 row 12 column 3", for messages
  bool operator==(const TileKey&) const = default;
  auto operator<=>(const TileKey&) const = default;

 private:
  uint32_t row_ = 0, column_ = 0;
  int8_t level_ = 0, octant_ = 0;
};

// Cells in a whole level of the globe.
constexpr uint64_t tilesInLevel(int level) {
  return 8 + 16 * ((uint64_t{1} << (2 * level)) - 1) / 3;
}

// A place in a cell, both coordinates in [0, 1], counterclockwise seen from above in both hemispheres. What mesh and
// imagery of a chunk are functions of.
//   ordinary cells: s west to east, t south to north, linear in degrees;
//   pole cells: azimuthal about the pole, so that nothing is singular there. With rho = (90 - |lat|) / cell height and
//   a = (lon - west) / (east - west) * 90 degrees: north s = rho cos a, t = rho sin a; south s = rho sin a, t = rho cos
//   a.
struct TileParam {
  double s, t;
};
struct LatLon {
  double latDeg, lonDeg;
};
LatLon latLonFromParam(const TileKey& key, TileParam p);
// Not clamped: a point outside the cell gives parameters outside [0, 1]. `lonDeg` is taken modulo 360 nearest the cell.
TileParam paramFromLatLon(const TileKey& key, LatLon p);

}  // namespace eye

template <>
struct std::hash<eye::TileKey> {
  size_t operator()(const eye::TileKey& key) const noexcept {
    return static_cast<size_t>(key.code() * 0x9E3779B97F4A7C15ull);
  }
};

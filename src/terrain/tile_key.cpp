#include "terrain/tile_key.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

namespace eye {
namespace {

constexpr uint64_t kInnerDigit = 4;  // the first digit: the surface bounds the octant's inner cell

// Rows from the equator to a pole and the cells' height are the same at all longitudes.
uint32_t rowsOf(int level) {
  return uint32_t{1} << level;
}
double cellHeightDeg(int level) {
  return std::ldexp(90.0, -level);
}

// Each leading one of a row's binary digits is a step into a pole cell, which leaves the columns as they are; each
// digit after the first zero doubles them.
int columnBits(int level, uint32_t row) {
  const uint32_t leftAligned = level == 0 ? 0 : row << (32 - level);
  return level - std::countl_one(leftAligned);
}

// Columns counted eastwards from -180 degrees, 0 .. 4 * columns - 1, so that neighbours need no case for octants.
uint32_t columnFromDateLine(const TileKey& key) {
  const bool isWest = (key.octant() & 2) != 0, isFar = (key.octant() & 1) != 0;
  const uint32_t columns = key.columns();
  if (isWest) return (isFar ? 0 : columns) + columns - 1 - key.column();
  return (isFar ? 3 : 2) * columns + key.column();
}

TileKey fromColumnFromDateLine(int level, bool isSouthern, uint32_t row, uint32_t column) {
  constexpr std::array<int, 4> kOctantFromWest{3, 2, 0, 1};
  const uint32_t columns = uint32_t{1} << columnBits(level, row);
  const int octant = kOctantFromWest[column / columns];
  const uint32_t fromWest = column % columns;
  const bool isWest = (octant & 2) != 0;
  return TileKey::fromGrid(level, octant + (isSouthern ? 4 : 0), row, isWest ? columns - 1 - fromWest : fromWest);
}

// The interval [n * size, (n + 1) * size) that holds value, or with `ownsUpper` (n * size, (n + 1) * size]. Size is 90
// over a power of two, so its multiples are exact, and a rounded quotient is never below the true one's floor.
uint32_t intervalOf(double value, double size, uint32_t count, bool ownsUpper) {
  uint32_t n = static_cast<uint32_t>(std::min(std::floor(value / size), static_cast<double>(count - 1)));
  while (n > 0 && (ownsUpper ? value <= n * size : value < n * size)) --n;
  return n;
}

}  // namespace

TileKey TileKey::octantRoot(int octant) {
  return fromGrid(0, octant, 0, 0);
}

TileKey TileKey::fromGrid(int level, int octant, uint32_t row, uint32_t column) {
  EYE_CHECK(level >= 0 && level <= kMaxLevel && octant >= 0 && octant < kOctants);
  EYE_CHECK(row < rowsOf(level) && column < uint32_t{1} << columnBits(level, row));
  TileKey key;
  key.level_ = static_cast<int8_t>(level);
  key.octant_ = static_cast<int8_t>(octant);
  key.row_ = row;
  key.column_ = column;
  return key;
}

Result<TileKey> TileKey::fromCode(uint64_t code) {
  const auto reject = [&](const char* why) {
    return fail(ErrorKind::badData, fmt::format("tile code {:#x}: {}; it names no surface cell", code, why));
  };
  // A leading one, three bits of octant and level + 1 digits of three bits.
  const int bits = static_cast<int>(std::bit_width(code));
  if (bits < 7 || (bits - 4) % 3 != 0) return reject("wrong length");
  const int level = (bits - 4) / 3 - 1;
  if (level > kMaxLevel) return reject("finer than level 19");
  const int octant = static_cast<int>(code >> (bits - 4) & 7);
  if ((code >> (3 * level) & 7) != kInnerDigit) return reject("the first digit is not 4");

  uint32_t row = 0, column = 0;
  bool isPolar = true;
  for (int shift = 3 * (level - 1); shift >= 0; shift -= 3) {
    const uint32_t digit = static_cast<uint32_t>(code >> shift & 7);
    if (digit > 3) return reject("a digit below the surface");
    if (isPolar && digit == 3) return reject("a pole cell has no fourth child");
    const bool isTowardsPole = (digit & 2) != 0;
    isPolar = isPolar && isTowardsPole;
    row = row << 1 | (isTowardsPole ? 1 : 0);
    column = column << 1 | (digit & 1);
  }
  return fromGrid(level, octant, row, column);
}

TileKey TileKey::containing(double latDeg, double lonDeg, int level) {
  EYE_CHECK(std::isfinite(latDeg) && std::isfinite(lonDeg) && level >= 0 && level <= kMaxLevel);
  double lon = std::remainder(lonDeg, 360.0);  // exact
  if (lon >= 180.0) lon = -180.0;
  const double lat = std::clamp(latDeg, -90.0, 90.0);

  // Rows and columns grow away from the equator and the zero meridian: in the south and west the edge that a cell owns
  // (south, west) is therefore its upper one.
  const bool isSouthern = lat < 0.0, isWest = lon < 0.0;
  const double absLon = std::abs(lon);
  const bool isFar = isWest ? absLon > 90.0 : absLon >= 90.0;
  const uint32_t row = intervalOf(std::abs(lat), cellHeightDeg(level), rowsOf(level), isSouthern);
  const int bits = columnBits(level, row);
  const uint32_t column = intervalOf(isFar ? absLon - 90.0 : absLon, cellHeightDeg(bits), uint32_t{1} << bits, isWest);
  return fromGrid(level, (isSouthern ? 4 : 0) + (isWest ? 2 : 0) + (isFar ? 1 : 0), row, column);
}

uint64_t TileKey::code() const {
  uint64_t code = (uint64_t{8} | static_cast<uint64_t>(octant_)) << 3 | kInnerDigit;
  const int bits = columnBits(level_, row_);
  for (int i = level_ - 1; i >= 0; --i) {
    const uint64_t latBit = row_ >> i & 1;
    const uint64_t lonBit = i < bits ? column_ >> i & 1 : 0;
    code = code << 3 | latBit << 1 | lonBit;
  }
  return code;
}

TileBounds TileKey::bounds() const {
  const double height = cellHeightDeg(level_), width = cellHeightDeg(columnBits(level_, row_));
  const double latNear = row_ * height, latFar = (row_ + 1) * height;
  const double meridian = (octant_ & 1) != 0 ? 90.0 : 0.0;
  const double lonNear = meridian + column_ * width, lonFar = meridian + (column_ + 1) * width;
  const bool isWest = (octant_ & 2) != 0;
  // 0.0 - x, not -x: no edge is -0.
  return TileBounds{isSouthern() ? 0.0 - latFar : latNear, isSouthern() ? 0.0 - latNear : latFar,
                    isWest ? 0.0 - lonFar : lonNear, isWest ? 0.0 - lonNear : lonFar};
}

uint32_t TileKey::columns() const {
  return uint32_t{1} << columnBits(level_, row_);
}

std::optional<TileKey> TileKey::parent() const {
  if (level_ == 0) return std::nullopt;
  return fromGrid(level_ - 1, octant_, row_ >> 1, isPolar() ? 0 : column_ >> 1);
}

TileList<4> TileKey::children() const {
  EYE_CHECK(level_ < kMaxLevel);
  const int level = level_ + 1;
  TileList<4> list{};
  const auto add = [&](uint32_t row, uint32_t column) {
    list.items[static_cast<size_t>(list.count++)] = fromGrid(level, octant_, row, column);
  };
  // In the order of the codes' last digit.
  add(2 * row_, 2 * column_);
  add(2 * row_, 2 * column_ + 1);
  add(2 * row_ + 1, 2 * column_);
  if (!isPolar()) add(2 * row_ + 1, 2 * column_ + 1);
  return list;
}

TileList<2> TileKey::neighbours(Side side) const {
  TileList<2> list{};
  const auto add = [&](bool southern, uint32_t row, uint32_t columnFromWest) {
    list.items[static_cast<size_t>(list.count++)] = fromColumnFromDateLine(level_, southern, row, columnFromWest);
  };
  const uint32_t column = columnFromDateLine(*this), columnsAround = 4 * columns();
  if (side == Side::east || side == Side::west) {
    add(isSouthern(), row_, (column + (side == Side::east ? 1 : columnsAround - 1)) % columnsAround);
    return list;
  }
  const bool isPoleward = (side == Side::north) != isSouthern();
  if (isPoleward && isPolar()) return list;
  if (!isPoleward && row_ == 0) {
    add(!isSouthern(), 0, column);
    return list;
  }
  const uint32_t row = isPoleward ? row_ + 1 : row_ - 1;
  const int bits = columnBits(level_, row_), bitsThere = columnBits(level_, row);
  if (bitsThere > bits) {
    add(isSouthern(), row, 2 * column);
    add(isSouthern(), row, 2 * column + 1);
  } else {
    add(isSouthern(), row, column >> (bits - bitsThere));
  }
  return list;
}

std::string TileKey::name() const {
  return fmt::format("L{} octant {} row {} column {}", level(), octant(), row_, column_);
}

}  // namespace eye

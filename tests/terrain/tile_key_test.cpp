#include "terrain/tile_key.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <set>
#include <unordered_set>

#include <catch2/catch.hpp>

namespace eye {
namespace {

// Every cell of a level, by descent from the roots, so that enumeration does not rest on the row and column formulas.
std::vector<TileKey> cellsOfLevel(int level) {
  std::vector<TileKey> cells;
  for (int octant = 0; octant < kOctants; ++octant) cells.push_back(TileKey::octantRoot(octant));
  for (int i = 0; i < level; ++i) {
    std::vector<TileKey> finer;
    for (const TileKey& cell : cells)
      for (const TileKey& child : cell.children()) finer.push_back(child);
    cells = std::move(finer);
  }
  return cells;
}

TileKey randomCell(std::mt19937_64& random, int level) {
  const int octant = static_cast<int>(random() % kOctants);
  // Half of them near a pole, where the columns change.
  const uint32_t rows = uint32_t{1} << level;
  const uint32_t fromPole = static_cast<uint32_t>(random() % (random() % 2 != 0 ? std::min(rows, 64u) : rows));
  const TileKey first = TileKey::fromGrid(level, octant, rows - 1 - fromPole, 0);
  return TileKey::fromGrid(level, octant, first.row(), static_cast<uint32_t>(random() % first.columns()));
}

bool contains(const TileList<2>& list, const TileKey& key) {
  return std::find(list.begin(), list.end(), key) != list.end();
}

Side opposite(Side side) {
  return static_cast<Side>((static_cast<unsigned>(side) + 2) % 4);
}

// The ownership rule of the header, from bounds alone.
bool owns(const TileKey& key, double lat, double lon) {
  const TileBounds b = key.bounds();
  if (lon == 180.0) lon = -180.0;
  const bool inLat = lat >= b.southDeg && (lat < b.northDeg || (lat == 90.0 && b.northDeg == 90.0));
  return inLat && lon >= b.westDeg && lon < b.eastDeg;
}

TEST_CASE("levels have the published numbers of cells") {
  const std::array<uint64_t, 6> kPublished{8, 24, 88, 344, 1368, 5464};
  for (int level = 0; level < 6; ++level) {
    const auto cells = cellsOfLevel(level);
    CHECK(cells.size() == kPublished[static_cast<size_t>(level)]);
    CHECK(tilesInLevel(level) == kPublished[static_cast<size_t>(level)]);
    CHECK(std::set<TileKey>(cells.begin(), cells.end()).size() == cells.size());
    uint64_t byGrid = 0;
    for (int octant = 0; octant < kOctants; ++octant)
      for (uint32_t row = 0; row < uint32_t{1} << level; ++row)
        byGrid += TileKey::fromGrid(level, octant, row, 0).columns();
    CHECK(byGrid == cells.size());
  }
}

TEST_CASE("codes are the paper's: a leading one, the octant, then one digit a level") {
  CHECK(TileKey::octantRoot(0).code() == 0b1'000'100);
  CHECK(TileKey::octantRoot(5).code() == 0b1'101'100);
  CHECK(TileKey::fromGrid(1, 0, 1, 0).code() == 0b1'000'100'010);             // the pole cell: digit 2
  CHECK(TileKey::fromGrid(2, 3, 2, 1).code() == 0b1'011'100'010'001);         // pole cell's second child
  CHECK(TileKey::fromGrid(2, 0, 1, 2).code() == 0b1'000'100'001'010);         // an ordinary cell's third
  CHECK(std::bit_width(TileKey::fromGrid(kMaxLevel, 7, 0, 0).code()) == 64);  // 20 digits fill 64 bits
}

TEST_CASE("a code gives its cell back") {
  std::unordered_set<uint64_t> codes;
  for (int level = 0; level <= 6; ++level) {
    for (const TileKey& cell : cellsOfLevel(level)) {
      const auto back = TileKey::fromCode(cell.code());
      REQUIRE(back);
      REQUIRE(*back == cell);
      REQUIRE(codes.insert(cell.code()).second);
    }
  }
  std::mt19937_64 random(1);
  for (int i = 0; i < 100'000; ++i) {
    const TileKey cell = randomCell(random, static_cast<int>(random() % (kMaxLevel + 1)));
    const auto back = TileKey::fromCode(cell.code());
    REQUIRE(back);
    REQUIRE(*back == cell);
  }
}

TEST_CASE("codes that name no surface cell are refused") {
  for (const uint64_t code : {uint64_t{0}, uint64_t{1}, uint64_t{8}, uint64_t{0b1'000},
                              uint64_t{0b1'000'000},          // outer cell of the octant: above the surface
                              uint64_t{0b1'000'101},          // no such digit
                              uint64_t{0b1'000'100'011},      // a pole cell has no child 3
                              uint64_t{0b1'000'100'100},      // below the surface
                              uint64_t{0b1'000'100'001'110},  // below the surface
                              uint64_t{0b11'000'100}, ~uint64_t{0}}) {
    const auto key = TileKey::fromCode(code);
    CHECK_FALSE(key);
    if (!key) CHECK(key.error().kind == ErrorKind::badData);
  }
}

TEST_CASE("whatever is accepted as a code encodes to the same code") {
  std::mt19937_64 random(2);
  int accepted = 0;
  for (int i = 0; i < 400'000; ++i) {
    uint64_t code = random();
    if (i % 2 == 0) {
      // Near misses: a true code with a few bits flipped, or a digit more or less.
      code = randomCell(random, static_cast<int>(random() % (kMaxLevel + 1))).code();
      code ^= uint64_t{1} << random() % 64;
      if (random() % 4 == 0) code >>= random() % 4;
    }
    code >>= i % 2 == 0 ? 0 : random() % 64;
    const auto key = TileKey::fromCode(code);
    if (!key) continue;
    ++accepted;
    REQUIRE(key->code() == code);
    REQUIRE(key->column() < key->columns());
  }
  CHECK(accepted > 10'000);
}

TEST_CASE("parents and children belong to one another and tile the parent exactly") {
  std::mt19937_64 random(3);
  std::vector<TileKey> parents = cellsOfLevel(0);
  for (int level = 1; level <= 4; ++level)
    for (const TileKey& cell : cellsOfLevel(level)) parents.push_back(cell);
  for (int i = 0; i < 5000; ++i) parents.push_back(randomCell(random, static_cast<int>(random() % kMaxLevel)));

  for (const TileKey& parent : parents) {
    const auto children = parent.children();
    REQUIRE(children.count == (parent.isPolar() ? 3 : 4));
    const TileBounds p = parent.bounds();
    const double midLat = (p.southDeg + p.northDeg) / 2, midLon = (p.westDeg + p.eastDeg) / 2;
    double area = 0;
    for (const TileKey& child : children) {
      REQUIRE(child.parent() == parent);
      const TileBounds c = child.bounds();
      REQUIRE(
          ((c.southDeg == p.southDeg && c.northDeg == midLat) || (c.southDeg == midLat && c.northDeg == p.northDeg)));
      if (child.isPolar()) {
        REQUIRE((c.westDeg == p.westDeg && c.eastDeg == p.eastDeg));
        REQUIRE(parent.isPolar());
      } else {
        REQUIRE(((c.westDeg == p.westDeg && c.eastDeg == midLon) || (c.westDeg == midLon && c.eastDeg == p.eastDeg)));
      }
      area += (c.northDeg - c.southDeg) * (c.eastDeg - c.westDeg);
    }
    REQUIRE(area == (p.northDeg - p.southDeg) * (p.eastDeg - p.westDeg));  // exact: nothing overlaps
  }
  for (int octant = 0; octant < kOctants; ++octant) CHECK_FALSE(TileKey::octantRoot(octant).parent());
}

TEST_CASE("every point is in exactly one cell of a level, the one that owns it") {
  std::vector<LatLon> points;
  for (const double lat : {-90.0, -78.75, -67.5, -45.0, -22.5, -0.0, 0.0, 11.25, 45.0, 67.5, 78.75, 84.375, 90.0,
                           std::nextafter(90.0, 0.0), std::nextafter(-90.0, 0.0), std::nextafter(45.0, 90.0),
                           std::nextafter(-45.0, -90.0), std::nextafter(0.0, -1.0)})
    for (const double lon : {-180.0, -135.0, -90.0, -45.0, -0.0, 0.0, 22.5, 90.0, 135.0, 180.0, 12.3,
                             std::nextafter(180.0, 0.0), std::nextafter(-180.0, 0.0), std::nextafter(90.0, 91.0),
                             std::nextafter(-90.0, -91.0), std::nextafter(0.0, -1.0)})
      points.push_back({lat, lon});
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 300; ++i) points.push_back({90 * unit(random), 180 * unit(random)});

  for (int level = 0; level <= 4; ++level) {
    const auto cells = cellsOfLevel(level);
    for (const LatLon& p : points) {
      CAPTURE(level, p.latDeg, p.lonDeg);
      const TileKey found = TileKey::containing(p.latDeg, p.lonDeg, level);
      int owners = 0;
      for (const TileKey& cell : cells) owners += owns(cell, p.latDeg, p.lonDeg) ? 1 : 0;
      REQUIRE(owners == 1);
      REQUIRE(owns(found, p.latDeg, p.lonDeg));
    }
  }
}

TEST_CASE("containing agrees with bounds at every level, at corners and their neighbouring doubles") {
  std::mt19937_64 random(5);
  for (int i = 0; i < 20'000; ++i) {
    const TileKey cell = randomCell(random, static_cast<int>(random() % (kMaxLevel + 1)));
    const TileBounds b = cell.bounds();
    REQUIRE(TileKey::containing((b.southDeg + b.northDeg) / 2, (b.westDeg + b.eastDeg) / 2, cell.level()) == cell);
    REQUIRE(TileKey::containing(b.southDeg, b.westDeg, cell.level()) == cell);
    const double lastLat = std::nextafter(b.northDeg, -100), lastLon = std::nextafter(b.eastDeg, -200);
    REQUIRE(TileKey::containing(lastLat, lastLon, cell.level()) == cell);
    REQUIRE_FALSE(TileKey::containing(b.southDeg, b.eastDeg, cell.level()) == cell);
    if (cell.level() > 0) REQUIRE(TileKey::containing(lastLat, lastLon, cell.level() - 1) == cell.parent());
  }
  CHECK(TileKey::containing(10, 190, 5) == TileKey::containing(10, -170, 5));
  CHECK(TileKey::containing(10, 180, 5) == TileKey::containing(10, -180, 5));
  CHECK(TileKey::containing(10, -180, 5).bounds().westDeg == -180);
}

// Do the two sides have a common piece of positive length, on the same parallel or meridian?
bool touchAlong(const TileKey& a, Side side, const TileKey& b) {
  const TileBounds p = a.bounds(), q = b.bounds();
  const auto overlap = [](double lo1, double hi1, double lo2, double hi2) {
    return std::min(hi1, hi2) > std::max(lo1, lo2);
  };
  const auto sameMeridian = [](double x, double y) { return x == y || std::abs(x - y) == 360.0; };
  switch (side) {
    case Side::south:
      return p.southDeg == q.northDeg && overlap(p.westDeg, p.eastDeg, q.westDeg, q.eastDeg);
    case Side::north:
      return p.northDeg == q.southDeg && overlap(p.westDeg, p.eastDeg, q.westDeg, q.eastDeg);
    case Side::east:
      return sameMeridian(p.eastDeg, q.westDeg) && p.southDeg == q.southDeg && p.northDeg == q.northDeg;
    case Side::west:
      return sameMeridian(p.westDeg, q.eastDeg) && p.southDeg == q.southDeg && p.northDeg == q.northDeg;
  }
  return false;
}

TEST_CASE("neighbours are all the cells that touch along a side") {
  for (int level = 0; level <= 4; ++level) {
    const auto cells = cellsOfLevel(level);
    for (const TileKey& cell : cells) {
      for (const Side side : kSides) {
        const auto neighbours = cell.neighbours(side);
        int touching = 0;
        for (const TileKey& other : cells) {
          if (!touchAlong(cell, side, other)) continue;
          ++touching;
          REQUIRE(contains(neighbours, other));
        }
        CAPTURE(cell.name(), static_cast<int>(side));
        REQUIRE(neighbours.count == touching);
        const bool isAtPole = cell.isPolar() && side == (cell.isSouthern() ? Side::south : Side::north);
        REQUIRE((neighbours.count == 0) == isAtPole);
      }
    }
  }
}

TEST_CASE("neighbours are mutual and ordered west to east at every level") {
  std::mt19937_64 random(6);
  for (int i = 0; i < 20'000; ++i) {
    const TileKey cell = randomCell(random, static_cast<int>(random() % (kMaxLevel + 1)));
    for (const Side side : kSides) {
      const auto neighbours = cell.neighbours(side);
      for (const TileKey& other : neighbours) {
        REQUIRE(other.level() == cell.level());
        REQUIRE(touchAlong(cell, side, other));
        REQUIRE(contains(other.neighbours(opposite(side)), cell));
      }
      if (neighbours.count == 2) {
        REQUIRE(neighbours.items[0].bounds().eastDeg == neighbours.items[1].bounds().westDeg);
        REQUIRE(neighbours.items[0].bounds().westDeg == cell.bounds().westDeg);
        REQUIRE(neighbours.items[1].bounds().eastDeg == cell.bounds().eastDeg);
      }
    }
  }
}

TEST_CASE("neighbours across the date line, the equator and the zero meridian") {
  const TileKey west = TileKey::containing(10, -179.99, 6);
  REQUIRE(west.neighbours(Side::west).count == 1);
  CHECK(west.neighbours(Side::west).items[0] == TileKey::containing(10, 179.99, 6));
  const TileKey equator = TileKey::containing(0.01, -100, 6);
  CHECK(equator.neighbours(Side::south).items[0] == TileKey::containing(-0.01, -100, 6));
  const TileKey zero = TileKey::containing(52, 0.01, 6);
  CHECK(zero.neighbours(Side::west).items[0] == TileKey::containing(52, -0.01, 6));
}

}  // namespace
}  // namespace eye

#include "truth/height_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <utility>

namespace eye::truth {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kVoidMarginM = 300;  // no void in these data hides more relief than that
constexpr int kTopLevel = 7;         // 128 cells: a step of about 10 km, along which a ray is straight in the grid

using Tile = std::vector<float>;  // south to north, west to east

// SRTM: big-endian 16-bit, north to south, -32768 where nothing was measured. The size gives the number of posts a
// side.
Tile readHgt(const std::filesystem::path& file, int& side) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  side = static_cast<int>(std::lround(std::sqrt(static_cast<double>(bytes.size()) / 2)));
  const auto n = static_cast<size_t>(side);
  Tile tile(n * n);
  for (size_t i = 0; i < n * n; ++i) {
    const auto high = static_cast<uint8_t>(bytes[2 * i]), low = static_cast<uint8_t>(bytes[2 * i + 1]);
    const auto value = static_cast<int16_t>(static_cast<uint16_t>(high << 8 | low));
    tile[(n - 1 - i / n) * n + i % n] = value == -32768 ? kNone : static_cast<float>(value);
  }
  return tile;
}

}  // namespace

HeightGrid::HeightGrid(const GridShape& shape, const std::function<double(double, double)>& heightM)
    : HeightGrid(fromPosts(shape, [&](int row, int column) {
        return heightM(shape.southDeg + row * shape.stepDeg, shape.westDeg + column * shape.stepDeg);
      })) {}

HeightGrid HeightGrid::fromPosts(const GridShape& shape, const std::function<double(int, int)>& heightM) {
  HeightGrid grid;
  grid.shape_ = shape;
  grid.posts_.resize(static_cast<size_t>(shape.rows) * static_cast<size_t>(shape.columns));
  for (int r = 0; r < shape.rows; ++r)
    for (int c = 0; c < shape.columns; ++c) grid.posts_[grid.index(r, c)] = static_cast<float>(heightM(r, c));
  grid.buildPyramid();
  return grid;
}

HeightGrid HeightGrid::fromHgtFolder(const std::string& folder) {
  std::map<std::pair<int, int>, Tile> tiles;  // by the south-west corner, whole degrees
  int side = 0;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder, missing)) {
    int lat = 0, lon = 0;
    if (std::sscanf(entry.path().filename().c_str(), "N%2dE%3d.hgt", &lat, &lon) == 2) {
      tiles[{lat, lon}] = readHgt(entry.path(), side);
    }
  }
  HeightGrid grid;
  if (tiles.empty()) return grid;
  const auto [south, west] = tiles.begin()->first;
  const auto [north, east] = tiles.rbegin()->first;
  const int cells = side - 1;
  grid.shape_ = {double(south), double(west), 1.0 / cells, (north - south + 1) * cells + 1,
                 (east - west + 1) * cells + 1};
  grid.posts_.assign(static_cast<size_t>(grid.shape_.rows) * static_cast<size_t>(grid.shape_.columns), kNone);
  std::vector<uint8_t> seen(grid.posts_.size(), 0);
  for (const auto& [corner, tile] : tiles) {
    for (int r = 0; r < side; ++r) {
      for (int c = 0; c < side; ++c) {
        const float value = tile[static_cast<size_t>(r) * static_cast<size_t>(side) + static_cast<size_t>(c)];
        if (std::isnan(value)) continue;
        const size_t at = grid.index((corner.first - south) * cells + r, (corner.second - west) * cells + c);
        const auto n = static_cast<float>(seen[at]++);
        grid.posts_[at] = n == 0 ? value : (grid.posts_[at] * n + value) / (n + 1);
      }
    }
  }
  grid.buildPyramid();
  return grid;
}

double HeightGrid::heightM(double row, double column) const {
  const int r = std::clamp(static_cast<int>(std::floor(row)), 0, shape_.rows - 2);
  const int c = std::clamp(static_cast<int>(std::floor(column)), 0, shape_.columns - 2);
  const double y = std::clamp(row - r, 0.0, 1.0), x = std::clamp(column - c, 0.0, 1.0);
  const double south = postM(r, c) * (1 - x) + postM(r, c + 1) * x;
  const double north = postM(r + 1, c) * (1 - x) + postM(r + 1, c + 1) * x;
  return south * (1 - y) + north * y;
}

float HeightGrid::highestM(int level, int blockRow, int blockColumn) const {
  const Level& of = pyramid_[static_cast<size_t>(level)];
  return of
      .highestM[static_cast<size_t>(blockRow) * static_cast<size_t>(of.columns) + static_cast<size_t>(blockColumn)];
}

std::vector<float> HeightGrid::postsWithVoidsRaised() const {
  std::vector<float> raised = posts_;
  for (int r = 0; r < shape_.rows; ++r) {
    for (int c = 0; c < shape_.columns; ++c) {
      if (!std::isnan(postM(r, c))) continue;
      float highest = kNone;
      for (int reach = 1; std::isnan(highest) && reach < shape_.rows; reach *= 2) {
        for (int i = std::max(0, r - reach); i <= std::min(shape_.rows - 1, r + reach); ++i) {
          for (int j = std::max(0, c - reach); j <= std::min(shape_.columns - 1, c + reach); ++j) {
            highest = std::fmax(highest, postM(i, j));  // fmax passes over NaN
          }
        }
      }
      raised[index(r, c)] = highest + kVoidMarginM;
    }
  }
  return raised;
}

void HeightGrid::buildPyramid() {
  voids_ = static_cast<int>(std::count_if(posts_.begin(), posts_.end(), [](float v) { return std::isnan(v); }));
  const std::vector<float> posts = postsWithVoidsRaised();
  highestPostM_ = *std::max_element(posts.begin(), posts.end());
  highestBorderPostM_ = posts[0];
  for (int r = 0; r < shape_.rows; ++r) {
    const bool edgeRow = r == 0 || r == shape_.rows - 1;
    for (int c = 0; c < shape_.columns; c += edgeRow ? 1 : shape_.columns - 1) {
      highestBorderPostM_ = std::max(highestBorderPostM_, posts[index(r, c)]);
    }
  }
  // A cell's own four posts and those of the eight cells around it: four posts each way, rows first, then columns.
  Level cells{shape_.rows - 1, shape_.columns - 1, {}};
  const auto width = static_cast<size_t>(cells.columns);
  std::vector<float> alongRow(static_cast<size_t>(shape_.rows) * width);
  for (int r = 0; r < shape_.rows; ++r) {
    for (int c = 0; c < cells.columns; ++c) {
      float highest = posts[index(r, c)];
      for (int j = std::max(0, c - 1); j <= std::min(shape_.columns - 1, c + 2); ++j) {
        highest = std::max(highest, posts[index(r, j)]);
      }
      alongRow[static_cast<size_t>(r) * width + static_cast<size_t>(c)] = highest;
    }
  }
  cells.highestM.resize(static_cast<size_t>(cells.rows) * width);
  for (int r = 0; r < cells.rows; ++r) {
    for (size_t c = 0; c < width; ++c) {
      float highest = alongRow[static_cast<size_t>(r) * width + c];
      for (int i = std::max(0, r - 1); i <= std::min(shape_.rows - 1, r + 2); ++i) {
        highest = std::max(highest, alongRow[static_cast<size_t>(i) * width + c]);
      }
      cells.highestM[static_cast<size_t>(r) * width + c] = highest;
    }
  }
  pyramid_.push_back(std::move(cells));
  for (int level = 1; level <= kTopLevel; ++level) {
    const Level& finer = pyramid_.back();
    Level coarser{(finer.rows + 1) / 2, (finer.columns + 1) / 2, {}};
    coarser.highestM.assign(static_cast<size_t>(coarser.rows) * static_cast<size_t>(coarser.columns),
                            std::numeric_limits<float>::lowest());
    for (int r = 0; r < finer.rows; ++r) {
      for (int c = 0; c < finer.columns; ++c) {
        float& highest = coarser.highestM[static_cast<size_t>(r / 2) * static_cast<size_t>(coarser.columns) +
                                          static_cast<size_t>(c / 2)];
        highest = std::max(
            highest,
            finer.highestM[static_cast<size_t>(r) * static_cast<size_t>(finer.columns) + static_cast<size_t>(c)]);
      }
    }
    pyramid_.push_back(std::move(coarser));
  }
}

}  // namespace eye::truth

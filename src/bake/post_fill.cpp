#include "bake/post_fill.h"

#include <gdal_alg.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "raster/encode.h"

namespace eye {

namespace {

constexpr float kUnfilled = -99999;  // far below any height
// Around a void, so many posts are looked at beside it; the nearest ones that bear on it are right at its edge.
constexpr int kFillMargin = 16;

struct Box {
  int south, north, west, east;  // inclusive
};

// Takes the void that holds a post out of `open`, and says which posts it has.
Box takeVoid(const PostWindow& window, size_t start, std::vector<uint8_t>& open, std::vector<size_t>& posts) {
  const auto columns = static_cast<size_t>(window.columns);
  posts.assign(1, start);
  open[start] = 0;
  Box box{window.rows, 0, window.columns, 0};
  for (size_t next = 0; next < posts.size(); ++next) {
    const size_t post = posts[next];
    const auto row = static_cast<int>(post / columns), column = static_cast<int>(post % columns);
    box = {std::min(box.south, row), std::max(box.north, row), std::min(box.west, column), std::max(box.east, column)};
    const auto visit = [&](bool within, size_t neighbour) {
      if (!within || !open[neighbour]) return;
      open[neighbour] = 0;
      posts.push_back(neighbour);
    };
    visit(row > 0, post - columns);
    visit(row + 1 < window.rows, post + columns);
    visit(column > 0, post - 1);
    visit(column + 1 < window.columns, post + 1);
  }
  return box;
}

Result<void> fillVoid(PostWindow& window, const Box& tight, const std::vector<size_t>& posts) {
  const Box box{std::max(tight.south - kFillMargin, 0), std::min(tight.north + kFillMargin, window.rows - 1),
                std::max(tight.west - kFillMargin, 0), std::min(tight.east + kFillMargin, window.columns - 1)};
  PostWindow part{box.north - box.south + 1, box.east - box.west + 1, {}};
  std::vector<uint8_t> valid;
  for (int row = box.south; row <= box.north; ++row) {
    for (int column = box.west; column <= box.east; ++column) {
      const float height = window.heightM[window.index(row, column)];
      valid.push_back(!std::isnan(height));
      part.heightM.push_back(std::isnan(height) ? kUnfilled : height);
    }
  }
  const Dataset heights = wrapPixels(part.heightM.data(), part.columns, part.rows, 1, GDT_Float32, 4, 4);
  const Dataset mask = wrapPixels(valid.data(), part.columns, part.rows, 1, GDT_Byte, 1, 1);
  if (!heights || !mask) return fail(ErrorKind::io, "out of memory while filling voids; lower --jobs");
  GdalMessages messages;
  const char* const options[] = {"TEMP_FILE_DRIVER=MEM", "NODATA=-99999", nullptr};
  if (GDALFillNodata(GDALRasterBand::ToHandle(heights->GetRasterBand(1)),
                     GDALRasterBand::ToHandle(mask->GetRasterBand(1)), kFillPosts, 0, 0, const_cast<char**>(options),
                     nullptr, nullptr) != CE_None) {
    return fail(ErrorKind::io, "cannot fill voids: " + messages.failure());
  }
  heights->FlushCache();
  for (const size_t post : posts) {
    const auto columns = static_cast<size_t>(window.columns);
    const auto row = static_cast<int>(post / columns), column = static_cast<int>(post % columns);
    const float height = part.heightM[part.index(row - box.south, column - box.west)];
    if (height != kUnfilled) window.heightM[post] = height;
  }
  return {};
}

}  // namespace

Result<void> interpolateVoids(PostWindow& window, std::vector<uint8_t> isVoid) {
  std::vector<std::pair<Box, std::vector<size_t>>> voids;
  std::vector<size_t> posts;
  for (size_t i = 0; i < isVoid.size(); ++i) {
    if (!isVoid[i]) continue;
    const Box box = takeVoid(window, i, isVoid, posts);
    voids.emplace_back(box, posts);
  }
  // From the posts as they were: one void is not filled from another's filling.
  PostWindow filled = window;
  for (const auto& [box, held] : voids) {
    if (auto done = fillVoid(window, box, held); !done) return done;
    for (const size_t post : held) std::swap(filled.heightM[post], window.heightM[post]);
  }
  window = std::move(filled);
  return {};
}

Fade fadeAround(const PostWindow& window) {
  const int rows = window.rows, columns = window.columns;
  // Columns to the nearest valid post of the same row, up to the fade's width; the window's own sign tells the side.
  constexpr int16_t kFar = kFadePosts + 1;
  std::vector<int16_t> inRow(window.heightM.size(), kFar);
  for (int row = 0; row < rows; ++row) {
    int last = -kFar;
    for (int column = 0; column < columns; ++column) {
      if (!std::isnan(window.heightM[window.index(row, column)])) last = column;
      if (column - last < kFar) inRow[window.index(row, column)] = static_cast<int16_t>(last - column);
    }
    last = columns + kFar;
    for (int column = columns - 1; column >= 0; --column) {
      if (!std::isnan(window.heightM[window.index(row, column)])) last = column;
      int16_t& nearest = inRow[window.index(row, column)];
      if (last - column < std::abs(nearest)) nearest = static_cast<int16_t>(last - column);
    }
  }
  Fade fade{std::vector<int32_t>(inRow.size(), -1), std::vector<float>(inRow.size(), 0.0f)};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const size_t i = window.index(row, column);
      if (inRow[i] == 0) {
        fade.nearest[i] = static_cast<int32_t>(i);
        fade.weight[i] = 1;
        continue;
      }
      int best = kFadePosts * kFadePosts;
      for (int dy = -kFadePosts + 1; dy < kFadePosts; ++dy) {
        if (row + dy < 0 || row + dy >= rows) continue;
        const int dx = inRow[window.index(row + dy, column)];
        if (std::abs(dx) == kFar || dx * dx + dy * dy >= best) continue;
        best = dx * dx + dy * dy;
        fade.nearest[i] = static_cast<int32_t>(window.index(row + dy, column + dx));
      }
      if (fade.nearest[i] < 0) continue;
      const double share = std::sqrt(double(best)) / kFadePosts;
      fade.weight[i] = static_cast<float>(1 - share * share * (3 - 2 * share));
    }
  }
  return fade;
}

}  // namespace eye

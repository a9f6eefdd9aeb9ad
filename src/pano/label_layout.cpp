#include "pano/label_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace eye {
namespace {

// Readable without turning one's head, and near enough to upright for names every 1.2 text heights. Upright at the
// right edge, where a slanting name would run out of the picture.
constexpr std::array kSlopesRad{std::numbers::pi * 55 / 180, std::numbers::pi / 2};
constexpr int kShelves = 8;            // heights over the skyline that are tried
constexpr double kShelfHeights = 1.5;  // apart, in text heights
constexpr double kGapHeights = 0.8;    // between skyline and text

struct Taken {
  std::vector<glm::dvec2> corners;
  double left = 0, right = 0;
  bool isLine = false;
};

Taken takenBy(std::span<const glm::dvec2> corners, bool isLine) {
  const auto [least, most] = std::ranges::minmax_element(corners, {}, [](const glm::dvec2& p) { return p.x; });
  return {{corners.begin(), corners.end()}, least->x, most->x, isLine};
}

// The lowest foot at which the baseline clears the skyline all along.
double footOver(const LabelSpace& space, const LabelWish& wish, double slopeRad) {
  const double across = wish.lengthPx * std::cos(slopeRad), gap = kGapHeights * space.textHeightPx;
  const int first = std::max(0, static_cast<int>(wish.x - space.textHeightPx));
  const int last = std::min(space.widthPx - 1, static_cast<int>(wish.x + across));
  double foot = wish.y - gap;
  for (int column = first; column <= last; ++column) {
    const double along = std::max(0.0, column - wish.x);
    foot = std::min(foot, space.skylineRows[static_cast<size_t>(column)] - gap + along * std::tan(slopeRad));
  }
  return foot;
}

bool isInside(const LabelSpace& space, const LabelBox& box) {
  return std::ranges::all_of(
      box, [&](const glm::dvec2& p) { return p.x >= 0 && p.x < space.widthPx && p.y >= 0 && p.y < space.heightPx; });
}

// Gap between the projections of two convex shapes on any of a's sides' normals.
bool separatedBy(std::span<const glm::dvec2> a, std::span<const glm::dvec2> b) {
  for (size_t i = 0; i < a.size(); ++i) {
    const glm::dvec2 side = a[(i + 1) % a.size()] - a[i], normal(-side.y, side.x);
    const auto along = [&](const glm::dvec2& p) { return glm::dot(p, normal); };
    const auto [aLeast, aMost] = std::ranges::minmax(a, {}, along);
    const auto [bLeast, bMost] = std::ranges::minmax(b, {}, along);
    if (along(aMost) <= along(bLeast) || along(bMost) <= along(aLeast)) return true;
  }
  return false;
}

}  // namespace

LabelBox labelBox(const LabelWish& wish, const PlacedLabel& label, double textHeightPx) {
  const glm::dvec2 along(std::cos(label.slopeRad), -std::sin(label.slopeRad)), up(along.y, -along.x);
  // Letters reach a quarter under the baseline.
  const glm::dvec2 low = label.foot - up * (0.25 * textHeightPx), high = label.foot + up * (0.75 * textHeightPx);
  return {low, low + along * wish.lengthPx, high + along * wish.lengthPx, high};
}

bool overlap(std::span<const glm::dvec2> convexA, std::span<const glm::dvec2> convexB) {
  return !separatedBy(convexA, convexB) && !separatedBy(convexB, convexA);
}

std::vector<PlacedLabel> placeLabels(const LabelSpace& space, std::span<const LabelWish> wishes) {
  std::vector<size_t> order(wishes.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, std::greater<>(), [&](size_t i) { return wishes[i].importance; });
  std::vector<Taken> taken;
  for (const glm::dvec4& r : space.taken) {
    const std::array<glm::dvec2, 4> corners{{{r.x, r.y}, {r.z, r.y}, {r.z, r.w}, {r.x, r.w}}};
    taken.push_back(takenBy(corners, false));
  }
  // Texts keep clear of texts and of lines; two lines may cross no text, and stand a text's height apart.
  const auto isFree = [&](const Taken& wanted) {
    return std::ranges::none_of(taken, [&](const Taken& other) {
      if (wanted.right <= other.left || other.right <= wanted.left) return false;
      return !(wanted.isLine && other.isLine) && overlap(wanted.corners, other.corners);
    });
  };

  std::vector<PlacedLabel> placed;
  const auto place = [&](size_t index, double slopeRad) {
    const LabelWish& wish = wishes[index];
    const double lowest = footOver(space, wish, slopeRad);
    for (int shelf = 0; shelf < kShelves; ++shelf) {
      const PlacedLabel label{index, {wish.x, lowest - shelf * kShelfHeights * space.textHeightPx}, slopeRad};
      const LabelBox box = labelBox(wish, label, space.textHeightPx);
      if (!isInside(space, box)) return false;
      const std::array<glm::dvec2, 4> line{
          {{wish.x - 1, wish.y}, {wish.x + 1, wish.y}, {wish.x + 1, label.foot.y}, {wish.x - 1, label.foot.y}}};
      const Taken text = takenBy(box, false), leader = takenBy(line, true);
      if (!isFree(text) || !isFree(leader)) continue;
      taken.push_back(text);
      taken.push_back(leader);
      placed.push_back(label);
      return true;
    }
    return false;
  };
  for (const size_t index : order)
    (void)std::ranges::any_of(kSlopesRad, [&](double slopeRad) { return place(index, slopeRad); });
  return placed;
}

}  // namespace eye

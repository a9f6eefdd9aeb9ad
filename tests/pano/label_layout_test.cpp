#include <random>

#include <catch2/catch.hpp>

#include "pano/label_layout.h"

namespace eye {
namespace {

constexpr int kWidthPx = 4096, kHeightPx = 500;
constexpr double kTextPx = 12;

std::vector<int> hills() {
  std::vector<int> rows;
  for (int column = 0; column < kWidthPx; ++column)
    rows.push_back(260 + static_cast<int>(30 * std::sin(column * 0.01) + 8 * std::sin(column * 0.13)));
  return rows;
}

std::vector<LabelWish> randomWishes(const std::vector<int>& skyline, int count) {
  std::mt19937 chance(3);
  std::vector<LabelWish> wishes;
  for (int i = 0; i < count; ++i) {
    const double x = std::uniform_real_distribution(0.0, double(kWidthPx))(chance);
    const double y = skyline[static_cast<size_t>(x)] + std::uniform_real_distribution(0.0, 150.0)(chance);
    wishes.push_back({x, y, std::uniform_real_distribution(40.0, 200.0)(chance),
                      std::uniform_real_distribution(0.0, 4000.0)(chance)});
  }
  return wishes;
}

// Whether a point lies within the text's rectangle: by its own frame, not by separating axes.
bool holds(const LabelWish& wish, const PlacedLabel& label, glm::dvec2 p, double shrinkPx) {
  const glm::dvec2 d = p - label.foot;
  const double along = d.x * std::cos(label.slopeRad) - d.y * std::sin(label.slopeRad);
  const double up = -d.x * std::sin(label.slopeRad) - d.y * std::cos(label.slopeRad);
  return along > shrinkPx && along < wish.lengthPx - shrinkPx && up > -0.25 * kTextPx + shrinkPx &&
         up < 0.75 * kTextPx - shrinkPx;
}

}  // namespace

TEST_CASE("Labels: no text over another, over a line, over the ground or out of the picture") {
  const std::vector<int> skyline = hills();
  const std::vector<LabelWish> wishes = randomWishes(skyline, 400);
  const std::array taken{glm::dvec4(0, 0, 300, 200)};
  const auto labels = placeLabels({kWidthPx, kHeightPx, kTextPx, skyline, taken}, wishes);
  CHECK(labels.size() > 60);
  CHECK(labels.size() < 400);
  int wrong = 0;
  for (const PlacedLabel& label : labels) {
    const LabelWish& wish = wishes[label.wish];
    CHECK(label.foot.x == wish.x);
    const glm::dvec2 along(std::cos(label.slopeRad), -std::sin(label.slopeRad)), up(along.y, -along.x);
    for (double a = 0; a <= wish.lengthPx; a += 1) {
      for (double u = -0.25; u <= 0.75; u += 0.125) {
        const glm::dvec2 p = label.foot + along * a + up * (u * kTextPx);
        wrong += p.x < 0 || p.x >= kWidthPx || p.y < 0;
        if (p.x < 0 || p.x >= kWidthPx) continue;
        wrong += p.y > skyline[static_cast<size_t>(p.x)];
        wrong += p.x < 299 && p.y < 199;
        for (const PlacedLabel& other : labels) wrong += &other != &label && holds(wishes[other.wish], other, p, 0.01);
      }
    }
    for (double y = label.foot.y; y < wish.y; y += 1)
      for (const PlacedLabel& other : labels)
        wrong += &other != &label && holds(wishes[other.wish], other, {wish.x, y}, 0.01);
  }
  CHECK(wrong == 0);
}

TEST_CASE("Labels: the more important one of two gets the room") {
  const std::vector<int> skyline(1000, 60);  // room for one shelf alone
  std::vector<LabelWish> wishes{{500, 70, 50, 1}, {503, 70, 50, 2}};
  const auto labels = placeLabels({1000, 100, kTextPx, skyline, {}}, wishes);
  REQUIRE(labels.size() == 1);
  CHECK(labels[0].wish == 1);
  wishes[0].importance = 3;
  CHECK(placeLabels({1000, 100, kTextPx, skyline, {}}, wishes)[0].wish == 0);
}

TEST_CASE("Labels: upright at the right edge, none where the ground fills the picture") {
  std::vector<int> skyline(1000, 200);
  const std::vector<LabelWish> wishes{{985, 200, 100, 1}};
  const auto labels = placeLabels({1000, 300, kTextPx, skyline, {}}, wishes);
  REQUIRE(labels.size() == 1);
  CHECK(labels[0].slopeRad == Approx(1.5707963));
  std::ranges::fill(skyline, 0);
  CHECK(placeLabels({1000, 300, kTextPx, skyline, {}}, wishes).empty());
}

}  // namespace eye

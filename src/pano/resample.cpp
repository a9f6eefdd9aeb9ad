#include "pano/resample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <thread>

#include "pano/planar_depth.h"
#include "pano/views.h"

namespace eye {
namespace {

// Neighbours whose depths differ by more than this share are of two hillsides. On one, four of them differ by more only
// where it is seen at less than a twentieth of a degree.
constexpr double kSameSurface = 1.02;

// What all pixels of a column share.
struct ColumnRay {
  double tanRight = 0;     // of the ray in the view
  double cosTurn = 1;      // of the angle between the azimuth and the view's axis
  double refractPerM = 0;  // fall of the bent ray, times the square of the level distance on the drawn scene
};

struct RowRay {
  double sin = 0, cos = 1, tan = 0;  // of the elevation
};

class Sampler {
 public:
  Sampler(const View& view, std::span<const uint8_t> rgba, std::span<const float> depth)
      : view_(view),
        rgba_(rgba),
        depth_(depth),
        perTanX_(view.widthPx / (view.frustum.tanRight - view.frustum.tanLeft)),
        perTanY_(view.heightPx / (view.frustum.tanTop - view.frustum.tanBottom)) {}

  // Places the sampler on a ray of the view, z = 1.
  void at(double tanRight, double tanUp) {
    const double x = (tanRight - view_.frustum.tanLeft) * perTanX_ - 0.5;
    const double y = (view_.frustum.tanTop - tanUp) * perTanY_ - 0.5;
    const int column = std::clamp(static_cast<int>(x), 0, view_.widthPx - 2);
    const int row = std::clamp(static_cast<int>(y), 0, view_.heightPx - 2);
    x_ = x - column, y_ = y - row;
    first_ = static_cast<size_t>(row) * static_cast<size_t>(view_.widthPx) + static_cast<size_t>(column);
    below_ = first_ + static_cast<size_t>(view_.widthPx);
  }

  std::array<uint8_t, 3> colour() const {
    std::array<uint8_t, 3> mixed{};
    const auto u = static_cast<unsigned>(x_ * 256), v = static_cast<unsigned>(y_ * 256);
    for (size_t c = 0; c < 3; ++c) {
      const unsigned above = rgba_[first_ * 4 + c] * (256 - u) + rgba_[first_ * 4 + 4 + c] * u;
      const unsigned under = rgba_[below_ * 4 + c] * (256 - u) + rgba_[below_ * 4 + 4 + c] * u;
      mixed[c] = static_cast<uint8_t>((above * (256 - v) + under * v + 32768) >> 16);
    }
    return mixed;
  }

  // Metres along the view's axis; 0: sky.
  double depthM() const {
    const float a = depth_[first_], b = depth_[first_ + 1], c = depth_[below_], d = depth_[below_ + 1];
    const auto [least, most] = std::minmax({a, b, c, d});
    if (least > 0 && most <= least * kSameSurface) {
      const double above = a + (b - a) * x_, under = c + (d - c) * x_;
      return view_.frustum.nearM / (above + (under - above) * y_);
    }
    return nearestDepthM();
  }
  double nearestDepthM() const {
    const double nearest = depth_[(y_ < 0.5 ? first_ : below_) + (x_ < 0.5 ? 0 : 1)];
    return nearest > 0 ? view_.frustum.nearM / nearest : 0;
  }

 private:
  const View& view_;
  std::span<const uint8_t> rgba_;
  std::span<const float> depth_;
  double perTanX_, perTanY_;
  size_t first_ = 0, below_ = 0;
  double x_ = 0, y_ = 0;
};

double distanceM(const Sampler& sampler, const ColumnRay& column, const RowRay& row) {
  const double depthM = sampler.depthM();
  if (depthM <= 0) return std::numeric_limits<double>::quiet_NaN();
  const double levelM = depthM / column.cosTurn;
  const double upM = levelM * row.tan - column.refractPerM * levelM * levelM;
  return std::sqrt(levelM * levelM + upM * upM);
}

double paperDistanceM(const Sampler& sampler) {
  constexpr PaperBuffer kBuffer;
  const double depthM = sampler.nearestDepthM();
  if (depthM <= 0) return std::numeric_limits<double>::quiet_NaN();
  return paperDepthM(kBuffer, paperBufferValue(kBuffer, depthM));
}

ColumnRay columnRay(const PanoramaFrame& frame, const SceneBend& bend, int index, int column) {
  const double azimuthDeg = frame.azimuthDeg(column + 0.5);
  const double turnRad = radFromDeg(azimuthDeg - viewHeadingDeg(index));
  const double east = std::sin(radFromDeg(azimuthDeg)) / (1 + bend.stretchEast),
               north = std::cos(radFromDeg(azimuthDeg)) / (1 + bend.stretchNorth);
  return {std::tan(turnRad), std::cos(turnRad),
          bend.refractEastPerM * east * east + bend.refractNorthPerM * north * north};
}

}  // namespace

void resample(const View& view, int index, std::span<const uint8_t> rgba, std::span<const float> depth,
              const SceneBend& bend, Panorama& panorama) {
  const PanoramaFrame& frame = panorama.frame;
  const auto firstOf = [&](int i) { return static_cast<int>(std::ceil(i * frame.widthPx / double(kViews) - 0.5)); };
  const int first = firstOf(index), last = firstOf(index + 1);
  std::vector<ColumnRay> columns;
  for (int column = first; column < last; ++column) columns.push_back(columnRay(frame, bend, index, column));

  const auto fillRows = [&](int begin, int step) {
    Sampler sampler(view, rgba, depth);
    for (int row = begin; row < frame.heightPx; row += step) {
      const double elevationRad = radFromDeg(frame.elevationDeg(row + 0.5));
      const RowRay rowRay{std::sin(elevationRad), std::cos(elevationRad), std::tan(elevationRad)};
      for (int column = first; column < last; ++column) {
        const ColumnRay& columnRay = columns[static_cast<size_t>(column - first)];
        sampler.at(columnRay.tanRight, rowRay.tan / columnRay.cosTurn);
        const size_t pixel = frame.at(column, row);
        const std::array<uint8_t, 3> colour = sampler.colour();
        std::copy(colour.begin(), colour.end(), &panorama.rgba[pixel * 4]);
        panorama.rgba[pixel * 4 + 3] = 255;
        panorama.distanceM[pixel] = static_cast<float>(distanceM(sampler, columnRay, rowRay));
        if (!panorama.planarM.empty()) panorama.planarM[pixel] = static_cast<float>(paperDistanceM(sampler));
      }
    }
  };
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::vector<std::jthread> workers;
  for (int i = 1; i < threads; ++i) workers.emplace_back(fillRows, i, threads);
  fillRows(0, threads);
}

}  // namespace eye

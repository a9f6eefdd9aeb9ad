#include "bake/tile_painter.h"

#include <algorithm>
#include <cmath>

#include "bake/ground_noise.h"
#include "bake/palette.h"
#include "geo/frames.h"

namespace eye {

namespace {

constexpr double kMetresPerDegree = 111195;  // of latitude, on the sphere of the Earth's mean radius

struct Stencil {
  double latStepDeg = 0, lonStepDeg = 0, stepM = 0;
};

// Over what slope and curvature are taken: a post where posts are coarser than the texels, else the texel.
Stencil stencilAt(const LatLon& point, double stepDeg) {
  const double shrink = std::max(std::cos(radFromDeg(point.latDeg)), 0.02);
  return {stepDeg, std::min(stepDeg / shrink, 45.0), stepDeg * kMetresPerDegree};
}

double wrapped(double lonDeg) {
  return lonDeg >= 180 ? lonDeg - 360 : lonDeg < -180 ? lonDeg + 360 : lonDeg;
}

void appendStencil(const LatLon& point, const Stencil& stencil, std::vector<LatLon>& points) {
  const double north = std::min(point.latDeg + stencil.latStepDeg, 90.0);
  const double south = std::max(point.latDeg - stencil.latStepDeg, -90.0);
  points.push_back(point);
  points.push_back({north, point.lonDeg});
  points.push_back({south, point.lonDeg});
  points.push_back({point.latDeg, wrapped(point.lonDeg + stencil.lonStepDeg)});
  points.push_back({point.latDeg, wrapped(point.lonDeg - stencil.lonStepDeg)});
}

// `h`: centre, north, south, east, west.
GroundSample groundFrom(const LatLon& point, const Stencil& stencil, const double* h) {
  GroundSample ground;
  ground.heightM = h[0];
  ground.slope = std::hypot(h[1] - h[2], h[3] - h[4]) / (2 * stencil.stepM);
  ground.curvature = (h[0] - (h[1] + h[2] + h[3] + h[4]) / 4) / stencil.stepM;
  ground.latDeg = point.latDeg;
  return ground;
}

}  // namespace

double texelDeg(int level, int textureSize) {
  return 90 / std::exp2(level) / (textureSize - 1);
}
double texelM(int level, int textureSize) {
  return texelDeg(level, textureSize) * kMetresPerDegree;
}

Result<std::vector<uint8_t>> paintTile(const TileKey& key, int size, const ElevationSurface& surface,
                                       const ImageryMosaic* imagery) {
  const TileBounds bounds = key.bounds();
  const double latDeg = texelDeg(key.level(), size);
  const auto texels = static_cast<size_t>(size) * static_cast<size_t>(size);
  const auto pointOf = [&](double i, double j) {
    const auto place = [&](double k) { return std::clamp(k / (size - 1), 0.0, 1.0); };
    LatLon point = latLonFromParam(key, {place(i), place(j)});
    // A pole cell's parameters reach beyond its equator side: the corner is the same on its neighbour's picture.
    point.latDeg = std::clamp(point.latDeg, bounds.southDeg, bounds.northDeg);
    return point;
  };
  std::vector<LatLon> centres(texels);
  for (size_t t = 0; t < texels; ++t) {
    centres[t] =
        pointOf(static_cast<double>(t % static_cast<size_t>(size)), static_cast<double>(t / static_cast<size_t>(size)));
  }

  std::vector<glm::vec4> colours(texels, glm::vec4(0));
  if (imagery != nullptr) {
    const double lonDeg = (bounds.eastDeg - bounds.westDeg) / (size - 1);
    Result<std::vector<glm::vec4>> sampled = imagery->sample(bounds, latDeg, lonDeg, centres);
    if (!sampled) return tl::unexpected(sampled.error());
    colours = std::move(*sampled);
  }

  // Texels that span several posts are the mean of a few places in them, so that coarse levels do not sparkle.
  const double spacingDeg = surface.finestSpacingDeg(bounds);
  const int across = spacingDeg > 0 && latDeg > 2 * spacingDeg ? 3 : spacingDeg > 0 && latDeg > spacingDeg ? 2 : 1;
  const double stepDeg = std::max(spacingDeg, latDeg / across / 2);
  std::vector<LatLon> points;
  std::vector<double> heightsM;
  std::vector<uint8_t> rgb(texels * 3);
  for (int j = 0; j < size; ++j) {
    points.clear();
    for (int i = 0; i < size; ++i) {
      for (int sub = 0; sub < across * across; ++sub) {
        const double di = (sub % across + 0.5) / across - 0.5, dj = (sub / across + 0.5) / across - 0.5;
        const LatLon point = pointOf(i + di, j + dj);
        appendStencil(point, stencilAt(point, stepDeg), points);
      }
    }
    surface.heightsM(points, heightsM);
    for (int i = 0; i < size; ++i) {
      const size_t t = static_cast<size_t>(j) * static_cast<size_t>(size) + static_cast<size_t>(i);
      glm::vec3 colour(colours[t]);
      if (colours[t].a < 0.999f) {
        const glm::dvec3 ecefM = ecefFromGeodetic({centres[t].latDeg, centres[t].lonDeg, 0});
        const double sizeM = latDeg * kMetresPerDegree;
        const float broad = groundNoise(ecefM, 6400, 800, 0.6, sizeM, 1);
        const float grain = groundNoise(ecefM, 320, 40, 0.8, sizeM, 11);
        glm::vec3 sum(0);
        for (int sub = 0; sub < across * across; ++sub) {
          const size_t first =
              (static_cast<size_t>(i) * static_cast<size_t>(across * across) + static_cast<size_t>(sub)) * 5;
          GroundSample ground = groundFrom(points[first], stencilAt(points[first], stepDeg), &heightsM[first]);
          ground.broadNoise = broad;
          ground.grainNoise = grain;
          sum += groundColour(ground);
        }
        const glm::vec3 palette = sum * (255.0f / static_cast<float>(across * across));
        colour = colour * colours[t].a + palette * (1 - colours[t].a);
      }
      for (int c = 0; c < 3; ++c) {
        rgb[t * 3 + static_cast<size_t>(c)] = static_cast<uint8_t>(std::clamp(colour[c] + 0.5f, 0.0f, 255.0f));
      }
    }
  }
  return rgb;
}

}  // namespace eye

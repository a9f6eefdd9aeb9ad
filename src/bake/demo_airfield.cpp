#include "bake/demo_airfield.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/glm.hpp>

#include "bake/ground_noise.h"
#include "geo/demo_site.h"
#include "geo/frames.h"
#include "raster/geo_writer.h"

namespace eye {

namespace {

constexpr double kMetresPerDegree = 111195;
constexpr double kPixelM = 2;

const glm::vec3 kGrass(112, 128, 72), kAsphalt(70, 70, 72), kConcrete(148, 146, 140), kPaint(236, 236, 230);

bool inside(double x, double from, double to) {
  return x >= from && x <= to;
}

// Markings as ICAO Annex 14 has them on a runway 60 m wide, lines no thinner than a pixel. `along` is metres from the
// nearer end, `across` from the centreline.
bool isPainted(double along, double across) {
  const double side = std::abs(across);
  const double half = kDemoRunwayWidthM / 2;
  if (inside(side, half - 3, half - 1)) return true;                                               // edges
  if (inside(along, 6, 36)) return side > 2 && side < half - 4 && std::fmod(side - 2, 3.6) < 1.8;  // threshold
  if (inside(along, 60, 78) && side > 3 && side < 12) return true;                                 // the number's place
  if (along > 100 && side <= 1 && std::fmod(along - 100, 50) < 30) return true;                    // centreline
  if (inside(along, 400, 460) && inside(side, 9, 18)) return true;                                 // aiming point
  for (const double zone : {150.0, 300.0, 600.0, 750.0}) {                                         // touchdown zone
    if (inside(along, zone, zone + 22.5) && inside(side, 9, 18) && std::fmod(side - 9, 4.5) < 3) return true;
  }
  return false;
}

glm::vec3 airfieldColour(double eastM, double northM, float grain) {
  const double half = kDemoRunwayLengthM / 2;
  const double along = half - std::abs(eastM);
  const float light = 1 + 0.06f * grain;
  if (along >= 0 && std::abs(northM) <= kDemoRunwayWidthM / 2) {
    if (isPainted(along, northM)) return kPaint;
    // Rubber where wheels touch down.
    const double rubber = std::exp(-std::pow((along - 420) / 180, 2) - std::pow(northM / 9, 2));
    return kAsphalt * light * static_cast<float>(1 - 0.35 * rubber);
  }
  if (along >= -60 && std::abs(northM) <= kDemoRunwayWidthM / 2 + 7.5) return kAsphalt * light * 1.12f;  // shoulders
  const double taxiNorthM = 190;
  if (along >= 0 && std::abs(northM - taxiNorthM) <= 12) {
    return std::abs(northM - taxiNorthM) <= 1 ? glm::vec3(196, 168, 60) : kAsphalt * light * 1.05f;
  }
  for (const double at : {12.0, 750.0, half}) {  // links between the two
    if (std::abs(along - at) <= 12 && northM > 0 && northM < taxiNorthM) return kAsphalt * light * 1.05f;
  }
  if (std::abs(eastM) < 320 && inside(northM, taxiNorthM, taxiNorthM + 130)) {
    const bool joint = std::fmod(std::abs(eastM), 20) < 1.5 || std::fmod(northM, 20) < 1.5;
    return kConcrete * light * (joint ? 0.93f : 1.0f);
  }
  return kGrass * (1 + 0.1f * grain);
}

}  // namespace

Result<void> writeDemoAirfield(const std::string& path) {
  const double halfEastM = kDemoRunwayLengthM / 2 + 400, halfNorthM = 480;
  const double lonDegPerM = 1 / (kMetresPerDegree * std::cos(radFromDeg(kDemoRunwayLatDeg)));
  GeoGrid grid;
  grid.rows = static_cast<int>(2 * halfNorthM / kPixelM);
  grid.columns = static_cast<int>(2 * halfEastM / kPixelM);
  grid.latStepDeg = kPixelM / kMetresPerDegree;
  grid.lonStepDeg = kPixelM * lonDegPerM;
  grid.southDeg = kDemoRunwayLatDeg - (grid.rows - 1) * grid.latStepDeg / 2;
  grid.westDeg = kDemoRunwayLonDeg - (grid.columns - 1) * grid.lonStepDeg / 2;
  std::vector<uint8_t> rgba;
  rgba.reserve(static_cast<size_t>(grid.rows) * static_cast<size_t>(grid.columns) * 4);
  for (int row = 0; row < grid.rows; ++row) {
    const double northM = ((grid.rows - 1) / 2.0 - row) * kPixelM;
    for (int column = 0; column < grid.columns; ++column) {
      const double eastM = (column - (grid.columns - 1) / 2.0) * kPixelM;
      const float grain = groundNoise({eastM, northM, 0}, 64, 4, 0.75, kPixelM, 7) * 0.6f;
      const glm::vec3 colour = glm::clamp(airfieldColour(eastM, northM, grain), 0.0f, 255.0f);
      const double toEdgeM = std::min(halfEastM - std::abs(eastM), halfNorthM - std::abs(northM));
      const double opacity = std::clamp((toEdgeM + 40 * static_cast<double>(grain)) / 120, 0.0, 1.0);
      for (int c = 0; c < 3; ++c) rgba.push_back(static_cast<uint8_t>(colour[c]));
      rgba.push_back(static_cast<uint8_t>(255 * opacity));
    }
  }
  return writeImagery(path, grid, rgba);
}

}  // namespace eye

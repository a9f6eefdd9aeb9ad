#include "bake/demo_terrain.h"

#include <algorithm>
#include <cmath>

#include "bake/demo_airfield.h"
#include "bake/demo_relief.h"
#include "bake/ground_noise.h"
#include "geo/demo_site.h"
#include "geo/frames.h"
#include "raster/geo_writer.h"

namespace eye {

namespace {

constexpr double kMetresPerDegree = 111195;

double smoothstep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Sum of octaves, about -1..1, without those shorter than `shortestM`.
double fractal(const Vec3d& p, double longestM, double shortestM, double gain, uint32_t seed) {
  double sum = 0, amplitude = 1, total = 0;
  for (double waveM = longestM; amplitude > 1e-4; waveM /= 2.02, amplitude *= gain) {
    total += amplitude;
    // An octave fades out before it goes, so that two samplings of one place differ little.
    const double kept = smoothstep(1, 2, waveM / shortestM);
    if (kept > 0) sum += amplitude * kept * static_cast<double>(gradientNoise(p / waveM, seed));
    ++seed;
  }
  return sum / total * 1.6;  // noise seldom reaches its ends
}

// Ridged multifractal (Musgrave): sharp crests over broad flanks, each octave weaker in the hollows of those above it,
// so that valleys stay smooth. 0..1.
double ridges(const Vec3d& p, double longestM, double shortestM, uint32_t seed) {
  double sum = 0, amplitude = 1, total = 0, above = 1;
  for (double waveM = longestM; waveM > 60; waveM /= 2.07, amplitude *= 0.45) {
    const double kept = smoothstep(1, 2, waveM / shortestM);
    if (kept > 0) {
      const double noise = static_cast<double>(gradientNoise(p / waveM, seed));
      // Crests are rounded, the more the smaller they are: weather does that.
      const double round = 0.015 + 0.12 * total;
      const double crest = 1 - std::sqrt(noise * noise + round * round) + round;
      const double signal = crest * crest;
      sum += amplitude * kept * signal * above;
      above = std::clamp(above * signal * 1.9, 0.15, 1.0);
    }
    total += amplitude;
    ++seed;
  }
  return smoothstep(0.2, 1.0, sum / total);
}

// The world at large: continents with mountain chains.
double worldHeightM(const Vec3d& p, double shortestM) {
  const double land = fractal(p, 5.2e6, shortestM, 0.55, 100) - 0.12;
  if (land <= 0) return 0;
  const double chain = 1 - std::abs(fractal(p, 3.1e6, std::max(shortestM, 2e5), 0.4, 140));
  return 900 * smoothstep(0, 0.7, land) +
         4200 * std::pow(std::clamp(chain, 0.0, 1.0), 6) * smoothstep(0.02, 0.3, land) * ridges(p, 6e5, shortestM, 160);
}

// The country around the runway: a coast in the east-south-east, plains behind it, mountains in the north and west.
double countryHeightM(const Vec3d& p, double eastKm, double northKm, double shortestM) {
  const double toCoastKm = 26 - (0.86 * eastKm - 0.5 * northKm) + 9 * fractal(p, 36e3, shortestM, 0.5, 200);
  if (toCoastKm <= 0) return 0;
  const double plainM = 4 * smoothstep(0, 0.4, toCoastKm) + 150 * smoothstep(0.5, 34, toCoastKm) +
                        26 * smoothstep(2, 12, toCoastKm) * (0.5 + 0.5 * fractal(p, 7e3, shortestM, 0.5, 230));
  const double fromRunwayKm = std::hypot(std::max(std::abs(eastKm) - 9, 0.0), northKm);
  const double highland = smoothstep(5, 30, toCoastKm) * smoothstep(4.5, 15, fromRunwayKm) *
                          smoothstep(-0.75, 0.45, fractal(p, 60e3, 4e4, 0.5, 260) + 0.35);
  return plainM + 1900 * highland * ridges(p, 19e3, shortestM, 300);
}

GeoGrid gridFor(double south, double north, double west, double east, double stepDeg) {
  GeoGrid grid;
  grid.southDeg = south;
  grid.westDeg = west;
  grid.latStepDeg = grid.lonStepDeg = stepDeg;
  grid.rows = static_cast<int>(std::lround((north - south) / stepDeg)) + 1;
  grid.columns = static_cast<int>(std::lround((east - west) / stepDeg)) + 1;
  return grid;
}

Result<void> writeDemoRaster(const std::string& path, const GeoGrid& grid) {
  std::vector<float> heights;
  heights.reserve(static_cast<size_t>(grid.rows) * static_cast<size_t>(grid.columns));
  const double shortestM = 2 * grid.latStepDeg * kMetresPerDegree;
  for (int row = 0; row < grid.rows; ++row) {
    const double lat = grid.northDeg() - row * grid.latStepDeg;
    for (int column = 0; column < grid.columns; ++column) {
      const double height = demoHeightM(lat, grid.westDeg + column * grid.lonStepDeg, shortestM);
      heights.push_back(static_cast<float>(height));
    }
  }
  return writeElevation(path, grid, heights);
}

}  // namespace

double demoHeightM(double latDeg, double lonDeg, double shortestM) {
  const Vec3d p = ecefFromGeodetic({latDeg, lonDeg, 0});
  const double northKm = (latDeg - kDemoRunwayLatDeg) * kMetresPerDegree / 1000;
  const double eastKm = (lonDeg - kDemoRunwayLonDeg) * std::cos(radFromDeg(latDeg)) * kMetresPerDegree / 1000;
  const double distanceKm = std::hypot(eastKm, northKm);
  const double local = 1 - smoothstep(250, 700, distanceKm);
  double heightM = local < 1 ? worldHeightM(p, shortestM) : 0;
  if (local > 0) heightM += (countryHeightM(p, eastKm, northKm, shortestM) - heightM) * local;
  // The airfield: level, with a margin around the runway, eased into the country.
  const double beyondKm = std::hypot(std::max(std::abs(eastKm) - kDemoRunwayLengthM / 2000 - 0.9, 0.0),
                                     std::max(std::abs(northKm) - 0.7, 0.0));
  const double level = 1 - smoothstep(0, 4, beyondKm);
  return level >= 1 ? kDemoRunwayElevationM : heightM + (kDemoRunwayElevationM - heightM) * level;
}

Result<DemoSources> makeDemoSources() {
  DemoSources sources;
  sources.elevation = {"/vsimem/eyepoint_demo_site.tif", "/vsimem/eyepoint_demo_country.tif",
                       "/vsimem/eyepoint_demo_world.tif"};
  sources.imagery = {"/vsimem/eyepoint_demo_airfield.tif"};
  const GeoGrid site = gridFor(kDemoSouthDeg, kDemoNorthDeg, kDemoWestDeg, kDemoEastDeg, 3.0 / 3600);
  const GeoGrid country = gridFor(34, 40, 125, 132, 60.0 / 3600);
  // Cell-centred, as global rasters are: no row at the poles, no double column at the date line.
  GeoGrid world = gridFor(-89.75, 89.75, -179.75, 179.75, 0.5);
  if (auto made = writeDemoRaster(sources.elevation[0], site); !made) return tl::unexpected(made.error());
  if (auto made = writeDemoRaster(sources.elevation[1], country); !made) return tl::unexpected(made.error());
  const std::optional<std::vector<float>> reliefM = installedReliefM(kInstalledRelief, world);
  if (auto made = reliefM ? writeElevation(sources.elevation[2], world, *reliefM)
                          : writeDemoRaster(sources.elevation[2], world);
      !made)
    return tl::unexpected(made.error());
  if (auto made = writeDemoAirfield(sources.imagery[0]); !made) return tl::unexpected(made.error());
  return sources;
}

}  // namespace eye

// Heights against the elevation that was baked, and lines of sight against heights along them.
#include "paging/ground_query.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "bake/baked_ground.h"
#include "terrain/database.h"

namespace eye {
namespace {

constexpr double kErrorM = 2;
constexpr int kPostsPerDeg = 200;

double hillsM(double latDeg, double lonDeg) {
  return 600 + 300 * std::sin(latDeg * 90) * std::cos(lonDeg * 70) + 40 * std::sin(latDeg * 500 + lonDeg * 300);
}

// Bilinear between the posts, as the bake takes its source.
double bilinearM(double latDeg, double lonDeg) {
  const double row = std::floor(latDeg * kPostsPerDeg), column = std::floor(lonDeg * kPostsPerDeg);
  const double t = latDeg * kPostsPerDeg - row, s = lonDeg * kPostsPerDeg - column;
  const auto post = [](double r, double c) { return hillsM(r / kPostsPerDeg, c / kPostsPerDeg); };
  return (1 - t) * ((1 - s) * post(row, column) + s * post(row, column + 1)) +
         t * ((1 - s) * post(row + 1, column) + s * post(row + 1, column + 1));
}

const std::string& hills() {
  static const BakedGround ground(postGrid(49, 20, 1.0 / kPostsPerDeg, 101, 101), hillsM, kErrorM, 16);
  return ground.database;
}

TEST_CASE("ground query: heights are the source's within the bake's error, at every point") {
  auto query = GroundQuery::open(hills());
  REQUIRE(query);
  std::mt19937_64 random(1);
  const auto within = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  double worstM = 0;
  for (int i = 0; i < 3000; ++i) {
    const double lat = within(49.05, 49.45), lon = within(20.05, 20.45);
    const auto hit = query->under(lat, lon);
    REQUIRE(hit);
    CHECK((hit->position.latDeg == lat && hit->position.lonDeg == lon));
    CHECK(glm::dot(hit->normalEcef, upAt(lat, lon)) > 0.3);
    worstM = std::max(worstM, std::abs(hit->position.altM - bilinearM(lat, lon)));
  }
  CHECK(worstM < kErrorM + 0.2);  // and the rounding of float posts and of the lattice
  CHECK(worstM > 0.1);
  const auto reader = DatabaseReader::open(hills());
  // Where there are no data: the sea; at the poles and the date line there is ground as well.
  for (const auto& [lat, lon] : {std::pair(-30.0, -120.0), {90.0, 0.0}, {-90.0, 77.0}, {0.0, 180.0}, {0.0, -180.0}}) {
    const auto hit = query->under(lat, lon);
    REQUIRE(hit);
    TileKey key = TileKey::containing(lat, lon, 0);
    while (reader->readMeta(key)->childCount > 0) key = TileKey::containing(lat, lon, key.level() + 1);
    CHECK(std::abs(hit->position.altM) <=
          reader->readMeta(key)->geometricErrorM + 0.1);  // coarse where there are no data
  }
}

TEST_CASE("ground query: a line of sight ends on the ground, and is above it before") {
  auto query = GroundQuery::open(hills());
  REQUIRE(query);
  std::mt19937_64 random(2);
  const auto within = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  const auto aboveM = [&](const Vec3d& ecefM) {
    const Geodetic at = geodeticFromEcef(ecefM);
    return at.altM - query->under(at.latDeg, at.lonDeg)->position.altM;
  };
  int hits = 0, misses = 0;
  for (int i = 0; i < 300; ++i) {
    const Geodetic a{within(49.1, 49.4), within(20.1, 20.4), within(900, 1500)};
    const Geodetic b{within(49.1, 49.4), within(20.1, 20.4), within(200, 1500)};
    const Vec3d from = ecefFromGeodetic(a), to = ecefFromGeodetic(b);
    if (aboveM(from) < 1) continue;
    const auto hit = query->between(from, to);
    REQUIRE(hit);
    const Vec3d end = *hit ? ecefFromGeodetic((*hit)->position) : to;
    ++(*hit ? hits : misses);
    if (*hit) {
      CHECK(std::abs(aboveM(end)) < 0.02);
      CHECK(glm::length(glm::cross(end - from, to - from)) < 0.01 * glm::length(to - from));  // on the line
    }
    double lowestM = 1e9;
    for (int k = 1; k < 100; ++k) lowestM = std::min(lowestM, aboveM(from + (end - from) * (k / 100.0)));
    CHECK(lowestM > -0.02);
    // The other way round it is seen as well or hidden as well.
    const auto back = query->between(to, from);
    REQUIRE(back);
    if (aboveM(to) > 1) CHECK(back->has_value() == hit->has_value());
  }
  CHECK(hits > 50);
  CHECK(misses > 20);
  // Straight through the Earth.
  const auto through = query->between(ecefFromGeodetic({49.2, 20.2, 5000}), ecefFromGeodetic({-49.2, -159.8, 5000}));
  REQUIRE((through && *through));
  CHECK((*through)->position.altM == Approx(bilinearM(49.2, 20.2)).margin(kErrorM + 0.2));
}

// Every triangle of every leaf, in ecef, relative to a place among them.
struct AllTriangles {
  Vec3d originEcefM{};
  std::vector<std::array<Vec3d, 3>> triangles;
};

AllTriangles allTriangles(const std::string& path, double southDeg, double westDeg, double northDeg, double eastDeg) {
  AllTriangles all;
  all.originEcefM = ecefFromGeodetic({(southDeg + northDeg) / 2, (westDeg + eastDeg) / 2, 0});
  const auto reader = DatabaseReader::open(path);
  REQUIRE(reader);
  std::vector<TileKey> leaves;
  REQUIRE(reader->forEach([&](const ChunkMeta& meta) -> Result<void> {
    const TileBounds b = meta.key.bounds();
    const bool isNear = b.northDeg > southDeg && b.southDeg < northDeg && b.eastDeg > westDeg && b.westDeg < eastDeg;
    if (meta.childCount == 0 && isNear) leaves.push_back(meta.key);
    return {};
  }));
  for (const TileKey& key : leaves) {
    const auto stored = reader->read(key);
    REQUIRE(stored);
    const auto mesh = decodeMesh(stored->mesh, key);
    REQUIRE(mesh);
    const double stepM = stored->meta.stepM();
    const Vec3d origin = ecefFromLattice(stored->meta.originLattice, stepM) - all.originEcefM;
    const auto corner = [&](size_t i) {
      const ChunkVertex& v = mesh->vertices[mesh->indices[i]];
      return origin + Vec3d(v.x, v.y, v.z) * stepM;
    };
    for (size_t i = 0; i + 2 < mesh->indices.size(); i += 3)
      all.triangles.push_back({corner(i), corner(i + 1), corner(i + 2)});
  }
  return all;
}

// The nearest hit of a line on any of them, as a share of the way; by planes and sides, no code shared with what is
// tested.
std::optional<double> nearestHit(const AllTriangles& all, const Vec3d& fromEcefM, const Vec3d& toEcefM) {
  const Vec3d from = fromEcefM - all.originEcefM, way = toEcefM - fromEcefM;
  std::optional<double> nearest;
  for (const auto& [a, b, c] : all.triangles) {
    const Vec3d normal = glm::cross(b - a, c - a);
    const double speed = glm::dot(normal, way);
    if (speed == 0) continue;
    const double along = glm::dot(normal, a - from) / speed;
    if (along < 0 || along > nearest.value_or(1)) continue;
    const Vec3d at = from + way * along;
    const bool isInside = glm::dot(glm::cross(b - a, at - a), normal) >= 0 &&
                          glm::dot(glm::cross(c - b, at - b), normal) >= 0 &&
                          glm::dot(glm::cross(a - c, at - c), normal) >= 0;
    if (isInside) nearest = along;
  }
  return nearest;
}

TEST_CASE("ground query: lines of sight hit what the nearest of all triangles says, short, long, steep and level") {
  auto query = GroundQuery::open(hills());
  REQUIRE(query);
  const AllTriangles all = allTriangles(hills(), 48.9, 19.9, 49.6, 20.6);
  REQUIRE(all.triangles.size() > 5000);
  std::mt19937_64 random(7);
  const auto within = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  int hits = 0, misses = 0;
  for (int i = 0; i < 600; ++i) {
    const Geodetic a{within(49.05, 49.45), within(20.05, 20.45), within(-200, 2000)};
    // A kilometre, ten, all across, or straight down with a corner's and an edge's rounding.
    const double reachDeg[] = {0.01, 0.1, 0.4, 0};
    const double reach = reachDeg[i % 4];
    const Geodetic b{std::clamp(a.latDeg + within(-reach, reach), 49.0, 49.5),
                     std::clamp(a.lonDeg + within(-reach, reach), 20.0, 20.5), within(-200, 2000)};
    const Vec3d from = ecefFromGeodetic(a), to = ecefFromGeodetic(b);
    const auto hit = query->between(from, to);
    REQUIRE(hit);
    const auto truth = nearestHit(all, from, to);
    INFO(i << ": " << a.latDeg << " " << a.lonDeg << " " << a.altM << " to " << b.latDeg << " " << b.lonDeg << " "
           << b.altM);
    REQUIRE(hit->has_value() == truth.has_value());
    ++(truth ? hits : misses);
    if (truth) CHECK(glm::length((*hit)->ecefM - (from + (to - from) * *truth)) < 1e-6);
  }
  CHECK(hits > 100);
  CHECK(misses > 100);
}

// Lines near the last begin at what is in reach of it, lines of 100 km and more at the octants.
TEST_CASE("ground query: a line hits what a longer one hits, wherever the last one was") {
  auto query = GroundQuery::open(hills()), fromOctants = GroundQuery::open(hills());
  REQUIRE((query && fromOctants));
  std::mt19937_64 random(9);
  const auto within = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  Geodetic at{};
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    // Over the hills, round them at the reach of what is kept, or anywhere on Earth; steps of that kind.
    const double reachDeg[] = {0.2, 1.2, 1.2, 90};
    const double reach = reachDeg[i == 0 ? 0 : random() % 4];
    at = {std::clamp(49.25 + within(-reach, reach), -89.0, 89.0), 20.25 + 2 * within(-reach, reach), within(0, 1500)};
    const double lengthDeg = std::pow(10, within(-3, -0.5));
    const Geodetic end{at.latDeg + within(-lengthDeg, lengthDeg), at.lonDeg + within(-lengthDeg, lengthDeg),
                       at.altM + within(-800, 300)};
    const Vec3d from = ecefFromGeodetic(at), way = ecefFromGeodetic(end) - from;
    const double longer = std::max(100'000 / glm::length(way), 1.0);
    const auto hit = query->between(from, from + way), further = fromOctants->between(from, from + way * longer);
    if (!hit || !further) {  // on terrain that is too coarse: the nearer one as well, unless it ends before
      REQUIRE_FALSE(further);
      CHECK((!hit || !hit->has_value()));
      continue;
    }
    const bool isTrue = *further && glm::length((*further)->ecefM - from) <= glm::length(way);
    INFO(i << ": " << at.latDeg << " " << at.lonDeg << " " << at.altM << " to " << end.latDeg << " " << end.lonDeg
           << " " << end.altM);
    REQUIRE(hit->has_value() == isTrue);
    hits += isTrue;
    if (isTrue) CHECK(glm::length((*hit)->ecefM - (*further)->ecefM) < 1e-3);
  }
  CHECK(hits > 200);
}

TEST_CASE("ground query: high above coarse ground there is nothing, and that is said") {
  // Boxes of large chunks reach high above those of their children.
  const BakedGround globe(
      postGrid(-90, -180, 1.5, 121, 241),
      [](double latDeg, double lonDeg) { return 2000 * std::sin(latDeg * 0.3) * std::cos(lonDeg * 0.2); }, 50, 16);
  auto query = GroundQuery::open(globe.database), fromOctants = GroundQuery::open(globe.database);
  REQUIRE((query && fromOctants));
  std::mt19937_64 random(11);
  const auto within = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  for (int i = 0; i < 3000; ++i) {
    const Geodetic at{within(50, 90), within(-180, 180), within(40'000, 75'000)};
    const Vec3d from = ecefFromGeodetic(at), way = glm::cross(upAt(at.latDeg, at.lonDeg), Vec3d(0, 0, 1)) * 20'000.0;
    const auto hit = query->between(from, from + way), further = fromOctants->between(from - way * 4.0, from + way);
    if (further && !*further) {
      REQUIRE(hit);
      CHECK_FALSE(hit->has_value());
    }
  }
}

TEST_CASE("ground query: beyond the data it is sea level, and nothing where terrain is next to unknown") {
  auto query = GroundQuery::open(hills());
  REQUIRE(query);
  for (const auto& [lat, lon] : {std::pair(48.0, 20.2), {49.2, 170.0}, {0.0, -180.0}, {-90.0, 12.0}, {49.2, 20.51}}) {
    const auto hit = query->under(lat, lon);
    REQUIRE(hit);
    CHECK(hit->position.altM == 0);
    CHECK(glm::length(hit->ecefM - ecefFromGeodetic({lat, lon, 0})) < 1e-6);
    CHECK(glm::dot(hit->normalEcef, upAt(lat, lon)) > 1 - 1e-12);
  }
  // Mid-ocean the coarsest chunks are chords of a thousand kilometres.
  const auto far = query->between(ecefFromGeodetic({-30, -120, 20'000}), ecefFromGeodetic({-30, -120, -20'000}));
  REQUIRE_FALSE(far);
  CHECK(far.error().kind == ErrorKind::unsupported);
}

TEST_CASE("ground query: how far beyond the Earth a line goes on changes nothing, nor where it comes from") {
  auto query = GroundQuery::open(hills());
  REQUIRE(query);
  const Vec3d from = ecefFromGeodetic({49.25, 20.25, 1200});
  const Mat3d ecefFromEnuHere = ecefFromEnu(49.25, 20.25);
  int hits = 0;
  for (int i = 0; i < 72; ++i) {
    const double azimuthRad = i * std::numbers::pi / 36, down = 0.06;
    const Vec3d way = ecefFromEnuHere * glm::normalize(Vec3d(std::sin(azimuthRad), std::cos(azimuthRad), -down));
    const auto near = query->between(from, from + way * 60e3), far = query->between(from, from + way * 1e9);
    if (!near || !far) continue;
    const bool isNear = near->has_value();
    REQUIRE((!isNear || far->has_value()));
    if (!isNear) continue;
    ++hits;
    CHECK(glm::length((*near)->ecefM - (*far)->ecefM) < 1e-3);
    const auto fromSpace = query->between(from - way * 1e9, from + way * 60e3);
    CHECK(fromSpace.has_value());
  }
  CHECK(hits > 30);
  const auto beside = query->between(Vec3d(1e8, 0, 1e7), Vec3d(-1e8, 0, 1e7));
  REQUIRE(beside);
  CHECK_FALSE(beside->has_value());
}

TEST_CASE("ground query: what has been forgotten is read again, with the same answers") {
  auto warm = GroundQuery::open(hills());
  REQUIRE(warm);
  // Far apart, and more chunks than are kept at once: each place in a leaf of its own, all round the globe.
  std::vector<std::pair<double, double>> places;
  for (int i = 0; i < 400; ++i)
    places.emplace_back(49.0 + 0.5 * (i % 20) / 20 + 1e-3, 20.0 + 0.5 * (i / 20) / 20 + 1e-3);
  for (int i = 0; i < 100; ++i) places.emplace_back(-80 + 1.6 * i, -179 + 3.5 * i);
  std::vector<double> first;
  for (const auto& [lat, lon] : places) first.push_back(warm->under(lat, lon)->position.altM);
  for (size_t i = places.size(); i-- > 0;)
    CHECK(warm->under(places[i].first, places[i].second)->position.altM == first[i]);
}

}  // namespace
}  // namespace eye

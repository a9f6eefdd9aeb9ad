// Where the benchmarks stand: the mountains and the plain of a database, found by the relief of its own tiles.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "terrain/database.h"

namespace eye {

struct Spot {
  LatLon at;
  double groundM = 0;
  double headingDeg = 0;  // towards the highest ground of the tile
};

struct Place {
  std::string name;             // "plain" or "mountains"
  double reliefM = 0;           // of the tile that was chosen
  std::array<Spot, 2> spots{};  // over its lowest vertex (a valley's floor), and half way up
};

// The plain, then the mountains: in the inner part of the data, so that there is terrain all round.
Result<std::array<Place, 2>> findPlaces(const DatabaseReader& reader);

double bearingDeg(const LatLon& from, const LatLon& to);  // of the short way, over small distances

}  // namespace eye

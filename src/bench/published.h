// What Lee, Park and Kim (paper 001, Table 5) report by altitude, for the schemes that we call none, frustum and
// dynamic. Their frames end at 60 a second.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace eye {

struct PublishedCulling {
  int altitudeFt = 0;
  std::string_view scheme;
  int triangles = 0, vertices = 0;
  double fps = 0;
};

inline constexpr std::array<PublishedCulling, 12> kPublishedCulling{{
    {2000, "none", 11079, 204100, 16.53},
    {4000, "none", 11079, 204100, 16.63},
    {6000, "none", 11079, 204100, 16.58},
    {8000, "none", 11079, 204100, 16.66},
    {2000, "frustum", 2560, 106126, 60},
    {4000, "frustum", 2634, 107310, 58.12},
    {6000, "frustum", 2724, 108750, 55.37},
    {8000, "frustum", 2854, 110980, 50.72},
    {2000, "dynamic", 2176, 99782, 60},
    {4000, "dynamic", 2304, 101654, 60},
    {6000, "dynamic", 2412, 102159, 60},
    {8000, "dynamic", 2526, 104256, 60},
}};

constexpr std::optional<PublishedCulling> publishedCulling(int altitudeFt, std::string_view scheme) {
  for (const PublishedCulling& row : kPublishedCulling)
    if (row.altitudeFt == altitudeFt && row.scheme == scheme) return row;
  return std::nullopt;
}

}  // namespace eye

// What the selector chooses among: no occlusion culling, or a depth map of one of paper 001's four sizes.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace eye {

// In order of pixels, so that choices compare. `off`: frustum culling alone.
enum class DepthMapChoice { off, size320x240, size400x300, size640x480, size800x600 };

constexpr size_t kDepthMapSizes = 4;
constexpr std::array<DepthMapChoice, kDepthMapSizes> kDepthMaps{
    DepthMapChoice::size320x240, DepthMapChoice::size400x300, DepthMapChoice::size640x480, DepthMapChoice::size800x600};

// Place in kDepthMaps; not for `off`.
constexpr size_t sizeIndex(DepthMapChoice choice) {
  return static_cast<size_t>(choice) - 1;
}

struct DepthMapSize {
  int widthPx = 0, heightPx = 0;
};

// Zeros for `off`.
constexpr DepthMapSize sizeOf(DepthMapChoice choice) {
  constexpr std::array<DepthMapSize, 5> sizes{{{0, 0}, {320, 240}, {400, 300}, {640, 480}, {800, 600}}};
  return sizes[static_cast<size_t>(choice)];
}

// As the per-frame statistics write it: "off", "800x600".
constexpr std::string_view nameOf(DepthMapChoice choice) {
  constexpr std::array<std::string_view, 5> names{"off", "320x240", "400x300", "640x480", "800x600"};
  return names[static_cast<size_t>(choice)];
}

}  // namespace eye

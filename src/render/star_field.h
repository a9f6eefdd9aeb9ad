// The stars: the brightest by name and place, fainter ones made up, and which of them a frame shows.
#pragma once

#include <span>
#include <vector>

#include "render/renderer.h"

namespace eye {

struct Star {
  Vec3d direction;       // unit; equator and equinox of 2000, x towards the equinox, z towards the pole
  float brightness = 0;  // as displayed: 1 for magnitude 0 and brighter, a twelfth for magnitude 6
};

// Brightest first, always the same.
std::span<const Star> stars();

// One star of a frame; its direction is the eye's.
struct StarInstance {
  glm::vec2 ndc, halfNdc;  // of its spot's centre; half the spot
  glm::vec3 direction_eye;
  float brightness;
};
static_assert(sizeof(StarInstance) == 32);

// Whether any star can be seen: by night, or from where the sky is dark by day.
bool starsShow(const FrameInput& input);
// Those within the view. Cleared first.
void placeStars(const FrameInput& input, std::vector<StarInstance>& placed);

}  // namespace eye

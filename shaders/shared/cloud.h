// A layer of cloud seen from outside: where a ray meets its shell and how much of what is behind comes through. The
// shader and the tests on the CPU compile this file.
#ifndef EYE_SHADERS_CLOUD_H
#define EYE_SHADERS_CLOUD_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
namespace eye::shader {
#define EYE_CLOUD_FUNCTION inline
using glm::abs;
using glm::dot;
using glm::exp;
using glm::ivec4;
using glm::max;
using glm::mix;
using glm::sqrt;
using glm::step;
using glm::vec3;
using glm::vec4;
#else
#define EYE_CLOUD_FUNCTION
#endif

// The face of a layer that the eye sees, its base from below, its top from above: an ellipsoid, the Earth's at that
// height, whose half axis at the equator is the unit of length. Push constants, one draw a layer; scalar layout.
struct CloudFace {
  // The ecef axes as the eye has them; w: the eye's place within its cell of the pattern, in cells.
  vec4 x_eye, y_eye, z_eye;
  // Half the slope of (scaled |point|)^2 along an axis, at the eye; w: that minus 1: below 0 from below. Computed in
  // double: from it come the distances, also of an eye a metre off the face.
  vec4 centre_eye;
  vec4 shape;    // curvature at the equator, what the pole adds; optical depth upwards; share of it that is there
  vec4 sunPart;  // colour that the sun gives the face; w: unit of length, metres
  vec4 skyPart;  // and the sky; w: how broken it is, 0 (one sheet) to 1
  ivec4 cell;    // of the pattern, that the eye is in; w: its width, metres
};

struct CloudHit {
  float distance;  // units of the face; 0: the ray does not meet it
  float slope;     // sine of the ray's elevation there, positive
};

// `ray_eye` is a unit vector. Of the two ways through the shell the first from above, the second from below. No branch:
// lavapipe compiles a shader anew for each value of a uniform that steers one.
EYE_CLOUD_FUNCTION CloudHit cloudHit(CloudFace face, vec3 ray_eye) {
  float alongPole = dot(ray_eye, vec3(face.z_eye));
  float a = face.shape.x + face.shape.y * alongPole * alongPole;
  float b = dot(ray_eye, vec3(face.centre_eye));
  float c = face.centre_eye.w;
  float inside = b * b - a * c;
  float root = sqrt(max(inside, 0.0f));
  float fromBelow = step(c, 0.0f);
  // Whichever root does not cancel: climbing from below or falling from above it is c / q, with the shell met far away
  // beyond the horizon q / a.
  float q = max(abs(b) + root, 1e-9f);
  float isNear = step(0.0f, mix(-b, b, fromBelow));
  float meets = max(fromBelow, isNear * step(0.0f, inside));
  CloudHit hit;
  hit.distance = meets * mix(q / a, abs(c) / q, isNear);
  hit.slope = root;
  return hit;
}

// Below this sine a layer's optical depth grows no more: its clouds have sides.
#define EYE_CLOUD_LEAST_SLOPE 0.1f

// How much of what is behind is hidden by an optical depth, given upwards.
EYE_CLOUD_FUNCTION float cloudOpacity(float opticalDepth, float slope) {
  return 1.0f - exp(-opticalDepth / max(slope, EYE_CLOUD_LEAST_SLOPE));
}

#ifdef __cplusplus
static_assert(sizeof(CloudFace) == 128, "what push constants hold on every device");
}  // namespace eye::shader
#endif

#endif

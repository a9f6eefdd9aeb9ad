// The scene bent about the eye, so that curved rays become straight ones: see geo/scene_bend.h. GLSL only; needs `frame`.
// Specialization constants: a pipeline that bends nothing has not one instruction of this.
layout(constant_id = 0) const bool kBends = false;
layout(constant_id = 1) const float kStretchEast = 0.0;
layout(constant_id = 2) const float kStretchNorth = 0.0;
layout(constant_id = 3) const float kLiftEastPerM = 0.0;
layout(constant_id = 4) const float kLiftNorthPerM = 0.0;

vec3 bent(vec3 position_ecef) {
  vec3 up = frame.up_ecef.xyz;
  vec2 eastwards = vec2(-up.y, up.x);  // 0 at a pole, where all that is level counts as north
  vec3 east = vec3(eastwards / max(length(eastwards), 1e-9), 0.0);
  vec3 eastOffset = east * dot(position_ecef, east);
  vec3 northOffset = position_ecef - up * dot(position_ecef, up) - eastOffset;
  return position_ecef + eastOffset * kStretchEast + northOffset * kStretchNorth +
         up * (kLiftEastPerM * dot(eastOffset, eastOffset) + kLiftNorthPerM * dot(northOffset, northOffset));
}

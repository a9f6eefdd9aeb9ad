// Sky and haze: closed forms over an atmosphere that thins out exponentially. GLSL only; needs `frame`.
// Cheap on purpose: all of it runs by vertex, or by pixel where vertices are too far apart.

// Column of air along a ray that leaves upwards at sine `rise` from where the air is as dense as at the ground, in units
// of the vertical column. Chapman's function, near enough: 35 along the level, 1 / rise higher up.
float columnAbove(float rise) { return EYE_LEVEL_COLUMN / (EYE_LEVEL_COLUMN * rise + 1.0); }

// Column of air along a whole ray from the eye that does not meet the ground (one that does counts as if it just
// missed it). `rise` is the sine of its elevation.
float skyColumn(float rise) {
  float eyeHeightM = max(frame.up_ecef.w, 0.0);
  float outwards = frame.sun_eye.w * columnAbove(abs(rise));
  // Falling, the ray is densest where it passes nearest to the Earth: r (1 - cos) below the eye, without cancellation.
  float drop = rise * rise / (1.0 + sqrt(max(1.0 - rise * rise, 0.0)));
  float lowestM = max(eyeHeightM - (EYE_EARTH_RADIUS_M + eyeHeightM) * drop, 0.0);
  float through = 2.0 * EYE_LEVEL_COLUMN * exp(-lowestM / EYE_AIR_SCALE_M) - outwards;
  return rise >= 0.0 ? outwards : max(through, 0.0);
}

// How far the sky over a place is lit, by the sine of the sun's height there: by day 1, after dusk by stars and moon.
float skyLit(float sunHeight) { return mix(EYE_NIGHT_SKY, 1.0, smoothstep(-0.25, 0.10, sunHeight)); }

// Brightness of the glow by the cosine between ray and sun: a wide and a narrow lobe.
float glowShape(float towardsSun) {
  float f = max(towardsSun, 0.0);
  float f2 = f * f, f4 = f2 * f2, f8 = f4 * f4;
  return 0.35 * f4 + 0.65 * f8 * f8;
}

// The colour that haze has, and the sky at the horizon: distant ridges melt into it.
vec3 hazeColour(float towardsSun, float lit) {
  return (frame.horizon.rgb + frame.horizonGlow.rgb * glowShape(towardsSun)) * lit;
}

// `rise` and `towardsSun`: cosines between the ray and the eye's vertical, and the sun. Without the sun's disc.
vec3 skyColour(float rise, float towardsSun) {
  float sunHeight = dot(frame.up_eye.xyz, frame.sun_eye.xyz);
  // A falling ray's air is where it passes nearest to the Earth: seen from space, that may have night or day of its own.
  if (rise < 0.0) sunHeight = (sunHeight - rise * towardsSun) * inversesqrt(max(1.0 - rise * rise, 1e-6));
  float lit = skyLit(sunHeight);
  vec3 scattered = 1.0 - exp(-frame.airDepth.rgb * skyColumn(rise));
  vec3 sky = lit * (frame.deepSky.rgb * scattered + frame.glow.rgb * (glowShape(towardsSun) * scattered.g));
  return mix(sky, hazeColour(towardsSun, frame.skyLight.w), frame.airDepth.w);
}

// What the sun's disc adds to that. It is half a degree wide; its rim is softened over a tenth of that. The distance of
// unit vectors keeps the digits that 1 - cos would lose in floats.
float sunDisc(vec3 ray_eye, float rise) {
  vec3 offset = ray_eye - frame.sun_eye.xyz;
  float disc = 1.0 - smoothstep(1.6e-5, 2.2e-5, dot(offset, offset));
  return frame.glow.w * disc * (1.0 - 0.7 * (1.0 - exp(-frame.airDepth.r * skyColumn(rise))));
}

// Optical depth of the haze per metre of the straight way from the eye to a point so far away, mean over the way.
// `rise` is the sine of the way's elevation.
float hazePerMetre(float distanceM, float rise) {
  float eyeHeightM = frame.up_ecef.w;
  // The point's height, with the Earth's curvature.
  float lowM = eyeHeightM + distanceM * rise + distanceM * distanceM * (1.0 - rise * rise) * (0.5 / EYE_EARTH_RADIUS_M);
  // From space only the way below the top of the air counts. In Earth radii, for the floats' sake.
  float r = frame.up_eye.w;
  float top = 1.0 + EYE_AIR_TOP_M / EYE_EARTH_RADIUS_M;
  float along = -r * rise;
  float chord = sqrt(max(along * along - (r - top) * (r + top), 0.0));
  float lowerWayM = clamp(distanceM - (along - chord) * EYE_EARTH_RADIUS_M, 0.0, distanceM);
  // Arithmetic instead of a branch: lavapipe compiles a shader anew for each value of a uniform that steers a branch,
  // 50 ms in every frame of a moving eye.
  float fromSpace = step(EYE_AIR_TOP_M, eyeHeightM);
  float topM = min(eyeHeightM, EYE_AIR_TOP_M);
  float inAirM = mix(distanceM, lowerWayM, fromSpace);
  float pointM = mix(lowM, 0.0, fromSpace);
  // Mean density between the two heights: exact for an exponential; the trapezoid where the quotient loses its digits.
  float between = (topM - pointM) / EYE_AIR_SCALE_M;
  float density = exp(-pointM / EYE_AIR_SCALE_M);
  float mean = abs(between) < 0.02 ? 0.5 * (density + frame.sun_ecef.w) : (density - frame.sun_ecef.w) / between;
  return frame.sunLight.w * mean * inAirM / distanceM;
}

// To a point of the ground.
float hazePerMetre(vec3 position_ecef) {
  float distanceM = max(length(position_ecef), 1e-3);
  return hazePerMetre(distanceM, dot(position_ecef, frame.up_ecef.xyz) / distanceM);
}

// Half a step of 8 bits, up or down, from a pattern without structure (Jimenez 2014): no bands in sky and haze.
vec3 dithered(vec3 colour, vec2 pixel) {
  float noise = fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))));
  return colour + (noise - 0.5) / 255.0;
}

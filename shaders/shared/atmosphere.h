// Sky and haze: closed forms over an atmosphere that thins out exponentially. GLSL only; needs `frame`.

// Column of air along a ray that leaves upwards at sine `rise` from where the air is as dense as at the ground, in units
// of the vertical column. Chapman's function, near enough: 35 along the level, 1 / rise higher up.
float columnAbove(float rise) { return EYE_LEVEL_COLUMN / (EYE_LEVEL_COLUMN * rise + 1.0); }

// Column of air along a whole ray from the eye that does not meet the ground (one that does counts as if it just
// missed it). `rise` is the sine of its elevation.
float skyColumn(float rise) {
  float eyeHeightM = max(frame.up_ecef.w, 0.0);
  float dense = exp(-eyeHeightM / EYE_AIR_SCALE_M);
  if (rise >= 0.0) return dense * columnAbove(rise);
  // Falling, the ray is densest where it passes nearest to the Earth: r (1 - cos) below the eye, without cancellation.
  float drop = rise * rise / (1.0 + sqrt(max(1.0 - rise * rise, 0.0)));
  float lowestM = max(eyeHeightM - (EYE_EARTH_RADIUS_M + eyeHeightM) * drop, 0.0);
  return max(2.0 * EYE_LEVEL_COLUMN * exp(-lowestM / EYE_AIR_SCALE_M) - dense * columnAbove(-rise), 0.0);
}

// Colour of so much air in a direction: `towardsSun` is the cosine between the ray and the sun.
vec3 airColour(float column, float towardsSun) {
  // Vertical optical depths of air for red, green, blue (Rayleigh at 680, 550, 440 nm), and what the haze adds. Times
  // 3.6: colours here are as displayed, not linear, and dim light is displayed brighter.
  vec3 depth = (vec3(0.046, 0.108, 0.265) * 3.6 + frame.night.w) * column;
  vec3 lit = frame.zenith.rgb * (1.0 - exp(-depth));
  float forward = max(towardsSun, 0.0);
  float forward4 = forward * forward * forward * forward;
  float glow = 0.35 * forward4 + 0.65 * forward4 * forward4 * forward4 * forward4;
  return lit + frame.glow.rgb * (glow * (1.0 - exp(-0.12 * column))) + frame.night.rgb * (1.0 - exp(-0.3 * column));
}

vec3 horizonColour(float towardsSun) { return airColour(EYE_LEVEL_COLUMN, towardsSun); }

vec3 skyColour(vec3 ray_eye) {
  float rise = dot(ray_eye, frame.up_eye.xyz);
  float towardsSun = dot(ray_eye, frame.sun_eye.xyz);
  float column = skyColumn(rise);
  vec3 colour = airColour(column, towardsSun);
  // The disc is half a degree wide; its rim is softened over a tenth of that. 1 - cos keeps its digits in floats.
  vec3 offset = ray_eye - frame.sun_eye.xyz;
  float disc = 1.0 - smoothstep(1.6e-5, 2.2e-5, dot(offset, offset));
  float clear = exp(-0.02 * column) * step(-0.5, frame.glow.w);
  return colour + frame.glow.w * disc * clear;
}

// Share of light that haze takes away over `distanceM` along a ray from the eye to ground at that distance.
float hazeBetween(float rise, float distanceM) {
  float eyeHeightM = frame.up_ecef.w;
  float inAirM = distanceM;
  float topM = eyeHeightM;
  if (eyeHeightM > EYE_AIR_TOP_M) {
    // From space: only the part below the top of the air counts. Distances in Earth radii, for the floats' sake.
    float r = frame.up_eye.w;
    float top = 1.0 + EYE_AIR_TOP_M / EYE_EARTH_RADIUS_M;
    float along = -r * rise;
    float chord = sqrt(max(along * along - (r - top) * (r + top), 0.0));
    inAirM = clamp(distanceM - (along - chord) * EYE_EARTH_RADIUS_M, 0.0, distanceM);
    topM = EYE_AIR_TOP_M;
  }
  // The ground's height from the eye's, with the Earth's curvature.
  float groundM = eyeHeightM > EYE_AIR_TOP_M ? 0.0 : eyeHeightM + distanceM * rise +
      distanceM * distanceM * (1.0 - rise * rise) * (0.5 / EYE_EARTH_RADIUS_M);
  // Mean of exp(-h / H) between the two heights: exact for a straight line.
  float top_H = topM / EYE_AIR_SCALE_M, ground_H = groundM / EYE_AIR_SCALE_M;
  float between = top_H - ground_H;
  float mean = abs(between) < 0.01 ? exp(-0.5 * (top_H + ground_H)) : (exp(-ground_H) - exp(-top_H)) / between;
  return 1.0 - exp(-frame.sunLight.w * mean * inAirM);
}

// Half a step of 8 bits, up or down, from a pattern without structure (Jimenez 2014): no bands in sky and haze.
vec3 dithered(vec3 colour, vec2 pixel) {
  float noise = fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))));
  return colour + (noise - 0.5) / 255.0;
}

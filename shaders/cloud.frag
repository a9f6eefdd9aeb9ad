// A layer of cloud: a ceiling from below, a deck from above. Over what is there; terrain nearer than it stands before it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/atmosphere.h"
#include "shared/cloud.h"

layout(push_constant, scalar) uniform CloudBlock { CloudFace face; };

layout(location = 0) out vec4 outColour;

float latticeValue(uint x, uint y, uint z) {
  uint n = x ^ y ^ z;
  n = (n ^ (n >> 15)) * 0x2c1b3c6du;
  n = (n ^ (n >> 12)) * 0x297a2d39u;
  return float(n >> 8) * (1.0 / 16777216.0);
}

// Value noise, 0 to 1, mean 0.5: in space, so that the pattern stays in its place on the globe, without seams.
float noiseAt(vec3 p, ivec3 cell) {
  vec3 low = floor(p), t = p - low;
  t = t * t * (3.0 - 2.0 * t);
  uvec3 at = uvec3(ivec3(low) + cell);
  uvec3 a = at * uvec3(0x5f356495u, 0xe3305f05u, 0xa6d2dd29u);
  uvec3 b = a + uvec3(0x5f356495u, 0xe3305f05u, 0xa6d2dd29u);
  vec4 y0 = vec4(latticeValue(a.x, a.y, a.z), latticeValue(b.x, a.y, a.z), latticeValue(a.x, a.y, b.z),
                 latticeValue(b.x, a.y, b.z));
  vec4 y1 = vec4(latticeValue(a.x, b.y, a.z), latticeValue(b.x, b.y, a.z), latticeValue(a.x, b.y, b.z),
                 latticeValue(b.x, b.y, b.z));
  vec4 alongY = mix(y0, y1, t.y);
  vec2 alongX = mix(alongY.xz, alongY.yw, t.x);
  return mix(alongX.x, alongX.y, t.z);
}

void main() {
  vec3 ray = rayThrough(gl_FragCoord.xy);
  float rayLength = length(ray);
  vec3 ray_eye = ray / rayLength;
  CloudHit hit = cloudHit(face, ray_eye);
  float distanceM = hit.distance * face.sunPart.w;
  // Nothing met: the depth of nothing, which no test passes.
  gl_FragDepth = min(frame.clipFromEcef[3].z * rayLength / max(distanceM, 1e-3), 1.0) * step(1e-9, hit.distance);

  // The pattern in three sizes, each gone to its mean where a pixel holds half of it.
  float cellM = float(face.cell.w);
  vec3 ray_ecef = vec3(dot(ray_eye, face.x_eye.xyz), dot(ray_eye, face.y_eye.xyz), dot(ray_eye, face.z_eye.xyz));
  vec3 p = vec3(face.x_eye.w, face.y_eye.w, face.z_eye.w) + ray_ecef * (distanceM / cellM);
  float pixelCells = distanceM / cellM * abs(frame.ray_eye.z) / max(hit.slope, 0.02);
  vec3 shown = 1.0 - smoothstep(0.15, 0.5, pixelCells * vec3(1.0, 3.0, 9.0));
  vec3 noise = vec3(noiseAt(p, face.cell.xyz), noiseAt(p * 3.0, face.cell.xyz * 3), noiseAt(p * 9.0, face.cell.xyz * 9));
  float density = dot((noise - 0.5) * shown, vec3(0.55, 0.28, 0.17));  // about 0

  // As much of the sky is covered as the layer says: noise of these sizes is near normal, its deviation 0.13.
  float cover = 1.0 - exp(-face.shape.z);
  float puff = smoothstep(-0.07, 0.07, density + (cover - 0.5) * 0.42);
  float even = cloudOpacity(face.shape.z, hit.slope);
  float opacity = mix(even, cloudOpacity(2.5 * puff, hit.slope), face.skyPart.w * shown.x) * face.shape.w;

  vec3 normal_eye = normalize(face.centre_eye.xyz + ray_eye * hit.distance);
  float sunHeight = dot(normal_eye, frame.sun_eye.xyz);
  float relief = 1.0 + 0.9 * density * sign(face.centre_eye.w);  // thick is dark from below, bright from above
  vec3 colour = (face.skyPart.rgb * skyLit(sunHeight) + face.sunPart.rgb * smoothstep(-0.1, 0.35, sunHeight)) * relief;

  float towardsSun = dot(ray_eye, frame.sun_eye.xyz);
  float clear = exp(-hazePerMetre(distanceM, dot(ray_eye, frame.up_eye.xyz)) * distanceM);
  colour = mix(hazeColour(towardsSun, skyLit(dot(frame.up_eye.xyz, frame.sun_eye.xyz))), colour, clear);
  outColour = vec4(dithered(colour, gl_FragCoord.xy), opacity);
}

// What C++ and GLSL must agree on, stated once. Both compile this file.
#ifndef EYE_SHADERS_CONFIG_H
#define EYE_SHADERS_CONFIG_H

// Depth is near / z with an infinite far plane, in D32_SFLOAT: cleared to 0 (nothing there), compared with GREATER.
#define EYE_REVERSED_Z 1
#define EYE_CLEAR_DEPTH 0.0

// Bindings of the one descriptor set.
#define EYE_BIND_FRAME 0
#define EYE_BIND_TEXTURES 1

// Bindings of the culling passes' descriptor set.
#define EYE_BIND_CULL_PARAMS 0
#define EYE_BIND_CULL_CHUNKS 1
#define EYE_BIND_CULL_CANDIDATES 2
#define EYE_BIND_CLUSTERS 3
#define EYE_BIND_VISIBLE 4
#define EYE_BIND_EARLY 5
#define EYE_BIND_LATE 6
#define EYE_BIND_FATES 7
#define EYE_BIND_DEPTH 8
#define EYE_BIND_PYRAMID 9
#define EYE_BIND_PIXEL_SPANS 10
#define EYE_CULL_BINDINGS 11

// What became of a cluster, in the low bits of its fate; above them its count of triangles.
#define EYE_FATE_VISIBLE 0u
#define EYE_FATE_OUTSIDE 1u
#define EYE_FATE_BACK_FACING 2u
#define EYE_FATE_OCCLUDED 3u
#define EYE_FATE_WHY 3u  // mask of the above
#define EYE_FATE_EARLY \
  4u                      // drawn by the early pass: what it then proves to be, occluded perhaps, is for the next frame
#define EYE_FATE_LATE 8u  // drawn by the late pass
#define EYE_FATE_BITS 4

// A group of the culling shader works on so many clusters, one of the depth map's on so many texels each way.
#define EYE_CULL_GROUP 64
#define EYE_DEPTH_GROUP 8
#define EYE_MOST_SAMPLES 4  // a pixel, where not one
// 2^13 texels: the largest depth map.
#define EYE_MAX_DEPTH_LEVELS 14

// A cluster's rectangle is tested against so many texels of the pyramid at most.
#define EYE_RECT_TEXELS 256

// Added to a cone's cutoff, a sine: see isBackFacing.
#define EYE_CONE_MARGIN 0.02f
// Margins of the depth that a box may reach: a share of its extent along the view, and of the depth; see mapRectOf.
#define EYE_DEPTH_MARGIN 0.0625f
#define EYE_DEPTH_FACTOR 1.00001f

// Locations of the vertex attributes: of a vertex, and of the chunk that it belongs to (see DrawData).
#define EYE_AT_POSITION_SKIRT 0
#define EYE_AT_PARAM 1
#define EYE_AT_NORMAL 2
#define EYE_AT_ORIGIN 3
#define EYE_AT_STEP 4
#define EYE_AT_FRACTION_SKIRT 5
#define EYE_AT_UP 6
#define EYE_AT_LAYER 7
#define EYE_AT_OUTWARD 8
#define EYE_AT_TEXTURE_MAP 12

// How far a skirt's lower rim moves outwards, as a share of its depth: enough to cover what two edges differ
// horizontally.
#define EYE_SKIRT_FLARE 0.5

// Height over which the air, and the haze that it carries, thins out by e.
#define EYE_AIR_SCALE_M 8000.0
// A ray counts as in the air below this height: 7.5 scale heights, 0.06 % of the air lies above.
#define EYE_AIR_TOP_M 60000.0
// Column of air along a level ray over that of a vertical one, from the ground: sqrt(pi R / 2 H).
#define EYE_LEVEL_COLUMN 35.4
// Light of the sky by night, as displayed, over that of the day.
#define EYE_NIGHT_SKY 0.07
#define EYE_EARTH_RADIUS_M 6371000.0
#define EYE_PI 3.14159265358979

// The sky's dome: meridians, rings from the horizon to the zenith and as many down to the nadir, and how much closer
// the rings lie along the horizon, where the air's column changes by half within a degree: 0.3 degrees apart there, 7
// at the zenith. No colour is off by more than a step or two of 255.
#define EYE_DOME_MERIDIANS 96
#define EYE_DOME_RINGS 40
#define EYE_DOME_CROWDING 3.2
#define EYE_LOG2_E 1.44269504

#endif

// What of a picture's quality a user may trade for time beside the tolerated error.
#pragma once

namespace eye {

// How terrain's textures are read. device: bilinear on a device that is a CPU, trilinear elsewhere.
enum class TextureFilter {
  device,
  nearest,    // one texel of the nearest mip level
  bilinear,   // four texels of the nearest mip level
  trilinear,  // four texels of each of two levels
};

}  // namespace eye

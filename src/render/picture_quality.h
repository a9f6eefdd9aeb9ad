// What of a picture's quality a user may trade for time beside the tolerated error.
#pragma once

namespace eye {

// How terrain's textures are read. device: as gpu/device_traits.h chooses; bilinear on a device that is a CPU.
enum class TextureFilter {
  device,
  nearest,      // one texel of the nearest mip level
  bilinear,     // four texels of the nearest mip level
  trilinear,    // four texels of each of two levels
  anisotropic,  // several of these along a footprint that is longer than wide: ground seen at a flat angle
};

}  // namespace eye

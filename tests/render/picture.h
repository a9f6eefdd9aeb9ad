// Pictures of the renderer's tests, for looking at.
#pragma once

#include <cstdlib>
#include <fstream>
#include <string>

#include "render/renderer.h"

namespace eye::test {

// Written where EYE_PICTURES names a folder.
inline void keepPicture(const FrameOutput& frame, const std::string& name) {
  const char* folder = std::getenv("EYE_PICTURES");
  if (folder == nullptr) return;
  std::ofstream out(std::string(folder) + "/" + name + ".ppm", std::ios::binary);
  out << "P6\n" << frame.widthPx << " " << frame.heightPx << "\n255\n";
  for (size_t i = 0; i < frame.rgba.size(); i += 4) out.write(reinterpret_cast<const char*>(&frame.rgba[i]), 3);
}

}  // namespace eye::test

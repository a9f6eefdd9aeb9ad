// How often keys were pressed that switch what the picture shows.
#pragma once

namespace eye {

struct WindowKeys {
  int overlay = 0;   // F1
  int freeze = 0;    // F2
  int depthMap = 0;  // F3
  int tint = 0;      // F4
};

}  // namespace eye

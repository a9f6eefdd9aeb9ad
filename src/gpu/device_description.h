// What `--list-devices` prints of a Vulkan device.
#pragma once

#include <string>

namespace eye {

struct DeviceDescription {
  std::string name, type, driver, apiVersion;
  bool usable = false;
  std::string lacks;    // what makes it unusable, in words
  std::string choices;  // what is chosen for it, in words
};

}  // namespace eye

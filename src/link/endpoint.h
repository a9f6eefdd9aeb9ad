// "ADDR:PORT" as it stands in URLs and options.
#pragma once

#include <cstdint>
#include <string>

#include "base/error.h"

namespace eye {

struct Endpoint {
  std::string address;  // IPv4 in dots, or a name that resolves to one
  uint16_t port = 0;
  bool operator==(const Endpoint&) const = default;
};

inline constexpr const char* kLoopbackAddress = "127.0.0.1";

// ADDR:PORT, :PORT or PORT; without an address it is `defaultAddress`. The port is 1 to 65535. `where` names the option
// or URL in the error.
Result<Endpoint> parseEndpoint(const std::string& text, const std::string& defaultAddress, const std::string& where);

}  // namespace eye

#include "link/endpoint.h"

#include <fmt/format.h>

#include <charconv>

namespace eye {

Result<Endpoint> parseEndpoint(const std::string& text, const std::string& defaultAddress, const std::string& where) {
  const size_t colon = text.rfind(':');
  const std::string portText = colon == std::string::npos ? text : text.substr(colon + 1);
  const std::string address = colon == std::string::npos || colon == 0 ? defaultAddress : text.substr(0, colon);

  uint16_t port = 0;
  const char* const end = portText.data() + portText.size();
  const auto [stop, problem] = std::from_chars(portText.data(), end, port);
  if (problem != std::errc() || stop != end || port == 0)
    return fail(ErrorKind::usage, fmt::format("{}: '{}' is not ADDR:PORT with a port from 1 to 65535, such as {}:5550",
                                              where, text, kLoopbackAddress));
  if (address.find(':') != std::string::npos || address.size() > 253)  // 253: the longest name that DNS knows
    return fail(ErrorKind::usage,
                fmt::format("{}: '{}' is no IPv4 address; write it as {}:5550", where, address, kLoopbackAddress));
  return Endpoint{address, port};
}

}  // namespace eye

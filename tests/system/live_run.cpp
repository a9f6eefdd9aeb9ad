#include "system/live_run.h"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "link/udp_socket.h"
#include "system/program.h"

namespace eye::truth {

uint16_t freePort() {
  return UdpSocket::listenOn({kLoopbackAddress, 0})->port();
}

bool awaitListeners(const std::string& address, uint16_t port, size_t count) {
  // As the kernel's list has it: the address's bytes in reverse.
  const uint32_t host = resolvePeer({address, port})->address;
  const std::string listening = fmt::format("{:02X}{:02X}{:02X}{:02X}:{:04X} ", host & 0xff, host >> 8 & 0xff,
                                            host >> 16 & 0xff, host >> 24, port);
  for (int i = 0; i < 500; ++i) {
    const std::string list = readText("/proc/net/udp");
    size_t found = 0;
    for (size_t at = list.find(listening); at != std::string::npos; at = list.find(listening, at + 1)) ++found;
    if (found >= count) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

std::vector<nlohmann::json> linesOf(const std::string& path) {
  std::vector<nlohmann::json> lines;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    auto value = nlohmann::json::parse(line, nullptr, false);
    if (!value.is_discarded()) lines.push_back(std::move(value));
  }
  return lines;
}

}  // namespace eye::truth

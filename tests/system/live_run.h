// Programs that talk to each other: ports, who listens, and what their statistics say.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace eye::truth {

// A UDP port of the loopback that nobody has now.
uint16_t freePort();

// Waits for up to ten seconds until so many sockets listen on an IPv4 address; false when they do not.
bool awaitListeners(const std::string& address, uint16_t port, size_t count = 1);

// The lines of a --stats file.
std::vector<nlohmann::json> linesOf(const std::string& path);

}  // namespace eye::truth

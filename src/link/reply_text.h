// What an image generator says back, in words for a terminal.
#pragma once

#include <string>

#include "link/cigi_packets.h"

namespace eye::cigi {

std::string textOf(IgMode mode);
// One line for a Start of Frame and for each kind of answer; nothing for other packets.
std::string textOf(const Packet& packet);

}  // namespace eye::cigi

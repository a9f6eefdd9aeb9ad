// Dead reckoning of DIS (IEEE 1278.1, annex E): where an entity is between its PDUs. Pure functions.
#pragma once

#include "link/dis.h"

namespace eye {

// The pose `seconds` after the PDU, which may be as many as a heartbeat has.
Pose deadReckoned(const DisEntityState& state, double seconds);

}  // namespace eye

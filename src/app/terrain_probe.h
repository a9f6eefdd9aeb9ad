// Answers to a host's questions about the ground, from the database that is drawn. Owner thread: ground.
#pragma once

#include "link/ground_probe.h"

namespace eye {

// What openStateSource wants.
Result<std::unique_ptr<GroundProbe>> openTerrainProbe(const std::string& databasePath);

}  // namespace eye

// Shards of one bake joined to the database that the unshared bake would have made.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"

namespace eye {

// `inputs`: every shard of one bake once, complete. The result is the unshared bake's, tile for tile, byte for byte. It
// grows as OUT.part and gets its name when it is whole. `progress(done, total)` counts tiles.
Result<void> mergeShards(const std::string& out, const std::vector<std::string>& inputs,
                         const std::function<void(uint64_t, uint64_t)>& progress);

}  // namespace eye

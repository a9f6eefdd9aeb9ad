// The seven numbers by which DIS, and CIGI 4.0 after it, name kinds of entities (SISO-REF-010).
#pragma once

#include <cstdint>

namespace eye {

struct EntityType {
  uint8_t kind = 0, domain = 0;  // 1 platform; 1 land, 2 air, 3 surface, 4 subsurface, 5 space
  uint16_t country = 0;
  uint8_t category = 0, subcategory = 0, specific = 0, extra = 0;
  bool operator==(const EntityType&) const = default;
};

}  // namespace eye

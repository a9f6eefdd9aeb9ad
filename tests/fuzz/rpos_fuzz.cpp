#include "fuzz_input.h"
#include "link/xplane.h"

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace eye;
  const auto state = parseRpos(fuzz::bytesOf(data, size));
  if (state) EYE_CHECK(parseRpos(buildRpos(*state)));
  return 0;
}

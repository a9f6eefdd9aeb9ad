#include "fuzz_input.h"
#include "link/dis.h"

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace eye;
  const auto state = parseDisEntityState(fuzz::bytesOf(data, size));
  if (!state) return 0;
  EYE_CHECK(looksLikeDisEntityState(buildDisEntityState(*state)));
  EYE_CHECK(disSecondsPastHour(state->timestamp) < 3600);
  return 0;
}

#include "fuzz_input.h"
#include "link/native_fdm.h"

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace eye;
  const auto packet = fuzz::bytesOf(data, size);
  const auto state = parseNativeFdm(packet);
  if (!state) return 0;
  EYE_CHECK(looksLikeNativeFdm(packet));
  EYE_CHECK(parseNativeFdm(buildNativeFdm(*state)));
  return 0;
}

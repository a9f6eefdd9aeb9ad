#include "feed_script.h"
#include "fuzz_input.h"
#include "link/native_fdm_receiver.h"

namespace {

using namespace eye;

void checkAlone(std::span<const std::byte> packet) {
  const auto state = parseNativeFdm(packet);
  if (!state) return;
  EYE_CHECK(looksLikeNativeFdm(packet));
  EYE_CHECK(parseNativeFdm(buildNativeFdm(*state)));
}

}  // namespace

// One packet, and the same bytes as a flight of several.
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto input = fuzz::bytesOf(data, size);
  checkAlone(input);
  fuzz::feed<NativeFdmReceiver>(input, kHostSilenceNs);
  return 0;
}

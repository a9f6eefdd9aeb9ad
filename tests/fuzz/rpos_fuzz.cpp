#include "feed_script.h"
#include "fuzz_input.h"
#include "link/xplane_receiver.h"

// One answer, and the same bytes as a flight of several.
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace eye;
  const auto input = fuzz::bytesOf(data, size);
  const auto state = parseRpos(input);
  if (state) EYE_CHECK(parseRpos(buildRpos(*state)));
  fuzz::feed<XplaneReceiver>(input, kHostSilenceNs, Peer{0x7f000001, 1000}, 60);
  return 0;
}

#include "feed_script.h"
#include "fuzz_input.h"
#include "link/dis_receiver.h"

namespace {

using namespace eye;

void checkAlone(std::span<const std::byte> datagram) {
  const auto state = parseDisEntityState(datagram);
  if (!state) return;
  EYE_CHECK(looksLikeDisEntityState(buildDisEntityState(*state)));
  EYE_CHECK(disSecondsPastHour(state->timestamp) < 3600);
}

}  // namespace

// One PDU, and the same bytes as an exercise of several: of the first entity heard, and of a wanted one.
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto input = fuzz::bytesOf(data, size);
  checkAlone(input);
  fuzz::feed<DisReceiver>(input, kDisTimeOutNs, "fuzz", std::nullopt);
  fuzz::feed<DisReceiver>(input, kDisTimeOutNs, "fuzz", DisEntityName{0, 0, 1});
  return 0;
}

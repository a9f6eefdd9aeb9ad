#include "feed_script.h"
#include "fuzz_input.h"
#include "link/cigi_receiver.h"

namespace {

using namespace eye;

// What is believed can be said again, and means the same.
void checkAgain(const cigi::Packet& packet, const cigi::Format& format) {
  std::vector<std::byte> bytes;
  if (const auto* control = std::get_if<cigi::IgControl>(&packet)) {
    bytes = cigi::Builder(format, *control).take();
  } else if (const auto* frame = std::get_if<cigi::StartOfFrame>(&packet)) {
    bytes = cigi::Builder(format, *frame).take();
  } else {
    cigi::Builder builder(format, cigi::StartOfFrame{});
    EYE_CHECK(builder.add(packet));
    bytes = builder.take();
  }
  const auto message = cigi::parse(bytes);
  EYE_CHECK(message && message->rejected == 0 && message->packets.back() == packet);
}

void checkAlone(std::span<const std::byte> datagram) {
  const auto message = cigi::parse(datagram);
  if (!message) return;
  EYE_CHECK((message->rejected == 0) == message->firstRejection.empty());
  for (const cigi::Packet& packet : message->packets) checkAgain(packet, message->format);
}

}  // namespace

// One message, and the same bytes as a session of several.
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto input = fuzz::bytesOf(data, size);
  checkAlone(input);
  fuzz::feed<cigi::Receiver>(input, kHostSilenceNs, "fuzz", cigi::ReceiverOptions{}, OpenProbe{});
  return 0;
}

#include "fuzz_input.h"
#include "link/pcap.h"
#include "link/track_file.h"

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace eye;
  const auto file = fuzz::bytesOf(data, size);
  const auto capture = parsePcap(file);
  size_t payload = 0;
  if (capture)
    for (const CapturedDatagram& datagram : capture->datagrams) payload += datagram.payload.size();
  EYE_CHECK(payload <= size);
  if (const auto track = parsePcapTrack(file)) track->at(track->durationS() / 2);
  (void)parsePcapPackets(file, RecordedProtocol::nativeFdm);
  (void)parsePcapPackets(file, RecordedProtocol::cigi);
  return 0;
}

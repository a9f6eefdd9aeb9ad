// xplane://ADDR:PORT: asks X-Plane there for its aircraft's state, again while it is silent.
#include "link/live_source.h"
#include "link/live_sources.h"
#include "link/xplane_receiver.h"

namespace eye {
namespace {

constexpr int kDefaultRateHz = 60;

}  // namespace

OpenedSource openXplane(const std::string& url, const std::string& rest) {
  constexpr const char* kOptions[] = {"rate"};
  const auto parsed = parseHostUrl(url, rest, kOptions);
  if (!parsed) return tl::unexpected(parsed.error());
  const auto endpoint = parseEndpoint(parsed->place, kLoopbackAddress, url);
  if (!endpoint) return tl::unexpected(endpoint.error());
  const auto rateHz = numberOption(*parsed, "rate", 1, kMaxRposRateHz, kDefaultRateHz);
  if (!rateHz) return tl::unexpected(rateHz.error());
  const auto xplane = resolvePeer(*endpoint);
  if (!xplane) return fail(ErrorKind::usage, url + ": " + xplane.error().message);
  // X-Plane answers to where the request comes from: any free port, and loopback alone where it runs here.
  const bool isHere = xplane->address >> 24 == 127;
  auto socket = UdpSocket::listenOn({isHere ? kLoopbackAddress : "0.0.0.0", 0});
  if (!socket) return fail(socket.error().kind, url + ": " + socket.error().message);
  return std::make_unique<LiveSource<XplaneReceiver>>(std::move(*socket), url, HostLock(AllowList::only(*xplane)),
                                                      *xplane, *rateHz);
}

}  // namespace eye

// native-fdm://ADDR:PORT
#include "link/live_source.h"
#include "link/live_sources.h"
#include "link/native_fdm_receiver.h"

namespace eye {

OpenedSource openNativeFdm(const std::string& url, const std::string& rest) {
  constexpr const char* kOptions[] = {"allow", "interface"};
  const auto parsed = parseHostUrl(url, rest, kOptions);
  if (!parsed) return tl::unexpected(parsed.error());
  auto allowed = AllowList::of(*parsed);
  if (!allowed) return tl::unexpected(allowed.error());
  auto socket = listenOn(*parsed);
  if (!socket) return tl::unexpected(socket.error());
  return std::make_unique<LiveSource<NativeFdmReceiver>>(std::move(*socket), url, HostLock(std::move(*allowed)));
}

}  // namespace eye

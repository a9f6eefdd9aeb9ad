// cigi://ADDR:PORT: a CIGI host and this image generator as one of its channels.
#include "link/cigi_receiver.h"
#include "link/live_source.h"
#include "link/live_sources.h"
#include "link/udp_group.h"

namespace eye {

OpenedSource openCigi(const std::string& url, const std::string& rest, const OpenProbe& openProbe) {
  constexpr const char* kOptions[] = {"reply", "view", "database", "allow", "interface"};
  const auto parsed = parseHostUrl(url, rest, kOptions);
  if (!parsed) return tl::unexpected(parsed.error());

  cigi::ReceiverOptions options;
  const auto view = numberOption(*parsed, "view", 0, 65535, 0);
  if (!view) return tl::unexpected(view.error());
  options.viewId = static_cast<uint16_t>(*view);
  const auto database = numberOption(*parsed, "database", 1, 127, 0);
  if (!database) return tl::unexpected(database.error());
  if (*database > 0) options.databaseNumber = static_cast<int8_t>(*database);
  auto allowed = AllowList::of(*parsed);
  if (!allowed) return tl::unexpected(allowed.error());
  const std::string* const text = parsed->find("reply");
  options.silent = text != nullptr && *text == "none";
  if (text != nullptr && !options.silent) {
    const auto place = parseEndpoint(*text, kLoopbackAddress, url + ": reply");
    if (!place) return tl::unexpected(place.error());
    const auto peer = resolvePeer(*place);
    if (!peer) return fail(ErrorKind::usage, url + ": reply: " + peer.error().message);
    options.reply = *peer;
  }

  auto socket = listenOn(*parsed);
  if (!socket) return tl::unexpected(socket.error());
  if (options.reply && reachOf(options.reply->address) == Reach::broadcast) socket->allowBroadcast();
  return std::make_unique<LiveSource<cigi::Receiver>>(std::move(*socket), url, HostLock(std::move(*allowed)), url,
                                                      options, openProbe);
}

}  // namespace eye

// cigi://ADDR:PORT: a CIGI host and this image generator as one of its channels.
#include <fmt/format.h>

#include "link/cigi_receiver.h"
#include "link/live_source.h"
#include "link/live_sources.h"
#include "link/udp_group.h"

namespace eye {

OpenedSource openCigi(const std::string& url, const std::string& rest, const OpenProbe& openProbe) {
  constexpr const char* kOptions[] = {"reply", "answers", "view", "database", "allow", "interface"};
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

  const std::string* const answers = parsed->find("answers");
  if (answers != nullptr && *answers != "yes" && *answers != "no")
    return fail(ErrorKind::usage, fmt::format("{}: answers '{}' is neither yes nor no", url, *answers));
  if (answers != nullptr && options.silent)
    return fail(ErrorKind::usage, url + ": with reply=none nothing is answered: leave answers out");
  options.answers = answers == nullptr || *answers == "yes";

  auto socket = listenOn(*parsed);
  if (!socket) return tl::unexpected(socket.error());
  const bool broadcasts = options.reply && reachOf(options.reply->address) == Reach::broadcast;
  if (broadcasts) socket->allowBroadcast();
  auto source = std::make_unique<LiveSource<cigi::Receiver>>(std::move(*socket), url, HostLock(std::move(*allowed)),
                                                             url, options, openProbe);
  // Channels of one group on one machine share the port that hears it: each answers from one of its own, by which the
  // host tells them apart.
  const auto endpoint = parseEndpoint(parsed->place, kLoopbackAddress, url);
  if (!endpoint) return tl::unexpected(endpoint.error());
  const auto place = resolvePeer(*endpoint);
  if (place && reachOf(place->address) != Reach::one && !options.silent) {
    auto own = UdpSocket::listenOn({"0.0.0.0", 0});
    if (!own) return tl::unexpected(own.error());
    if (broadcasts) own->allowBroadcast();
    source->speakFrom(std::move(*own));
  }
  return source;
}

}  // namespace eye

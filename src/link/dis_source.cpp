// dis://ADDR:PORT: one entity of an exercise, dead-reckoned between its PDUs.
#include <fmt/format.h>

#include <charconv>

#include "link/dis_receiver.h"
#include "link/live_source.h"
#include "link/live_sources.h"

namespace eye {
namespace {

// "site:application:entity".
Result<DisEntityName> parseEntityName(const std::string& text, const std::string& url) {
  uint16_t parts[3] = {};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int i = 0; i < 3; ++i) {
    const auto [stop, problem] = std::from_chars(at, end, parts[i]);
    const bool endsRight = i == 2 ? stop == end : stop != end && *stop == ':';
    if (problem != std::errc() || !endsRight)
      return fail(ErrorKind::usage,
                  fmt::format("{}: entity '{}' is not site:application:entity, each 0 to 65535", url, text));
    at = stop + 1;
  }
  return DisEntityName{parts[0], parts[1], parts[2]};
}

}  // namespace

OpenedSource openDis(const std::string& url, const std::string& rest) {
  constexpr const char* kOptions[] = {"entity", "allow", "interface"};
  const auto parsed = parseHostUrl(url, rest, kOptions);
  if (!parsed) return tl::unexpected(parsed.error());
  std::optional<DisEntityName> wanted;
  if (const std::string* text = parsed->find("entity")) {
    const auto name = parseEntityName(*text, url);
    if (!name) return tl::unexpected(name.error());
    wanted = *name;
  }
  auto allowed = AllowList::of(*parsed);
  if (!allowed) return tl::unexpected(allowed.error());
  auto socket = listenOn(*parsed);
  if (!socket) return tl::unexpected(socket.error());
  return std::make_unique<LiveSource<DisReceiver>>(std::move(*socket), url,
                                                   HostLock(std::move(*allowed), kDisTimeOutNs), url, wanted);
}

}  // namespace eye

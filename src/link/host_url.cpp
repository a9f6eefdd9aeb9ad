#include "link/host_url.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

namespace eye {
namespace {

// A list longer than this is a network: that is a firewall's work.
constexpr size_t kMaxAllowed = 64;

}  // namespace

Result<UdpSocket> listenOn(const HostUrl& url) {
  const auto endpoint = parseEndpoint(url.place, kLoopbackAddress, url.text);
  if (!endpoint) return tl::unexpected(endpoint.error());
  const std::string* const interface = url.find("interface");
  auto socket = UdpSocket::listenOn(*endpoint, interface != nullptr ? *interface : "");
  if (!socket) return fail(socket.error().kind, url.text + ": " + socket.error().message);
  return socket;
}

const std::string* HostUrl::find(const std::string& key) const {
  const auto at = options.find(key);
  return at == options.end() ? nullptr : &at->second;
}

Result<HostUrl> parseHostUrl(const std::string& text, const std::string& rest, std::span<const char* const> known) {
  HostUrl url;
  url.text = text;
  const size_t mark = rest.find('?');
  url.place = rest.substr(0, mark);
  std::string query = mark == std::string::npos ? "" : rest.substr(mark + 1);
  while (!query.empty()) {
    const size_t end = query.find('&');
    const std::string part = query.substr(0, end);
    query = end == std::string::npos ? "" : query.substr(end + 1);
    const size_t equals = part.find('=');
    const std::string key = part.substr(0, equals);
    if (std::find(known.begin(), known.end(), key) == known.end())
      return fail(ErrorKind::usage,
                  fmt::format("{}: '{}' is no option of this host; there are: {}", text, key, fmt::join(known, ", ")));
    if (equals == std::string::npos || equals + 1 == part.size())
      return fail(ErrorKind::usage, fmt::format("{}: option '{}' has no value; write {}=VALUE", text, key, key));
    if (!url.options.emplace(key, part.substr(equals + 1)).second)
      return fail(ErrorKind::usage, fmt::format("{}: option '{}' is given twice", text, key));
  }
  return url;
}

Result<int> numberOption(const HostUrl& url, const std::string& key, int lowest, int highest, int fallback) {
  const std::string* const text = url.find(key);
  if (text == nullptr) return fallback;
  int value = 0;
  const char* const end = text->data() + text->size();
  const auto [stop, problem] = std::from_chars(text->data(), end, value);
  if (problem != std::errc() || stop != end || value < lowest || value > highest)
    return fail(ErrorKind::usage,
                fmt::format("{}: {} '{}' is no whole number from {} to {}", url.text, key, *text, lowest, highest));
  return value;
}

Result<AllowList> AllowList::of(const HostUrl& url) {
  AllowList list;
  const std::string* const text = url.find("allow");
  if (text == nullptr) return list;
  std::string rest = *text;
  while (true) {
    const size_t comma = rest.find(',');
    const auto peer = resolvePeer({rest.substr(0, comma), 0});
    if (!peer) return fail(ErrorKind::usage, fmt::format("{}: allow: {}", url.text, peer.error().message));
    if (list.addresses_.size() == kMaxAllowed)
      return fail(ErrorKind::usage, fmt::format("{}: allow has more than {} addresses", url.text, kMaxAllowed));
    list.addresses_.push_back(peer->address);
    if (comma == std::string::npos) return list;
    rest = rest.substr(comma + 1);
  }
}

AllowList AllowList::only(const Peer& sender) {
  AllowList list;
  list.addresses_.push_back(sender.address);
  return list;
}

bool AllowList::allows(const Peer& sender) const {
  return addresses_.empty() || std::find(addresses_.begin(), addresses_.end(), sender.address) != addresses_.end();
}

tl::unexpected<Error> notAllowed(const Peer& sender) {
  return fail(ErrorKind::badData, fmt::format("{} is not among the addresses that are heard (?allow)", toText(sender)));
}

}  // namespace eye

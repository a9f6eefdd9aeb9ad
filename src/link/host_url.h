// "ADDR:PORT?key=value&key=value": the part of a live host's URL behind its scheme.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "link/udp_socket.h"

namespace eye {

struct HostUrl {
  std::string text;  // all of it, for errors
  std::string place;
  std::map<std::string, std::string> options;
  // Nothing where the URL does not have it.
  const std::string* find(const std::string& key) const;
};

// Usage error for an option that is none of `known`, and for one that is given twice or has no value.
Result<HostUrl> parseHostUrl(const std::string& text, const std::string& rest, std::span<const char* const> known);

// A whole number in an option, `lowest` to `highest`; `fallback` without it.
Result<int> numberOption(const HostUrl& url, const std::string& key, int lowest, int highest, int fallback);

// The socket of the place that the URL says to listen on, loopback unless it gives an address; ?interface=ADDR.
Result<UdpSocket> listenOn(const HostUrl& url);

// Whose datagrams are looked at: ?allow=ADDR[,ADDR...]. Empty: everybody's.
class AllowList {
 public:
  static Result<AllowList> of(const HostUrl& url);
  static AllowList only(const Peer& sender);  // this address
  bool allows(const Peer& sender) const;

 private:
  std::vector<uint32_t> addresses_;
};

// What is said of a sender that is not on it.
tl::unexpected<Error> notAllowed(const Peer& sender);

}  // namespace eye

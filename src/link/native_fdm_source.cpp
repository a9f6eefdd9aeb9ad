// native-fdm://ADDR:PORT: the newest packet's state, as it came.
#include "link/host_url.h"
#include "link/link_thread.h"
#include "link/live_sample.h"
#include "link/live_sources.h"
#include "link/native_fdm.h"

namespace eye {
namespace {

class NativeFdmSource final : public StateSource, private LinkProtocol {
 public:
  NativeFdmSource(UdpSocket socket, AllowList allowed, const std::string& url)
      : socket_(std::move(socket)), allowed_(std::move(allowed)), thread_(socket_, *this, url) {}

  SourceSample sample(double) override {
    const auto newest = mailbox_.take();
    SourceSample sample = liveSample(newest);
    if (newest.state) sample.visibilityM = newest.state->state.visibilityM;
    return sample;
  }
  bool await(int timeoutMs) override { return mailbox_.await(timeoutMs); }
  bool isLive() const override { return true; }
  bool isFixed() const override { return false; }

 private:
  Result<void> take(std::span<const std::byte> datagram, const Peer& sender, int64_t nowNs) override {
    if (!allowed_.allows(sender)) return notAllowed(sender);
    const auto state = parseNativeFdm(datagram);
    if (!state) return tl::unexpected(state.error());
    // The packet's clock stays unused: whole seconds in FlightGear, a constant or ticks in JSBSim.
    newest_ = Arrived<NativeFdmState>{*state, nowNs};
    return {};
  }
  void publish(const HostCounts& counts, int64_t) override { mailbox_.put(newest_, counts); }

  UdpSocket socket_;
  const AllowList allowed_;
  std::optional<Arrived<NativeFdmState>> newest_;  // the link thread's
  Mailbox<Arrived<NativeFdmState>> mailbox_;
  LinkThread thread_;  // last: it uses the others
};

}  // namespace

OpenedSource openNativeFdm(const std::string& url, const std::string& rest) {
  constexpr const char* kOptions[] = {"allow", "interface"};
  const auto parsed = parseHostUrl(url, rest, kOptions);
  if (!parsed) return tl::unexpected(parsed.error());
  auto allowed = AllowList::of(*parsed);
  if (!allowed) return tl::unexpected(allowed.error());
  auto socket = listenOn(*parsed);
  if (!socket) return tl::unexpected(socket.error());
  return std::make_unique<NativeFdmSource>(std::move(*socket), std::move(*allowed), url);
}

}  // namespace eye

// xplane://ADDR:PORT: asks X-Plane there for its aircraft's state, again while it is silent.
#include <fmt/format.h>

#include "link/host_url.h"
#include "link/link_thread.h"
#include "link/live_sample.h"
#include "link/live_sources.h"
#include "link/xplane.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

constexpr int kDefaultRateHz = 60;
constexpr int64_t kAskAgainNs = 1'000'000'000;

class XplaneSource final : public StateSource, private LinkProtocol {
 public:
  XplaneSource(UdpSocket socket, const Peer& xplane, int rateHz, const std::string& url)
      : socket_(std::move(socket)), xplane_(xplane), rateHz_(rateHz), thread_(socket_, *this, url) {}
  ~XplaneSource() override { (void)socket_.sendTo(buildRposRequest(0), xplane_); }  // no more, please

  SourceSample sample(double) override { return liveSample(mailbox_.take()); }
  bool await(int timeoutMs) override { return mailbox_.await(timeoutMs); }
  bool isLive() const override { return true; }
  bool isFixed() const override { return false; }

 private:
  Result<void> take(std::span<const std::byte> datagram, const Peer& sender, int64_t nowNs) override {
    if (sender.address != xplane_.address)
      return fail(ErrorKind::badData, fmt::format("{} is not the X-Plane that was asked", toText(sender)));
    const auto state = parseRpos(datagram);
    if (!state) return tl::unexpected(state.error());
    newest_ = Arrived<RposState>{*state, nowNs};
    return {};
  }

  void publish(const HostCounts& counts, int64_t nowNs) override {
    mailbox_.put(newest_, counts);
    const int64_t heardNs = newest_ ? newest_->arrivedNs : 0;
    if (nowNs - std::max(heardNs, askedNs_) < kAskAgainNs) return;
    askedNs_ = nowNs;
    (void)socket_.sendTo(buildRposRequest(rateHz_), xplane_);
  }

  UdpSocket socket_;
  const Peer xplane_;
  const int rateHz_;
  std::optional<Arrived<RposState>> newest_;  // these two the link thread's
  int64_t askedNs_ = 0;
  Mailbox<Arrived<RposState>> mailbox_;
  LinkThread thread_;  // last: it uses the others
};

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
  return std::make_unique<XplaneSource>(std::move(*socket), *xplane, *rateHz, url);
}

}  // namespace eye

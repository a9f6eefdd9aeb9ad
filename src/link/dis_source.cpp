// dis://ADDR:PORT: one entity of an exercise, dead-reckoned between its PDUs.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <charconv>

#include "link/dis_motion.h"
#include "link/host_url.h"
#include "link/link_thread.h"
#include "link/live_sample.h"
#include "link/live_sources.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

// The standard's time-out: 2.4 heartbeats of 5 s. Then the entity stands still, and another may take its place.
constexpr int64_t kTimeOutNs = 12'000'000'000;

struct EntityName {
  uint16_t site = 0, application = 0, entity = 0;
  bool operator==(const EntityName&) const = default;
};

EntityName nameOf(const DisEntityState& state) {
  return {state.site, state.application, state.entity};
}

class DisSource final : public StateSource, private LinkProtocol {
 public:
  DisSource(UdpSocket socket, AllowList allowed, std::optional<EntityName> wanted, const std::string& url)
      : url_(url),
        socket_(std::move(socket)),
        allowed_(std::move(allowed)),
        wanted_(wanted),
        thread_(socket_, *this, url) {}

  SourceSample sample(double) override {
    const auto newest = mailbox_.take();
    SourceSample sample = liveSample(newest);
    if (!newest.state) return sample;
    const int64_t sinceNs = std::min(monotonicNs() - sample.arrivedNs, kTimeOutNs);
    sample.pose = deadReckoned(newest.state->state, static_cast<double>(sinceNs) * 1e-9);
    if (newest.state->state.deadReckoning > DeadReckoning::hold) sample.carriedToNs = sample.arrivedNs + sinceNs;
    return sample;
  }
  bool await(int timeoutMs) override { return mailbox_.await(timeoutMs); }
  bool isLive() const override { return true; }
  bool isFixed() const override { return false; }

 private:
  Result<void> take(std::span<const std::byte> datagram, const Peer& sender, int64_t nowNs) override {
    if (!allowed_.allows(sender)) return notAllowed(sender);
    const auto state = parseDisEntityState(datagram);
    if (!state) return tl::unexpected(state.error());
    const EntityName name = nameOf(*state);
    const bool isOther = newest_ && nameOf(newest_->state) != name && nowNs - newest_->arrivedNs <= kTimeOutNs;
    if (wanted_ ? *wanted_ != name : isOther) return {};  // the others of the exercise
    if (!newest_ || nameOf(newest_->state) != name)
      spdlog::info("{}: follows entity {}:{}:{} '{}'", url_, name.site, name.application, name.entity, state->marking);
    newest_ = Arrived<DisEntityState>{*state, nowNs};
    return {};
  }
  void publish(const HostCounts& counts, int64_t) override { mailbox_.put(newest_, counts); }

  const std::string url_;
  UdpSocket socket_;
  const AllowList allowed_;
  const std::optional<EntityName> wanted_;
  std::optional<Arrived<DisEntityState>> newest_;  // the link thread's
  Mailbox<Arrived<DisEntityState>> mailbox_;
  LinkThread thread_;  // last: it uses the others
};

// "site:application:entity".
Result<EntityName> parseEntityName(const std::string& text, const std::string& url) {
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
  return EntityName{parts[0], parts[1], parts[2]};
}

}  // namespace

OpenedSource openDis(const std::string& url, const std::string& rest) {
  constexpr const char* kOptions[] = {"entity", "allow", "interface"};
  const auto parsed = parseHostUrl(url, rest, kOptions);
  if (!parsed) return tl::unexpected(parsed.error());
  std::optional<EntityName> wanted;
  if (const std::string* text = parsed->find("entity")) {
    const auto name = parseEntityName(*text, url);
    if (!name) return tl::unexpected(name.error());
    wanted = *name;
  }
  auto allowed = AllowList::of(*parsed);
  if (!allowed) return tl::unexpected(allowed.error());
  auto socket = listenOn(*parsed);
  if (!socket) return tl::unexpected(socket.error());
  return std::make_unique<DisSource>(std::move(*socket), std::move(*allowed), wanted, url);
}

}  // namespace eye

// cigi://ADDR:PORT: a CIGI host and this image generator as one of its channels.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "link/cigi_session.h"
#include "link/ground_desk.h"
#include "link/host_lock.h"
#include "link/host_url.h"
#include "link/link_thread.h"
#include "link/live_sources.h"
#include "link/udp_group.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

struct CigiOptions {
  uint16_t viewId = 0;
  std::optional<Peer> reply;
  bool silent = false;  // nothing is sent at all: another channel answers
  bool answers = true;  // questions about the ground; else Start of Frame alone
  std::optional<int8_t> databaseNumber;
  AllowList allowed;
};

class CigiSource final : public StateSource, private LinkProtocol {
 public:
  CigiSource(UdpSocket socket, std::optional<UdpSocket> replySocket, const CigiOptions& options,
             const OpenProbe& openProbe, const std::string& url)
      : url_(url),
        socket_(std::move(socket)),
        replySocket_(std::move(replySocket)),
        allowed_(options.allowed),
        silent_(options.silent),
        answers_(options.answers && !options.silent),
        session_(options.viewId),
        replies_(options.reply, options.databaseNumber),
        desk_(replies_, openProbe, url),
        thread_(socket_, *this, url) {}

  SourceSample sample(double) override {
    const auto newest = mailbox_.take();
    SourceSample sample;
    sample.live = true;
    sample.counts = newest.counts;
    if (!newest.state) return sample;
    shownHostFrame_ = newest.state->hostFrame;
    const cigi::Snapshot& state = *newest.state;
    const int64_t nowNs = monotonicNs();
    sample.arrivedNs = state.arrivedNs;
    sample.hostFrame = state.hostFrame;
    sample.edges = state.edges;
    sample.julianDayUtc = cigi::julianDayAt(state.sky, nowNs);
    const auto pose = poseOf(state.eye, nowNs);
    if (!pose) return sample;
    sample.valid = true;
    sample.pose = *pose;
    sample.carriedToNs = carriedTo(state.eye, nowNs).value_or(0);
    sample.visibilityM = visibilityAt(state.air, pose->position.altM);
    return sample;
  }

  void frameDone(const FrameReport& report) override {
    if (silent_) return;
    const auto reply = replies_.frame(report, shownHostFrame_, monotonicNs());
    const UdpSocket& socket = replySocket_ ? *replySocket_ : socket_;
    if (reply) (void)socket.sendTo(reply->message, reply->receiver);  // not sent: the next frame's says the same
  }

  bool await(int timeoutMs) override { return mailbox_.await(timeoutMs); }
  bool isLive() const override { return true; }
  bool isFixed() const override { return false; }

 private:
  Result<void> take(std::span<const std::byte> datagram, const Peer& sender, int64_t nowNs) override {
    if (!allowed_.allows(sender)) return notAllowed(sender);
    if (!lock_.mayPass(sender, nowNs))
      return fail(ErrorKind::badData, fmt::format("{} is not heard while {} speaks", toText(sender),
                                                  toText(lock_.host().value_or(Peer{}))));
    const auto message = cigi::parse(datagram);
    if (!message) return tl::unexpected(message.error());
    const auto* control = message->packets.empty() ? nullptr : std::get_if<cigi::IgControl>(&message->packets.front());
    if (control == nullptr)
      return fail(ErrorKind::badData,
                  message->rejected > 0 ? message->firstRejection : "the message is no host's: it has no IG Control");
    if (lock_.heard(sender, nowNs)) {
      session_.reset();
      spdlog::info("{}: host {} speaks CIGI {}.{}", url_, toText(sender), message->format.version.major,
                   message->format.version.minor);
    }
    session_.take(*message, nowNs, url_);
    replies_.heard(sender, message->format, session_.control(), nowNs);
    auto questions = session_.takeQuestions();
    if (answers_) desk_.ask(std::move(questions));
    heard_ = true;
    if (message->rejected > 0) return fail(ErrorKind::badData, message->firstRejection);
    return {};
  }

  void publish(const HostCounts& counts, int64_t) override {
    HostCounts withLost = counts;
    withLost.lost = session_.lostFrames();
    mailbox_.put(heard_ ? std::optional(session_.snapshot()) : std::nullopt, withLost);
  }

  const std::string url_;
  UdpSocket socket_;
  const std::optional<UdpSocket> replySocket_;
  const AllowList allowed_;
  const bool silent_, answers_;
  std::optional<uint32_t> shownHostFrame_;  // the render thread's
  HostLock lock_;
  cigi::Session session_;  // these two the link thread's
  bool heard_ = false;
  cigi::Replies replies_;
  cigi::GroundDesk desk_;
  Mailbox<cigi::Snapshot> mailbox_;
  LinkThread thread_;  // last: it uses the others
};

}  // namespace

OpenedSource openCigi(const std::string& url, const std::string& rest, const OpenProbe& openProbe) {
  constexpr const char* kOptions[] = {"reply", "answers", "view", "database", "allow", "interface"};
  const auto parsed = parseHostUrl(url, rest, kOptions);
  if (!parsed) return tl::unexpected(parsed.error());

  CigiOptions options;
  const auto view = numberOption(*parsed, "view", 0, 65535, 0);
  if (!view) return tl::unexpected(view.error());
  options.viewId = static_cast<uint16_t>(*view);
  const auto database = numberOption(*parsed, "database", 1, 127, 0);
  if (!database) return tl::unexpected(database.error());
  if (*database > 0) options.databaseNumber = static_cast<int8_t>(*database);
  auto allowed = AllowList::of(*parsed);
  if (!allowed) return tl::unexpected(allowed.error());
  options.allowed = std::move(*allowed);
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
  options.answers = answers == nullptr || *answers == "yes";

  auto socket = listenOn(*parsed);
  if (!socket) return tl::unexpected(socket.error());
  // Channels of one group on one machine share the port that hears it: each answers from one of its own, by which the
  // host tells them apart.
  std::optional<UdpSocket> replySocket;
  const auto endpoint = parseEndpoint(parsed->place, kLoopbackAddress, url);
  if (!endpoint) return tl::unexpected(endpoint.error());
  const auto place = resolvePeer(*endpoint);
  if (place && reachOf(place->address) != Reach::one && !options.silent) {
    auto own = UdpSocket::listenOn({"0.0.0.0", 0});
    if (!own) return tl::unexpected(own.error());
    replySocket = std::move(*own);
  }
  return std::make_unique<CigiSource>(std::move(*socket), std::move(replySocket), options, openProbe, url);
}

}  // namespace eye

#include "link/cigi_receiver.h"

#include <fmt/format.h>

#include <utility>

namespace eye::cigi {
namespace {

constexpr int64_t kTickNs = 10'000;
constexpr int64_t kTicksWrapNs = (int64_t{1} << 32) * kTickNs;

const IgControl* controlOf(const Message& message) {
  return message.packets.empty() ? nullptr : std::get_if<IgControl>(&message.packets.front());
}

}  // namespace

Receiver::Receiver(std::string name, const ReceiverOptions& options, const OpenProbe& openProbe)
    : name_(std::move(name)),
      silent_(options.silent),
      answers_(options.answers && !options.silent),
      session_(options.viewId),
      clock_(kTicksWrapNs),
      replies_(options.reply, options.databaseNumber),
      desk_(replies_, openProbe, name_) {}

Result<Message> Receiver::parse(std::span<const std::byte> datagram) const {
  auto message = cigi::parse(datagram);
  if (message && controlOf(*message) == nullptr)
    return fail(ErrorKind::badData,
                message->rejected > 0 ? message->firstRejection : "the message is no host's: it has no IG Control");
  return message;
}

void Receiver::reset() {
  session_.reset();
  clock_.reset();
}

std::string Receiver::greeting(const Message& message) const {
  return fmt::format("speaks CIGI {}.{}", message.format.version.major, message.format.version.minor);
}

Taken Receiver::take(const Message& message, const Peer& sender, int64_t nowNs) {
  const IgControl& control = std::get<IgControl>(message.packets.front());
  // Which message is the newer one the host's frame numbers say, whatever the clock.
  const Moment moment =
      control.ticks ? clock_.take(int64_t{*control.ticks} * kTickNs, nowNs) : Moment{nowNs, false, false};
  Taken taken;
  if (session_.take(message, moment.atNs, name_, nowNs)) taken.moment = moment;
  if (std::exchange(resets_, session_.resets()) != session_.resets()) {
    desk_.forget();
    replies_.forget();
  }
  if (message.rejected > 0) taken.complaint = message.firstRejection;
  replies_.heard(sender, message.format, session_.control(), nowNs);
  auto questions = session_.takeQuestions();
  if (answers_) desk_.ask(std::move(questions));
  return taken;
}

void Receiver::tell(const State& state, int64_t nowNs, SourceSample& sample) {
  sample.hostFrame = state.hostFrame;
  sample.edges = state.edges;
  sample.julianDayUtc = julianDayAt(state.sky, nowNs);
  sample.clouds = state.air.clouds;
  if (sample.valid) sample.visibilityM = visibilityAt(state.air, sample.pose.position.altM);
}

std::optional<Outgoing> Receiver::farewell(int64_t nowNs) {
  if (silent_) return std::nullopt;
  auto reply = replies_.farewell(nowNs);
  if (!reply) return std::nullopt;
  return Outgoing{reply->receiver, std::move(reply->message)};
}

std::optional<Outgoing> Receiver::frameDone(const FrameReport& report, int64_t nowNs) {
  if (silent_) return std::nullopt;
  auto reply = replies_.frame(report, report.shownHostFrame, nowNs);
  if (!reply) return std::nullopt;
  return Outgoing{reply->receiver, std::move(reply->message)};
}

}  // namespace eye::cigi

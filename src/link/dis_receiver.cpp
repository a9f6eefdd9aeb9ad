#include "link/dis_receiver.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>

#include "link/dis_motion.h"

namespace eye {
namespace {

constexpr int64_t kHourNs = 3'600'000'000'000;

}  // namespace

DisEntityName nameOf(const DisEntityState& state) {
  return {state.site, state.application, state.entity};
}

DisReceiver::DisReceiver(std::string name, std::optional<DisEntityName> wanted)
    : name_(std::move(name)), wanted_(wanted), clock_(kHourNs) {}

bool DisReceiver::concerns(const Message& message, int64_t nowNs) const {
  if (wanted_) return *wanted_ == nameOf(message);
  return !follows_ || nameOf(message) == nameOf(state_.entity) || nowNs - heardNs_ > kDisTimeOutNs;
}

void DisReceiver::reset() {
  follows_ = false;
  clock_.reset();
}

std::string DisReceiver::greeting(const Message& message) const {
  return fmt::format("speaks DIS version {}", message.version);
}

Taken DisReceiver::take(const Message& message, const Peer&, int64_t nowNs) {
  const DisEntityName name = nameOf(message);
  if (!follows_ || nameOf(state_.entity) != name) {
    spdlog::info("{}: follows entity {}:{}:{} '{}'", name_, name.site, name.application, name.entity, message.marking);
    clock_.reset();
  } else if (disIsUtc(message.timestamp) != disIsUtc(state_.entity.timestamp)) {
    clock_.reset();  // the sender's own clock and UTC have nothing in common
  }
  const Moment moment = clock_.take(std::llround(disSecondsPastHour(message.timestamp) * 1e9), nowNs);
  heardNs_ = nowNs;
  if (moment.overtaken) return {};
  follows_ = true;
  state_ = {message, moment.atNs};
  return {moment, {}};
}

std::optional<Pose> DisReceiver::poseAt(const State& state, int64_t momentNs) {
  return deadReckoned(state.entity, static_cast<double>(momentNs - state.atNs) * 1e-9);
}

}  // namespace eye

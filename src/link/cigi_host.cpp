#include "link/cigi_host.h"

#include <spdlog/spdlog.h>

#include <chrono>

#include "link/angles.h"
#include "telemetry/trace.h"

namespace eye::cigi {
namespace {

constexpr int kPollMs = 20;
constexpr double kTicksPerS = 100'000;  // of 10 microseconds

const IgControl* controlOf(const Message& message) {
  return message.packets.empty() ? nullptr : std::get_if<IgControl>(&message.packets.front());
}

}  // namespace

std::vector<std::byte> hostMessage(Version version, const HostFrame& frame) {
  IgControl control;
  control.mode = IgMode::operate;
  control.hostFrame = frame.number;
  control.ticks = static_cast<uint32_t>(static_cast<uint64_t>(frame.timeS * kTicksPerS));
  control.igFrame = frame.igFrame;
  Entity entity;
  entity.traits = EntityTraits{};
  entity.place =
      EntityPlace{Clamp::none, 0, frame.pose.rollDeg, frame.pose.pitchDeg, frame.pose.headingDeg, frame.pose.position};
  Builder builder(Format{version, std::endian::native}, control);
  EYE_CHECK(builder.add(entity));
  for (const Packet& request : frame.requests) EYE_CHECK(builder.add(request));
  return builder.take();
}

std::optional<Pose> entityPoseIn(std::span<const std::byte> datagram) {
  const auto message = parse(datagram);
  if (!message || controlOf(*message) == nullptr) return std::nullopt;
  for (const Packet& packet : message->packets) {
    const auto* entity = std::get_if<Entity>(&packet);
    if (entity == nullptr || !entity->place) continue;
    const auto* position = std::get_if<Geodetic>(&entity->place->position);
    if (position == nullptr) return std::nullopt;
    Pose pose{*position, entity->place->yawDeg, entity->place->pitchDeg, entity->place->rollDeg};
    normaliseAngles(pose);
    return pose;
  }
  return std::nullopt;
}

bool isFromHost(std::span<const std::byte> datagram) {
  if (!looksLikeCigi(datagram)) return false;
  const bool isMajor3 = std::to_integer<int>(datagram[2]) == 3;
  return isMajor3 ? std::to_integer<int>(datagram[0]) == 1 : std::to_integer<int>(datagram[2]) == 0;
}

ReplyListener::ReplyListener(const UdpSocket& socket, size_t channels, OnMessage onMessage)
    : socket_(socket),
      onMessage_(std::move(onMessage)),
      channels_(channels),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void ReplyListener::run(const std::stop_token& stop) {
  nameThread("replies");
  std::vector<std::byte> buffer(kMaxDatagramBytes);
  while (!stop.stop_requested()) {
    if (!socket_.wait(kPollMs)) continue;
    Peer sender;
    if (const auto datagram = socket_.receiveFrom(buffer, sender)) take(*datagram, sender);
  }
}

void ReplyListener::take(std::span<const std::byte> datagram, const Peer& sender) {
  const auto message = parse(datagram);
  if (message && onMessage_) onMessage_(sender, *message);
  const std::lock_guard lock(mutex_);
  const auto* start =
      !message || message->packets.empty() ? nullptr : std::get_if<StartOfFrame>(&message->packets.front());
  if (start == nullptr || message->rejected > 0) ++heard_.notUnderstood;
  if (start == nullptr) return;
  ++heard_.starts;
  heard_.newest = *start;
  heard_.overframings += start->overframing ? 1u : 0u;
  heard_.pagings += start->paging ? 1u : 0u;
  igFrame_ = start->igFrame;
  if (start->hostFrame && channels_.heard(sender, *start->hostFrame, start->mode != IgMode::standby))
    spdlog::info("channel {} is back", toText(sender));
  for (const Packet& packet : message->packets) {
    const bool isHeight =
        std::holds_alternative<HeightResponse>(packet) || std::holds_alternative<HeightExtendedResponse>(packet);
    const bool isSight =
        std::holds_alternative<SightResponse>(packet) || std::holds_alternative<SightExtendedResponse>(packet);
    heard_.heights += isHeight ? 1u : 0u;
    heard_.sights += isSight ? 1u : 0u;
  }
  came_.notify_all();
}

HeardReplies ReplyListener::heard() const {
  const std::lock_guard lock(mutex_);
  return heard_;
}

bool ReplyListener::awaitStart(int timeoutMs) {
  std::unique_lock lock(mutex_);
  const bool came =
      came_.wait_for(lock, std::chrono::milliseconds(timeoutMs), [&] { return heard_.starts > awaited_; });
  awaited_ = heard_.starts;
  return came;
}

bool ReplyListener::awaitChannels(uint32_t hostFrame, int timeoutMs) {
  std::unique_lock lock(mutex_);
  return came_.wait_for(lock, std::chrono::milliseconds(timeoutMs), [&] { return channels_.allHave(hostFrame); });
}

HostChannels ReplyListener::channels() const {
  const std::lock_guard lock(mutex_);
  return channels_;
}

void ReplyListener::giveUp(const Peer& channel) {
  const std::lock_guard lock(mutex_);
  channels_.giveUp(channel);
}

}  // namespace eye::cigi

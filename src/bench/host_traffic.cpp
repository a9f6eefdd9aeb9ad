#include "bench/host_traffic.h"

#include <chrono>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "link/cigi_host.h"
#include "link/native_fdm.h"
#include "link/sender.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

constexpr double kStepM = 1e-3;                           // of height, from one number to the next
constexpr double kStepDeg = 1e-6;                         // of latitude: 7 m/s
constexpr double kHeadingDeg = 0;                         // north
constexpr uint32_t kGarbageSeed = 13;                     // any; the same garbage in every run
constexpr size_t kGarbageKinds = 1024, kGarbageRun = 32;  // so many of one length behind one another

cigi::Version versionOf(HostProtocol protocol) {
  return protocol == HostProtocol::cigi40 ? cigi::Version{4, 0} : cigi::Version{3, 3};
}

bool isBelieved(HostProtocol protocol, std::span<const std::byte> datagram) {
  return protocol == HostProtocol::nativeFdm ? parseNativeFdm(datagram).has_value() : cigi::parse(datagram).has_value();
}

void sleepUntil(int64_t atNs) {
  const int64_t leftNs = atNs - monotonicNs();
  if (leftNs > 0) std::this_thread::sleep_for(std::chrono::nanoseconds(leftNs));
}

// Sends those behind one another that are of one length together. A flood comes from the cores that draw: what sending
// it costs must not hide what receiving does.
class EqualRun {
 public:
  explicit EqualRun(const UdpSocket& socket) : socket_(socket) {}
  void add(std::span<const std::byte> datagram) {
    if (count_ == kMost || datagram.size() != eachBytes_) send();
    eachBytes_ = datagram.size();
    bytes_.insert(bytes_.end(), datagram.begin(), datagram.end());
    ++count_;
  }
  void send() {
    if (count_ > 1 && eachBytes_ > 0 && socket_.sendRun(bytes_, eachBytes_)) count_ = 0;
    for (size_t i = 0; i < count_; ++i) (void)socket_.send(std::span(bytes_).subspan(i * eachBytes_, eachBytes_));
    bytes_.clear();
    count_ = 0;
  }

 private:
  static constexpr size_t kMost = 64;

  const UdpSocket& socket_;
  std::vector<std::byte> bytes_;
  size_t count_ = 0, eachBytes_ = 0;
};

}  // namespace

const char* nameOf(HostProtocol protocol) {
  constexpr const char* kNames[] = {"native-fdm", "CIGI 3.3", "CIGI 4.0"};
  return kNames[static_cast<size_t>(protocol)];
}

std::string urlOf(HostProtocol protocol, uint16_t port) {
  return fmt::format("{}://{}:{}", protocol == HostProtocol::nativeFdm ? "native-fdm" : "cigi", kLoopbackAddress, port);
}

std::vector<std::byte> messageOf(HostProtocol protocol, const Pose& pose, uint32_t number, double timeS) {
  if (protocol == HostProtocol::nativeFdm) return buildNativeFdm({pose, std::nullopt});
  return cigi::hostMessage(versionOf(protocol), {number, 0, timeS, pose});
}

Pose NumberedPoses::at(uint32_t number) const {
  return {{start_.latDeg + number * kStepDeg, start_.lonDeg, start_.altM + number * kStepM}, kHeadingDeg, 0, 0};
}

uint32_t NumberedPoses::numberOf(const Pose& pose) const {
  return static_cast<uint32_t>(std::max(0L, std::lround((pose.position.altM - start_.altM) / kStepM)));
}

SteadyHost::SteadyHost(HostProtocol protocol, uint16_t port, const NumberedPoses& poses)
    : poses_(poses),
      startedNs_(monotonicNs()),
      thread_([=, this](const std::stop_token& stop) { run(stop, protocol, port); }) {}

void SteadyHost::run(const std::stop_token& stop, HostProtocol protocol, uint16_t port) {
  const auto socket = UdpSocket::connectTo({kLoopbackAddress, port});
  if (!socket) return;
  for (uint32_t number = 0; !stop.stop_requested(); ++number) {
    const double timeS = number / kHostRateHz;
    sleepUntil(startedNs_ + static_cast<int64_t>(timeS * 1e9));
    const auto message = messageOf(protocol, poses_.at(number), number, timeS);
    {
      const std::lock_guard lock(mutex_);
      sentNs_.push_back(monotonicNs());
    }
    (void)socket->send(message);  // what the network does not take shows as a later number
  }
}

int64_t SteadyHost::sentNs(uint32_t number) const {
  const std::lock_guard lock(mutex_);
  return number < sentNs_.size() ? sentNs_[number] : 0;
}

Flood::Flood(uint16_t port, double rateHz, Next next)
    : startedNs_(monotonicNs()),
      thread_([=, this, next = std::move(next)](const std::stop_token& stop) { run(stop, port, rateHz, next); }) {}

void Flood::run(const std::stop_token& stop, uint16_t port, double rateHz, const Next& next) {
  const auto socket = UdpSocket::connectTo({kLoopbackAddress, port});
  if (!socket) return;
  EqualRun run(*socket);
  uint64_t index = 0;
  constexpr int64_t kBurstNs = 1'000'000;
  for (int64_t atNs = startedNs_; !stop.stop_requested(); atNs += kBurstNs) {
    sleepUntil(atNs);
    const double timeS = static_cast<double>(monotonicNs() - startedNs_) * 1e-9;
    for (const auto due = static_cast<uint64_t>(timeS * rateHz); index < due; ++index) run.add(next(index, timeS));
    run.send();
    sent_ = index;
  }
}

double Flood::sentHz() const {
  return static_cast<double>(sent_) / (static_cast<double>(monotonicNs() - startedNs_) * 1e-9);
}

std::vector<std::vector<std::byte>> garbage(HostProtocol protocol) {
  std::mt19937 random(kGarbageSeed);
  const auto byte = [&] { return static_cast<std::byte>(random() & 0xff); };
  constexpr size_t kMostBytes = 600;
  constexpr size_t kKeptBytes = 5;  // of both protocols: the version
  std::vector<std::vector<std::byte>> all;
  size_t noiseBytes = 0;
  while (all.size() < kGarbageKinds) {
    const size_t run = all.size() / kGarbageRun;
    if (all.size() % kGarbageRun == 0) noiseBytes = random() % kMostBytes;
    const bool isOwn = run % 2 == 1;
    std::vector<std::byte> datagram = isOwn ? messageOf(protocol, Pose{}, 0, 0) : std::vector<std::byte>(noiseBytes);
    for (size_t i = isOwn ? kKeptBytes : 0; i < datagram.size(); ++i) datagram[i] = byte();
    if (!isBelieved(protocol, datagram)) all.push_back(std::move(datagram));
  }
  return all;
}

FlightOverBadLink::FlightOverBadLink(HostProtocol protocol, uint16_t port, std::function<Pose(double timeS)> poseAt,
                                     double durationS, const BadLinkOptions& link)
    : startedNs_(monotonicNs()), thread_([=, this, poseAt = std::move(poseAt)] {
        const auto socket = UdpSocket::connectTo({kLoopbackAddress, port});
        if (!socket) return;
        const PacketSource packets =
            protocol == HostProtocol::nativeFdm
                ? packetsFromPoses(poseAt, durationS, kHostRateHz)
                : cigiPacketsFromPoses(poseAt, durationS, kHostRateHz, versionOf(protocol), [] { return 0u; });
        SendOptions options;
        options.badLink = link;
        sendPackets(packets, *socket, options, stop_, [](const SendReport&) {});
      }) {}

FlightOverBadLink::~FlightOverBadLink() {
  stop_ = true;
}

}  // namespace eye

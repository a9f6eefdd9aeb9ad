#include "bench/host_cases.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>

#include <unistd.h>

#include "link/cigi_host.h"
#include "link/flight_plan.h"
#include "link/host_lock.h"
#include "telemetry/cpu_time.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

constexpr double kKnownS = 0.5;     // until a host's first state has come
constexpr double kLearningS = 1.5;  // of the eye's filter; and until terrain is read
constexpr double kReachM = 4000;    // of questions round a place
constexpr double kAboveM = 400;
constexpr uint32_t kQuestionsSeed = 5;  // any; the same questions in every run

double residentMiB() {
  std::ifstream statm("/proc/self/statm");
  uint64_t size = 0, resident = 0;
  statm >> size >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

// Until the host of the case before counts as gone: CIGI hears one host at a time.
Result<std::vector<ShownFrame>> awaitFreeHost(LiveShow& show) {
  return show.show(static_cast<double>(kHostSilenceNs) * 1e-9 + 0.1);
}

bool isHosts(FloodKind kind) {
  return kind == FloodKind::hostsGarbage || kind == FloodKind::hostsState;
}

// What a flood sends, for as long as it does.
Flood::Next contentsOf(FloodKind kind, HostProtocol protocol, const NumberedPoses& poses) {
  if (kind == FloodKind::hostsState || kind == FloodKind::strangersState) {
    return [=, message = std::vector<std::byte>()](uint64_t index, double timeS) mutable {
      message = messageOf(protocol, poses.at(static_cast<uint32_t>(timeS * kHostRateHz)), static_cast<uint32_t>(index),
                          timeS);
      return std::span<const std::byte>(message);
    };
  }
  if (kind == FloodKind::hostsGarbage) {
    return [=, all = garbage(protocol), message = std::vector<std::byte>(), next = uint32_t{0}](uint64_t index,
                                                                                                double timeS) mutable {
      if (timeS * kHostRateHz < next) return std::span<const std::byte>(all[index % all.size()]);
      message = messageOf(protocol, poses.at(next), next, timeS);
      ++next;
      return std::span<const std::byte>(message);
    };
  }
  return
      [all = garbage(protocol)](uint64_t index, double) { return std::span<const std::byte>(all[index % all.size()]); };
}

// CPU seconds so far of this process's threads of a name.
double threadsCpuS(const std::string& name) {
  double ticks = 0;
  std::error_code failed;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task", failed)) {
    std::string line;
    std::getline(std::ifstream(thread.path() / "stat"), line);
    const size_t open = line.find('('), close = line.rfind(')');
    if (close == std::string::npos || line.substr(open + 1, close - open - 1) != name) continue;
    // Behind the name: state and ten numbers, then user and system time (proc(5), fields 14 and 15).
    std::istringstream fields(line.substr(close + 2));
    std::string skipped;
    for (int field = 3; field < 14; ++field) fields >> skipped;
    double user = 0, system = 0;
    fields >> user >> system;
    ticks += user + system;
  }
  return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

// What a stranger says of the aircraft: a kilometre higher, which no number of the host's own comes to.
NumberedPoses elsewhere(const NumberedPoses& poses) {
  Geodetic start = poses.at(0).position;
  start.altM += 1000;
  return NumberedPoses(start);
}

class QuestionPlaces {
 public:
  explicit QuestionPlaces(const Geodetic& middle) : middle_(middle) {}
  Geodetic next() {
    const double eastM = reach_(random_), northM = reach_(random_);
    return offsetBy(middle_, eastM, northM);
  }

 private:
  Geodetic middle_;
  std::mt19937 random_{kQuestionsSeed};
  std::uniform_real_distribution<> reach_{-kReachM, kReachM};
};

}  // namespace

std::vector<TransportDelay> transportDelays(const std::vector<ShownFrame>& frames, const NumberedPoses& poses,
                                            const SteadyHost& host) {
  std::vector<TransportDelay> delays;
  uint32_t before = 0;
  for (const ShownFrame& frame : frames) {
    const uint32_t number = poses.numberOf(frame.told);
    const int64_t sentNs = host.sentNs(number);
    if (frame.counts.packets == 0 || number == before || sentNs == 0) continue;
    before = number;
    delays.push_back(
        {static_cast<double>(frame.endedNs - sentNs) * 1e-6, static_cast<double>(frame.beganNs - sentNs) * 1e-6});
  }
  return delays;
}

Result<FloodFigures> showUnderFlood(LiveShow& show, HostProtocol protocol, FloodKind kind, const NumberedPoses& poses,
                                    double durationS, std::optional<SteadyHost>& host) {
  FloodFigures figures;
  const auto unread = UdpSocket::listenOn({kLoopbackAddress, 0});
  if (!unread) return tl::unexpected(unread.error());
  // The host's own floods are the host itself, gone wild. A stranger comes when the host is known.
  if (isHosts(kind)) host.reset();
  if (!host)
    if (const auto free = awaitFreeHost(show); !free) return tl::unexpected(free.error());
  if (!host && !isHosts(kind)) {
    host.emplace(protocol, show.port(), poses);
    if (const auto known = show.show(kKnownS); !known) return tl::unexpected(known.error());
  }
  std::optional<Flood> flood;
  if (kind != FloodKind::none)
    flood.emplace(kind == FloodKind::elsewhere ? unread->port() : show.port(), kFloodHz,
                  contentsOf(kind, protocol, kind == FloodKind::strangersState ? elsewhere(poses) : poses));
  const int64_t beganNs = host ? host->startedNs() : flood->startedNs();
  if (const auto started = show.show(kLearningS); !started) return tl::unexpected(started.error());
  const double beforeMiB = residentMiB(), linkBeforeS = threadsCpuS("link");
  const auto frames = show.show(durationS);
  if (!frames) return tl::unexpected(frames.error());
  figures.linkShare = (threadsCpuS("link") - linkBeforeS) / durationS;
  figures.grownMiB = residentMiB() - beforeMiB;
  figures.sentHz = flood ? flood->sentHz() : 0;
  flood.reset();

  size_t followed = 0;
  for (const ShownFrame& frame : *frames) {
    figures.frameMs.push_back(frame.frameMs);
    const double agoS = static_cast<double>(frame.beganNs - beganNs) * 1e-9 - poses.numberOf(frame.told) / kHostRateHz;
    followed += std::abs(agoS) <= kFollowedS;
  }
  const auto& first = frames->front().counts;
  const auto& last = frames->back().counts;
  const double spanS = static_cast<double>(frames->back().beganNs - frames->front().beganNs) * 1e-9;
  figures.receivedHz = static_cast<double>(last.packets - first.packets) / spanS;
  figures.unreadHz = static_cast<double>(last.unread - first.unread) / spanS;
  figures.followedShare = static_cast<double>(followed) / static_cast<double>(frames->size());
  return figures;
}

Result<double> trackErrorM(LiveShow& show, HostProtocol protocol, const std::function<Pose(double)>& poseAt,
                           double durationS, const BadLinkOptions& link) {
  const FlightOverBadLink flight(protocol, show.port(), poseAt, durationS + 2 * kLearningS, link);
  if (const auto learnt = show.show(kLearningS); !learnt) return tl::unexpected(learnt.error());
  const auto frames = show.show(durationS);
  if (!frames) return tl::unexpected(frames.error());
  double squares = 0;
  for (const ShownFrame& frame : *frames) {
    const double atS = static_cast<double>(frame.beganNs - flight.startedNs()) * 1e-9;
    const double offM = glm::distance(ecefFromGeodetic(frame.eye.position), ecefFromGeodetic(poseAt(atS).position));
    squares += offM * offM;
  }
  return std::sqrt(squares / static_cast<double>(frames->size()));
}

std::vector<cigi::GroundQuestion> heightsRound(const Geodetic& place) {
  QuestionPlaces places(place);
  std::vector<cigi::GroundQuestion> questions(kQuestions);
  for (cigi::GroundQuestion& question : questions) {
    question.at = places.next();
    question.request = cigi::HeightRequest{.kind = cigi::HeightKind::both, .point = *question.at};
  }
  return questions;
}

std::vector<cigi::GroundQuestion> sightsRound(const Geodetic& place, double lengthM) {
  QuestionPlaces places({place.latDeg, place.lonDeg, place.altM + kAboveM});
  std::mt19937 random(kQuestionsSeed);
  std::uniform_real_distribution<> turn(0, 2 * std::numbers::pi);
  std::vector<cigi::GroundQuestion> questions(kQuestions);
  for (cigi::GroundQuestion& question : questions) {
    const double azimuthRad = turn(random);
    const Geodetic from = places.next();
    const Geodetic to = offsetBy(from, lengthM * std::sin(azimuthRad), lengthM * std::cos(azimuthRad));
    cigi::SightSegmentRequest request;
    request.extended = true;
    request.source = from, request.destination = to;
    question.request = request;
    question.fromEcefM = question.sourceEcefM = ecefFromGeodetic(from);
    question.toEcefM = ecefFromGeodetic(to);
  }
  return questions;
}

Result<AnswerTimes> timeAnswers(const std::vector<cigi::GroundQuestion>& questions, const OpenProbe& openProbe) {
  constexpr int kRounds = 9;
  const auto probe = openProbe();
  if (!probe) return tl::unexpected(probe.error());
  const auto askAll = [&] {
    const double beganMs = threadCpuMs();
    for (const cigi::GroundQuestion& question : questions) (void)cigi::answerTo(question, probe->get());
    return threadCpuMs() - beganMs;
  };
  AnswerTimes times;
  times.coldMs = askAll();
  std::array<double, kRounds> rounds;
  for (double& round : rounds) round = askAll();
  std::ranges::sort(rounds);
  times.warmMs = rounds[kRounds / 2];
  return times;
}

Result<AskedAndAnswered> askHeights(LiveShow& show, const NumberedPoses& poses, const Geodetic& place,
                                    double durationS) {
  const auto socket = UdpSocket::connectTo({kLoopbackAddress, show.port()});
  if (!socket) return tl::unexpected(socket.error());
  cigi::ReplyListener replies(*socket);
  std::atomic<uint64_t> asked = 0;
  std::jthread asker([&](const std::stop_token& stop) {
    for (uint32_t frame = 0; !stop.stop_requested(); ++frame) {
      (void)replies.awaitStart(100);  // the image generator's pace: a frame's questions for each frame
      auto ask = [&, places = QuestionPlaces(place)](cigi::Builder& builder, int id) mutable {
        return builder.add(cigi::HeightRequest{
            .id = static_cast<uint16_t>(id), .kind = cigi::HeightKind::both, .point = places.next()});
      };
      cigi::IgControl control;
      control.mode = cigi::IgMode::operate;
      control.hostFrame = frame;
      (void)socket->send(messageOf(HostProtocol::cigi33, poses.at(frame), frame, frame / kHostRateHz));
      for (int id = 0; id < kQuestions && !stop.stop_requested();) {
        cigi::Builder builder({{3, 3}, std::endian::native}, control);
        const int firstId = id;
        while (id < kQuestions && ask(builder, id)) ++id;
        (void)socket->send(builder.take());
        asked += static_cast<uint64_t>(id - firstId);
      }
    }
  });
  // The first answers wait until their terrain is read.
  if (const auto read = show.show(kLearningS); !read) return tl::unexpected(read.error());
  const uint64_t askedBefore = asked, answeredBefore = replies.heard().heights;
  const auto frames = show.show(durationS);
  AskedAndAnswered result{asked - askedBefore, replies.heard().heights - answeredBefore, {}};
  asker = {};  // ends it
  if (!frames) return tl::unexpected(frames.error());
  for (const ShownFrame& frame : *frames) result.frameMs.push_back(frame.frameMs);
  return result;
}

}  // namespace eye

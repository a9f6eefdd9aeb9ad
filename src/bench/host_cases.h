// The host suite's cases: each connects a host on the loopback and hands back figures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/live_show.h"
#include "link/state_source.h"

namespace eye {

// Of one packet that showed, in milliseconds.
struct TransportDelay {
  double delayMs = 0;  // from its leaving the host to the end of the first frame that shows it
  double waitMs = 0;   // of these, before that frame began
};
// Frames in which another number shows than in the one before.
std::vector<TransportDelay> transportDelays(const std::vector<ShownFrame>& frames, const NumberedPoses& poses,
                                            const SteadyHost& host);

enum class FloodKind { none, elsewhere, garbage, strangersState, hostsGarbage, hostsState };

struct FloodFigures {
  std::vector<double> frameMs;
  double sentHz = 0, receivedHz = 0, unreadHz = 0;
  double followedShare = 0;  // of the frames that show a pose not older than kFollowedS
  double grownMiB = 0;       // resident memory, from before to after
  double linkShare = 0;      // of a core, that the thread takes which receives
};
inline constexpr double kFloodHz = 100'000;
inline constexpr double kFollowedS = 0.1;
// `elsewhere`: to a socket that nobody reads, so that what sending costs the machine can be told from what receiving
// costs the image generator. `garbage` and `strangersState` come from another address and port than the host's state
// and go to where that arrives; the host's own come from its socket, with its state between them. `host`: that of the
// case before, which goes on where it can, and is left to the next; none at first.
Result<FloodFigures> showUnderFlood(LiveShow& show, HostProtocol protocol, FloodKind kind, const NumberedPoses& poses,
                                    double durationS, std::optional<SteadyHost>& host);

// How far the eye was from where the aircraft was at its frames' times, root mean square, metres; without the first
// seconds, in which the filter learns. Of a show that no host has spoken to yet, like the next.
Result<double> trackErrorM(LiveShow& show, HostProtocol protocol, const std::function<Pose(double)>& poseAt,
                           double durationS, const BadLinkOptions& link);

inline constexpr int kQuestions = 1000;
// A thousand heights round a place; a thousand lines of sight from there, level, in all directions.
std::vector<cigi::GroundQuestion> heightsRound(const Geodetic& place);
std::vector<cigi::GroundQuestion> sightsRound(const Geodetic& place, double lengthM);
// The calling thread's time for all of them, ms: with nothing in memory but what the system keeps of the file; and when
// they have been asked before, the median of some rounds.
struct AnswerTimes {
  double coldMs = 0, warmMs = 0;
};
Result<AnswerTimes> timeAnswers(const std::vector<cigi::GroundQuestion>& questions, const OpenProbe& openProbe);

// A CIGI host that asks for a thousand heights with each of its frames.
struct AskedAndAnswered {
  uint64_t asked = 0, answered = 0;
  std::vector<double> frameMs;
};
Result<AskedAndAnswered> askHeights(LiveShow& show, const NumberedPoses& poses, const Geodetic& place,
                                    double durationS);

}  // namespace eye

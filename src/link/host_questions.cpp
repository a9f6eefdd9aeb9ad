#include "link/host_questions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>

namespace eye::cigi {
namespace {

constexpr std::array kNames{"hat", "hot", "hat-hot", "los", "los-extended"};
constexpr uint32_t kAgainFrames = 60;  // a second of a usual host

Packet requestOf(Ask ask, uint16_t id, uint8_t everyFrames) {
  const BodyOffset itself{};
  if (ask == Ask::los || ask == Ask::losExtended) {
    SightVectorRequest request;
    request.id = id, request.everyFrames = everyFrames;
    request.extended = ask == Ask::losExtended;
    request.maxRangeM = kAheadM;
    request.source = itself;
    return request;
  }
  HeightRequest request;
  request.id = id, request.everyFrames = everyFrames;
  request.kind = ask == Ask::hat   ? HeightKind::aboveTerrain
                 : ask == Ask::hot ? HeightKind::ofTerrain
                                   : HeightKind::both;
  request.point = itself;
  return request;
}

}  // namespace

Result<std::vector<Ask>> parseAsks(const std::vector<std::string>& names) {
  std::vector<Ask> asks;
  for (const std::string& list : names) {
    std::istringstream words(list);
    for (std::string word; std::getline(words, word, ',');) {
      const auto found = std::ranges::find(kNames, word);
      if (found == kNames.end())
        return fail(ErrorKind::usage,
                    fmt::format("--ask '{}' is no question; there are: {}", word, fmt::join(kNames, ", ")));
      const Ask ask = static_cast<Ask>(found - kNames.begin());
      if (std::ranges::find(asks, ask) == asks.end()) asks.push_back(ask);
    }
  }
  return asks;
}

std::vector<Packet> requestsAt(const AskPlan& plan, uint32_t hostFrame) {
  const auto every = static_cast<uint32_t>(plan.everyFrames);
  // In frames in which they are due anyway: each then has one answer, whether it was asked again or not.
  const uint32_t again = (kAgainFrames + every - 1) / every * every;
  std::vector<Packet> packets;
  if (hostFrame != plan.firstFrame && hostFrame % again != 0) return packets;
  for (const Ask ask : plan.asks)
    packets.push_back(
        requestOf(ask, static_cast<uint16_t>(static_cast<int>(ask) + 1), static_cast<uint8_t>(plan.everyFrames)));
  return packets;
}

}  // namespace eye::cigi

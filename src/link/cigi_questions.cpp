// A session's questions about the ground: which are due, and where their points are.
#include <fmt/format.h>

#include <algorithm>

#include "link/cigi_session.h"

namespace eye::cigi {
namespace {

constexpr size_t kMaxRepeating = 256;                          // requests with an update period
constexpr size_t kMaxQuestions = kMaxPackets + kMaxRepeating;  // all that one message can ask

// A datagram that a network has doubled comes again within this; a host that got no answer asks again later than that.
constexpr int64_t kDoubledNs = 100'000'000;
constexpr size_t kMaxAsked = 64;  // datagrams; a thousand heights are a third of them

uint16_t idOf(const GroundRequest& request) {
  return std::visit([](const auto& r) { return r.id; }, request);
}

bool isSameRequest(const GroundRequest& a, const GroundRequest& b) {
  return a.index() == b.index() && idOf(a) == idOf(b);
}

}  // namespace

// True for the same datagram again, within a while of its first.
bool Session::isDoubled(const Message& message, int64_t arrivedNs) {
  if (!message.requestsHash) return false;
  std::erase_if(asked_, [&](const Asked& asked) { return arrivedNs - asked.arrivedNs > kDoubledNs; });
  if (std::ranges::find(asked_, *message.requestsHash, &Asked::requestsHash) != asked_.end()) return true;
  if (asked_.size() == kMaxAsked) asked_.erase(asked_.begin());
  asked_.push_back({*message.requestsHash, arrivedNs});
  return false;
}

void Session::ask(const GroundRequest& request, const Stamp& stamp, const std::string& name) {
  std::erase_if(repeating_, [&](const Repeating& r) { return isSameRequest(r.request, request); });
  const uint8_t everyFrames = std::visit([](const auto& r) { return r.everyFrames; }, request);
  if (everyFrames > 0 && repeating_.size() < kMaxRepeating)
    repeating_.push_back({request, everyFrames, stamp.hostFrame});
  else if (everyFrames > 0)
    remark(name, Remark::tooManyRepeating,
           fmt::format("more than {} requests have an update period: those beyond are answered once", kMaxRepeating));
  if (questions_.size() < kMaxQuestions) questions_.push_back(resolved(request, stamp.hostFrame, stamp.atNs));
}

void Session::repeatQuestions(int64_t nowNs) {
  for (Repeating& repeating : repeating_) {
    if (control_.hostFrame - repeating.answeredFrame < repeating.everyFrames) continue;
    repeating.answeredFrame = control_.hostFrame;
    if (questions_.size() < kMaxQuestions) questions_.push_back(resolved(repeating.request, control_.hostFrame, nowNs));
  }
}

std::vector<GroundQuestion> Session::takeQuestions() {
  return std::exchange(questions_, {});
}

std::optional<Placed> Session::entityPlace(uint16_t id, int64_t nowNs) const {
  EyeChain chain;
  if (!entities_.addChain(id, control_.smoothing, control_.hostFrame, chain)) return std::nullopt;
  return placeOf(chain, nowNs);
}

std::optional<Vec3d> Session::ecefOf(const Point& point, uint16_t entityId, int64_t nowNs) const {
  if (const auto* geodetic = std::get_if<Geodetic>(&point)) return ecefFromGeodetic(*geodetic);
  const auto placed = entityPlace(entityId, nowNs);
  const auto* offset = std::get_if<BodyOffset>(&point);
  if (!placed || offset == nullptr) return std::nullopt;
  return placed->ecefM + placed->ecefFromBody * Vec3d(offset->xM, offset->yM, offset->zM);
}

GroundQuestion Session::resolved(const GroundRequest& request, uint32_t hostFrame, int64_t nowNs) const {
  GroundQuestion question;
  question.request = request;
  question.hostFrameNibble = static_cast<uint8_t>(hostFrame & 0xf);
  const auto wantBody = [&](bool wanted, uint16_t entityId) {
    const auto placed = wanted ? entityPlace(entityId, nowNs) : std::nullopt;
    if (!placed) return;
    question.bodyEcefM = placed->ecefM;
    question.ecefFromBody = placed->ecefFromBody;
  };

  if (const auto* height = std::get_if<HeightRequest>(&request)) {
    if (const auto* geodetic = std::get_if<Geodetic>(&height->point))
      question.at = *geodetic;
    else if (const auto at = ecefOf(height->point, height->entityId, nowNs))
      question.at = geodeticFromEcef(*at);
  } else if (const auto* segment = std::get_if<SightSegmentRequest>(&request)) {
    const uint16_t farId = segment->destinationEntityId.value_or(segment->sourceEntityId);
    question.fromEcefM = ecefOf(segment->source, segment->sourceEntityId, nowNs);
    question.toEcefM = ecefOf(segment->destination, farId, nowNs);
    question.sourceEcefM = question.fromEcefM;
    wantBody(segment->answerInBodyFrame, segment->sourceEntityId);
  } else if (const auto* vector = std::get_if<SightVectorRequest>(&request)) {
    question.sourceEcefM = ecefOf(vector->source, vector->entityId, nowNs);
    // Azimuth and elevation: from north and the horizontal, or from the entity's nose and wings.
    std::optional<Mat3d> ecefFromAxes;
    if (const auto* geodetic = std::get_if<Geodetic>(&vector->source))
      ecefFromAxes = ecefFromNed(geodetic->latDeg, geodetic->lonDeg);
    else if (const auto placed = entityPlace(vector->entityId, nowNs))
      ecefFromAxes = placed->ecefFromBody;
    if (question.sourceEcefM && ecefFromAxes) {
      const Vec3d along = *ecefFromAxes * parentFromBody(vector->azimuthDeg, vector->elevationDeg, 0)[0];
      question.fromEcefM = *question.sourceEcefM + along * vector->minRangeM;
      question.toEcefM = *question.sourceEcefM + along * vector->maxRangeM;
    }
    wantBody(vector->answerInBodyFrame, vector->entityId);
  }
  return question;
}

}  // namespace eye::cigi

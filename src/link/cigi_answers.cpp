// Answers to questions about the ground, as packets.
#include <algorithm>
#include <cmath>

#include "link/ground_probe.h"

namespace eye::cigi {
namespace {

struct Normal {
  double azimuthDeg = 0, elevationDeg = 0;
};

Normal normalOf(const GroundPoint& point) {
  const Mat3d enuFromEcef = glm::transpose(ecefFromEnu(point.position.latDeg, point.position.lonDeg));
  const Vec3d enu = enuFromEcef * point.normalEcef;
  return {degFromRad(std::atan2(enu.x, enu.y)), degFromRad(std::asin(std::clamp(enu.z, -1.0, 1.0)))};
}

Packet heightAnswer(const HeightRequest& request, const GroundQuestion& question, GroundProbe* probe) {
  const auto ground =
      probe != nullptr && question.at ? probe->under(question.at->latDeg, question.at->lonDeg) : std::nullopt;
  if (request.kind == HeightKind::both) {
    HeightExtendedResponse response{request.id, question.hostFrameNibble, std::nullopt};
    if (ground) {
      const Normal normal = normalOf(*ground);
      response.surface = SurfacePoint{question.at->altM - ground->position.altM, ground->position.altM, 0,
                                      normal.azimuthDeg, normal.elevationDeg};
    }
    return response;
  }
  HeightResponse response;
  response.id = request.id;
  response.ofTerrain = request.kind == HeightKind::ofTerrain;
  response.hostFrameNibble = question.hostFrameNibble;
  if (ground) response.heightM = response.ofTerrain ? ground->position.altM : question.at->altM - ground->position.altM;
  return response;
}

// What a ray found; an error where it could not be followed.
struct Sight {
  bool known = false;
  std::optional<GroundPoint> hit;
};

Sight sightOf(const GroundQuestion& question, GroundProbe* probe) {
  if (probe == nullptr || !question.fromEcefM || !question.toEcefM) return {};
  const auto hit = probe->between(*question.fromEcefM, *question.toEcefM);
  if (!hit) return {};
  return {true, *hit};
}

// `isSegment`: then it is known that the other end is seen where nothing is hit; a vector without a hit has no answer.
template <class Request>
Packet sightAnswer(const Request& request, bool isSegment, const GroundQuestion& question, GroundProbe* probe) {
  const Sight sight = sightOf(question, probe);
  const bool valid = sight.known && (sight.hit || isSegment);
  const bool visible = valid && isSegment && !sight.hit;
  Vec3d endEcefM{};
  if (valid) endEcefM = sight.hit ? ecefFromGeodetic(sight.hit->position) : *question.toEcefM;
  const double rangeM = valid ? glm::length(endEcefM - *question.sourceEcefM) : 0;
  if (!request.extended) {
    SightResponse response;
    response.id = request.id;
    response.visible = visible;
    response.hostFrameNibble = question.hostFrameNibble;
    response.responses = 1;
    if (valid) response.rangeM = rangeM;
    return response;
  }
  SightExtendedResponse response;
  response.id = request.id;
  response.valid = valid && (!request.answerInBodyFrame || question.bodyEcefM);
  response.visible = visible;
  response.hostFrameNibble = question.hostFrameNibble;
  response.responses = 1;
  if (!response.valid) return response;
  response.rangeM = rangeM;
  response.inBodyFrame = request.answerInBodyFrame;
  if (request.answerInBodyFrame) {
    const Vec3d body = glm::transpose(question.ecefFromBody) * (endEcefM - *question.bodyEcefM);
    response.latDegOrXM = body.x, response.lonDegOrYM = body.y, response.altMOrZM = body.z;
  } else {
    const Geodetic end = sight.hit ? sight.hit->position : geodeticFromEcef(endEcefM);
    response.latDegOrXM = end.latDeg, response.lonDegOrYM = end.lonDeg, response.altMOrZM = end.altM;
  }
  if (sight.hit) {
    const Normal normal = normalOf(*sight.hit);
    response.normalAzimuthDeg = normal.azimuthDeg, response.normalElevationDeg = normal.elevationDeg;
  }
  return response;
}

}  // namespace

Packet answerTo(const GroundQuestion& question, GroundProbe* probe) {
  if (const auto* height = std::get_if<HeightRequest>(&question.request)) return heightAnswer(*height, question, probe);
  if (const auto* segment = std::get_if<SightSegmentRequest>(&question.request))
    return sightAnswer(*segment, true, question, probe);
  return sightAnswer(std::get<SightVectorRequest>(question.request), false, question, probe);
}

}  // namespace eye::cigi

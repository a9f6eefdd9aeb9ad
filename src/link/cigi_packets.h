// CIGI's packets as the program sees them: one struct a packet, whatever the version and byte order on the wire.
// Angles in degrees, lengths in metres, each as the wire has it and within the ranges of docs/PROTOCOLS.md.
// Body frames are x forward, y right, z down; rotations are applied yaw, pitch, roll.
#pragma once

#include <optional>
#include <variant>

#include "geo/pose.h"
#include "link/entity_type.h"

namespace eye::cigi {

// Metres in the body frame of an entity: the parent, or the one that the packet names.
struct BodyOffset {
  double xM = 0, yM = 0, zM = 0;
  bool operator==(const BodyOffset&) const = default;
};
using Point = std::variant<Geodetic, BodyOffset>;

// ---- host to image generator

enum class IgMode : uint8_t { standby, operate, debug, maintenance };  // the last one only in Start of Frame

struct IgControl {  // once in each message of a host, first
  int8_t databaseNumber = 0;
  IgMode mode = IgMode::standby;
  bool smoothing = false;           // the image generator may extrapolate; 3.3 and later
  bool substituteTypes = false;     // 4.0
  uint32_t hostFrame = 0;           // to 3.1 in synchronous operation: the image generator's frame, sent back
  std::optional<uint32_t> ticks;    // of 10 microseconds; wraps after 11.9 hours
  std::optional<uint32_t> igFrame;  // the last one that the host has received; 3.2 and later
  bool operator==(const IgControl&) const = default;
};

enum class EntityState : uint8_t { standby, active, destroyed };
enum class Clamp : uint8_t { none, nonConformal, conformal };
enum class AnimationState : uint8_t { stop, pause, play, resume };

// What an entity is.
struct EntityTraits {
  EntityState state = EntityState::active;
  bool detectCollisions = false, inheritAlpha = false;
  bool smoothing = false;  // 3.3 and later
  uint8_t alpha = 255;
  uint16_t type = 0;                     // a number agreed between host and image generator
  std::optional<EntityType> entityType;  // 4.0: instead of `type`
  // To 3.3; later in a packet of its own.
  bool animateBackward = false, animateForever = false;
  AnimationState animation = AnimationState::stop;
  bool operator==(const EntityTraits&) const = default;
};

// Where an entity is. A position that is a BodyOffset attaches it to its parent, and the angles are relative to it.
struct EntityPlace {
  Clamp clamp = Clamp::none;
  uint16_t parentId = 0;
  double rollDeg = 0, pitchDeg = 0, yawDeg = 0;
  Point position;
  bool operator==(const EntityPlace&) const = default;
};

// 3.x says both in one packet (Entity Control), 4.0 each in its own (Entity Control, Entity Position).
struct Entity {
  uint16_t id = 0;
  std::optional<EntityTraits> traits;
  std::optional<EntityPlace> place;
  bool operator==(const Entity&) const = default;
};

// What is absent stays as it is. The eye point is in the body frame of the entity.
struct ViewControl {
  uint16_t viewId = 0;
  uint8_t groupId = 0;  // 0: the view, else the whole group
  uint16_t entityId = 0;
  std::optional<double> xM, yM, zM, rollDeg, pitchDeg, yawDeg;
  bool operator==(const ViewControl&) const = default;
};

enum class Mirror : uint8_t { none, horizontal, vertical, both };

// What is absent stays as it is. Half-angles are signed: left and bottom are negative in a symmetric frustum.
struct ViewDefinition {
  uint16_t viewId = 0;
  uint8_t groupId = 0;
  Mirror mirror = Mirror::none;
  uint8_t pixelReplication = 0, viewType = 0;  // meaning up to the image generator
  bool orthographic = false, toTop = false;
  std::optional<double> nearM, farM, leftDegOrM, rightDegOrM, topDegOrM, bottomDegOrM;  // metres when orthographic
  bool operator==(const ViewDefinition&) const = default;
};

// Rate Control, from 4.0 on Velocity Control: for what to do between packets.
struct Velocity {
  uint16_t entityId = 0;
  std::optional<uint8_t> partId;  // of an articulated part, else of the entity
  bool inBodyFrame = false;       // else north, east, down, or the parent's; 3.2 and later
  double xMS = 0, yMS = 0, zMS = 0;
  double rollDegS = 0, pitchDegS = 0, yawDegS = 0;
  bool operator==(const Velocity&) const = default;
};

// Trajectory Definition, from 4.0 on Acceleration Control.
struct Acceleration {
  uint16_t entityId = 0;
  double xMS2 = 0, yMS2 = 0, zMS2 = 0;
  double retardationMS2 = 0, terminalVelocityMS = 0;  // to 3.3
  std::optional<uint8_t> partId;                      // 4.0, like the rest
  bool inBodyFrame = false;
  double rollDegS2 = 0, pitchDegS2 = 0, yawDegS2 = 0;
  bool operator==(const Acceleration&) const = default;
};

struct DateTime {  // UTC
  uint16_t year = 2000;
  uint8_t month = 1, day = 1, hour = 0, minute = 0;
  double second = 0;  // 4.0
  bool operator==(const DateTime&) const = default;
};

struct CelestialSphere {
  bool clockRuns = false, sun = true, moon = false, stars = false;
  std::optional<DateTime> dateTime;
  double starPercent = 0;
  bool operator==(const CelestialSphere&) const = default;
};

struct Atmosphere {
  bool model = false;  // for sensors
  uint8_t humidityPercent = 0;
  double temperatureC = 15, visibilityM = 0, windMS = 0, updraughtMS = 0, windFromDeg = 0, pressureHpa = 1013.25;
  bool operator==(const Atmosphere&) const = default;
};

enum class Scope : uint8_t { global, region, entity };
struct Weather {
  Scope scope = Scope::global;
  uint16_t scopeId = 0;  // of the region or entity
  uint8_t layer = 0;  // 0 ground fog, 1 to 3 clouds, 4 rain, 5 snow, 6 sleet, 7 hail, 8 sand, 9 dust, 10 and more: own
  uint8_t humidityPercent = 0, severity = 0;  // severity 0 to 5, as far as 7 fits
  bool enabled = false, scud = false, gusts = false, lightning = false, topScud = false;  // topScud: 4.0
  // 0 none, 1 altocumulus, 2 altostratus, 3 cirrocumulus, 4 cirrostratus, 5 cirrus, 6 cumulonimbus, 7 cumulus,
  // 8 nimbostratus, 9 stratocumulus, 10 stratus, more: others
  uint8_t cloudType = 0;
  double temperatureC = 0, visibilityM = 0, scudPercent = 0, coveragePercent = 0;
  double baseM = 0, thicknessM = 0, transitionM = 0;
  double windMS = 0, updraughtMS = 0, windFromDeg = 0, pressureHpa = 0, aerosolGM3 = 0;
  double topScudPercent = 0, topTransitionM = 0;  // 4.0
  bool operator==(const Weather&) const = default;
};

enum class HeightKind : uint8_t { aboveTerrain, ofTerrain, both };

struct HeightRequest {  // HAT/HOT Request
  uint16_t id = 0;
  HeightKind kind = HeightKind::aboveTerrain;
  uint8_t everyFrames = 0;  // 0: once; 3.2 and later, as in the next two
  uint16_t entityId = 0;    // in whose frame a BodyOffset is
  Point point;
  bool operator==(const HeightRequest&) const = default;
};

struct SightSegmentRequest {  // Line of Sight Segment Request
  uint16_t id = 0;
  bool extended = false, answerInBodyFrame = false;
  uint8_t alphaThreshold = 0, everyFrames = 0;
  uint16_t sourceEntityId = 0;
  std::optional<uint16_t> destinationEntityId;  // absent: the source's; 3.2 and later
  Point source, destination;
  uint32_t materialMask = 0;
  bool operator==(const SightSegmentRequest&) const = default;
};

struct SightVectorRequest {  // Line of Sight Vector Request
  uint16_t id = 0;
  bool extended = false, answerInBodyFrame = false;
  uint8_t alphaThreshold = 0, everyFrames = 0;
  uint16_t entityId = 0;
  // From true north and the horizontal; from the entity's x axis and xy plane when the source is a BodyOffset.
  double azimuthDeg = 0, elevationDeg = 0;
  double minRangeM = 0, maxRangeM = 0;
  Point source;
  uint32_t materialMask = 0;
  bool operator==(const SightVectorRequest&) const = default;
};

// ---- image generator to host

struct StartOfFrame {         // once in each message of an image generator, first
  int8_t databaseNumber = 0;  // negative while it loads, -128: not available
  uint8_t status = 0;         // 0: all is well; to 3.3
  IgMode mode = IgMode::standby;
  bool hostEarthModel = false;
  uint32_t igFrame = 0;
  std::optional<uint32_t> ticks;                                         // of 10 microseconds
  std::optional<uint32_t> hostFrame;                                     // the last one that has come in; 3.2 and later
  bool overframing = false, paging = false, excessVariableData = false;  // 4.0
  bool operator==(const StartOfFrame&) const = default;
};

struct HeightResponse {
  uint16_t id = 0;
  bool ofTerrain = false;       // else above it
  uint8_t hostFrameNibble = 0;  // the last four bits of the host's frame that asked; 3.2 and later
  std::optional<double> heightM;
  bool operator==(const HeightResponse&) const = default;
};

struct SurfacePoint {
  double aboveTerrainM = 0, ofTerrainM = 0;
  uint32_t material = 0;
  double normalAzimuthDeg = 0, normalElevationDeg = 0;
  bool operator==(const SurfacePoint&) const = default;
};

struct HeightExtendedResponse {
  uint16_t id = 0;
  uint8_t hostFrameNibble = 0;
  std::optional<SurfacePoint> surface;
  bool operator==(const HeightExtendedResponse&) const = default;
};

struct SightResponse {
  uint16_t id = 0;
  bool visible = false;                        // the destination of a segment
  uint8_t hostFrameNibble = 0, responses = 0;  // how many answer the same request
  std::optional<uint16_t> entityId;            // that was hit
  std::optional<double> rangeM;                // from the source to the hit
  bool operator==(const SightResponse&) const = default;
};

struct SightExtendedResponse {
  uint16_t id = 0;
  bool valid = false;
  bool visible = false;
  uint8_t hostFrameNibble = 0, responses = 0;
  std::optional<uint16_t> entityId;
  std::optional<double> rangeM;
  // In the frame that the request asked for. To 3.1 the response repeats that; later it is never set.
  bool inBodyFrame = false;
  double latDegOrXM = 0, lonDegOrYM = 0, altMOrZM = 0;
  uint8_t red = 0, green = 0, blue = 0, alpha = 0;
  uint32_t material = 0;
  double normalAzimuthDeg = 0, normalElevationDeg = 0;
  bool operator==(const SightExtendedResponse&) const = default;
};

using Packet = std::variant<IgControl, Entity, ViewControl, ViewDefinition, Velocity, Acceleration, CelestialSphere,
                            Atmosphere, Weather, HeightRequest, SightSegmentRequest, SightVectorRequest, StartOfFrame,
                            HeightResponse, HeightExtendedResponse, SightResponse, SightExtendedResponse>;

// A question about the ground.
inline bool isRequest(const Packet& packet) {
  return std::holds_alternative<HeightRequest>(packet) || std::holds_alternative<SightSegmentRequest>(packet) ||
         std::holds_alternative<SightVectorRequest>(packet);
}

}  // namespace eye::cigi

#include "link/dis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/byte_reader.h"
#include "base/byte_writer.h"
#include "link/angles.h"
#include "link/pose_limits.h"

namespace eye {
namespace {

constexpr uint8_t kOldestVersion = 5, kNewestVersion = 7;
constexpr uint8_t kEntityState = 1, kFamilyEntity = 1;
constexpr size_t kLengthOffset = 8, kVariableParameterBytes = 16, kMarkingBytes = 11;
constexpr uint8_t kAscii = 1;
constexpr double kMaxAngleRad = 1000;  // as for native-fdm: a float of more has lost the angle
constexpr double kMaxRate = 1e6;       // m/s, m/s^2 and rad/s: against garbage
constexpr double kTicksPerHour = 2147483648.0;

struct Euler {  // radians, against the axes of ecef
  double psi = 0, theta = 0, phi = 0;
};

// ecef from body: turned by psi about z, then theta about y, then phi about x (IEEE 1278.1, 1.3.2).
Mat3d matrixOf(const Euler& e) {
  const double cz = std::cos(e.psi), sz = std::sin(e.psi), cy = std::cos(e.theta), sy = std::sin(e.theta);
  const double cx = std::cos(e.phi), sx = std::sin(e.phi);
  return {Vec3d(cz * cy, sz * cy, -sy), Vec3d(cz * sy * sx - sz * cx, sz * sy * sx + cz * cx, cy * sx),
          Vec3d(cz * sy * cx + sz * sx, sz * sy * cx - cz * sx, cy * cx)};
}

Euler eulerOf(const Mat3d& ecefFromBody) {
  const Vec3d &forward = ecefFromBody[0], &right = ecefFromBody[1], &down = ecefFromBody[2];
  const double level = std::hypot(forward.x, forward.y);
  const double theta = std::atan2(-forward.z, level);
  constexpr double kVertical = 1e-9;  // nose along the Earth's axis: only psi - phi or their sum is left; phi is 0
  if (level < kVertical) return {std::atan2(-right.x, right.y), theta, 0};
  return {std::atan2(forward.y, forward.x), theta, std::atan2(right.z, down.z)};
}

Vec3d readVec3f(ByteReader& reader) {
  const float x = reader.f32(), y = reader.f32(), z = reader.f32();
  return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

void writeVec3f(ByteWriter& writer, const Vec3d& v) {
  for (int i = 0; i < 3; ++i) writer.f32(static_cast<float>(v[i]));
}

EntityType readType(ByteReader& reader) {
  EntityType type;
  type.kind = reader.u8();
  type.domain = reader.u8();
  type.country = reader.u16();
  type.category = reader.u8();
  type.subcategory = reader.u8();
  type.specific = reader.u8();
  type.extra = reader.u8();
  return type;
}

void writeType(ByteWriter& writer, const EntityType& type) {
  writer.u8(type.kind);
  writer.u8(type.domain);
  writer.u16(type.country);
  writer.u8(type.category);
  writer.u8(type.subcategory);
  writer.u8(type.specific);
  writer.u8(type.extra);
}

std::string readMarking(ByteReader& reader) {
  reader.skip(1);  // character set: whatever it is, what prints is kept
  std::string marking;
  for (const std::byte b : reader.bytes(kMarkingBytes)) {
    const char c = std::to_integer<char>(b);
    if (c == '\0') break;
    if (c >= ' ' && c <= '~') marking += c;
  }
  return marking;
}

bool allWithin(const Vec3d& v, double bound) {  // false for NaN
  return std::abs(v.x) <= bound && std::abs(v.y) <= bound && std::abs(v.z) <= bound;
}

Result<void> checkEnvelope(std::span<const std::byte> datagram) {
  if (datagram.size() < kDisEntityStateBytes)
    return fail(ErrorKind::badData, fmt::format("DIS datagram of {} bytes; an Entity State PDU has at least {}",
                                                datagram.size(), kDisEntityStateBytes));
  if (!looksLikeDisEntityState(datagram))
    return fail(ErrorKind::unsupported,
                fmt::format("DIS PDU of version {} and type {}; Entity State (1) of versions {} to {} is understood",
                            std::to_integer<int>(datagram[0]), std::to_integer<int>(datagram[2]), kOldestVersion,
                            kNewestVersion));
  return {};
}

// The PDU's own length against its variable parameters and the datagram.
Result<void> checkLength(size_t pduBytes, size_t variableParameters, size_t datagramBytes) {
  const size_t expected = kDisEntityStateBytes + variableParameters * kVariableParameterBytes;
  if (pduBytes == expected && pduBytes <= datagramBytes) return {};
  return fail(ErrorKind::badData,
              fmt::format("DIS PDU says that it has {} bytes; with {} variable parameters it has {}, and {} are there",
                          pduBytes, variableParameters, expected, datagramBytes));
}

Result<Pose> poseOf(const Vec3d& ecefM, const Euler& euler) {
  if (!allWithin(ecefM, 2 * kMaxAltitudeM))
    return fail(ErrorKind::badData,
                fmt::format("DIS location {} {} {} m is not a number or out of range", ecefM.x, ecefM.y, ecefM.z));
  if (!allWithin({euler.psi, euler.theta, euler.phi}, kMaxAngleRad))
    return fail(ErrorKind::badData, fmt::format("DIS orientation {} {} {} rad is not a number or out of range",
                                                euler.psi, euler.theta, euler.phi));
  const auto position = checkedPosition(geodeticFromEcef(ecefM));
  if (!position) return fail(ErrorKind::badData, "DIS " + position.error().message);
  return poseFromBody(*position, matrixOf(euler));
}

}  // namespace

bool looksLikeDisEntityState(std::span<const std::byte> datagram) {
  ByteReader reader(datagram, std::endian::big);
  const uint8_t version = reader.u8();
  reader.skip(1);  // exercise
  const uint8_t type = reader.u8(), family = reader.u8();
  return reader.ok() && version >= kOldestVersion && version <= kNewestVersion && type == kEntityState &&
         family == kFamilyEntity;
}

Result<DisEntityState> parseDisEntityState(std::span<const std::byte> datagram) {
  if (const auto ok = checkEnvelope(datagram); !ok) return tl::unexpected(ok.error());

  ByteReader reader(datagram, std::endian::big);
  DisEntityState state;
  state.version = reader.u8();
  state.exercise = reader.u8();
  reader.skip(2);  // type, family
  state.timestamp = reader.u32();
  const uint16_t pduBytes = reader.u16();
  reader.skip(2);  // status (version 7), padding
  state.site = reader.u16();
  state.application = reader.u16();
  state.entity = reader.u16();
  state.force = reader.u8();
  const uint8_t variableParameters = reader.u8();
  state.type = readType(reader);
  readType(reader);  // what the other force takes it for
  state.velocityMS = readVec3f(reader);
  const double x = reader.f64(), y = reader.f64(), z = reader.f64();
  const Vec3d angles = readVec3f(reader);
  state.appearance = reader.u32();
  const uint8_t algorithm = reader.u8();
  reader.skip(15);  // other parameters of the algorithm
  state.accelerationMS2 = readVec3f(reader);
  state.turnRateBodyRadS = readVec3f(reader);
  state.marking = readMarking(reader);
  state.capabilities = reader.u32();
  EYE_CHECK(reader.ok() && reader.position() == kDisEntityStateBytes);

  if (const auto ok = checkLength(pduBytes, variableParameters, datagram.size()); !ok)
    return tl::unexpected(ok.error());
  for (const Vec3d& rate : {state.velocityMS, state.accelerationMS2, state.turnRateBodyRadS})
    if (!allWithin(rate, kMaxRate))
      return fail(ErrorKind::badData, fmt::format("DIS velocity, acceleration or turn rate {} {} {} is not a number "
                                                  "or out of range",
                                                  rate.x, rate.y, rate.z));
  const auto pose = poseOf({x, y, z}, {angles.x, angles.y, angles.z});
  if (!pose) return tl::unexpected(pose.error());
  state.pose = *pose;
  state.deadReckoning = algorithm <= static_cast<uint8_t>(DeadReckoning::fvb) ? static_cast<DeadReckoning>(algorithm)
                                                                              : DeadReckoning::other;
  return state;
}

std::vector<std::byte> buildDisEntityState(const DisEntityState& state) {
  ByteWriter writer(std::endian::big);
  writer.u8(state.version);
  writer.u8(state.exercise);
  writer.u8(kEntityState);
  writer.u8(kFamilyEntity);
  writer.u32(state.timestamp);
  EYE_CHECK(writer.size() == kLengthOffset);
  writer.u16(kDisEntityStateBytes);
  writer.zeros(2);
  writer.u16(state.site);
  writer.u16(state.application);
  writer.u16(state.entity);
  writer.u8(state.force);
  writer.u8(0);  // variable parameters
  writeType(writer, state.type);
  writeType(writer, state.type);
  writeVec3f(writer, state.velocityMS);
  const Vec3d ecefM = ecefFromGeodetic(state.pose.position);
  for (int i = 0; i < 3; ++i) writer.f64(ecefM[i]);
  const Euler euler = eulerOf(ecefFromBody(state.pose));
  writeVec3f(writer, {euler.psi, euler.theta, euler.phi});
  writer.u32(state.appearance);
  writer.u8(static_cast<uint8_t>(state.deadReckoning));
  writer.zeros(15);
  writeVec3f(writer, state.accelerationMS2);
  writeVec3f(writer, state.turnRateBodyRadS);
  writer.u8(kAscii);
  for (size_t i = 0; i < kMarkingBytes; ++i)
    writer.u8(i < state.marking.size() ? static_cast<uint8_t>(state.marking[i]) : uint8_t{0});
  writer.u32(state.capabilities);
  return writer.take();
}

double disSecondsPastHour(uint32_t timestamp) {
  return (timestamp >> 1) * 3600.0 / kTicksPerHour;
}

bool disIsUtc(uint32_t timestamp) {
  return (timestamp & 1u) != 0;
}

uint32_t disTimestamp(double secondsPastHour, bool utc) {
  const double ticks = std::clamp(secondsPastHour / 3600.0 * kTicksPerHour, 0.0, kTicksPerHour - 1);
  return static_cast<uint32_t>(std::lround(ticks)) << 1 | (utc ? 1u : 0u);
}

}  // namespace eye

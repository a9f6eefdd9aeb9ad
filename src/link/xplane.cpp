#include "link/xplane.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/byte_reader.h"
#include "base/byte_writer.h"
#include "link/angles.h"
#include "link/pose_limits.h"

namespace eye {
namespace {

constexpr std::string_view kName = "RPOS";
constexpr WordRange kNameAsWord[] = {wordIs(0, 0xffffffff, 0x52504f53)};
constexpr DatagramShape kShapes[] = {{kRposBytes, kRposBytes, kNameAsWord}};
constexpr size_t kHeaderBytes = 5;      // the name and a byte that is 0 in the documents and '4' in truth
constexpr double kMaxAngleDeg = 36000;  // a hundred turns: a float of more has lost the angle
constexpr double kMaxRate = 1e6;        // m, m/s and rad/s: against garbage

void putText(ByteWriter& writer, std::string_view text) {
  for (const char c : text) writer.u8(static_cast<uint8_t>(c));
}

double readF32(ByteReader& reader) {
  return static_cast<double>(reader.f32());
}

bool allWithin(std::initializer_list<double> values, double bound) {  // false for NaN
  return std::ranges::all_of(values, [&](double value) { return std::abs(value) <= bound; });
}

}  // namespace

std::vector<std::byte> buildRposRequest(int rateHz) {
  ByteWriter writer(std::endian::little);
  putText(writer, kName);
  writer.u8(0);
  putText(writer, std::to_string(std::clamp(rateHz, 0, kMaxRposRateHz)));
  writer.u8(0);
  return writer.take();
}

std::span<const DatagramShape> rposShapes() {
  return kShapes;
}

bool looksLikeRpos(std::span<const std::byte> datagram) {
  return datagram.size() == kRposBytes && std::ranges::equal(datagram.first(kName.size()), kName, {},
                                                             [](std::byte b) { return std::to_integer<char>(b); });
}

Result<RposState> parseRpos(std::span<const std::byte> datagram) {
  if (!looksLikeRpos(datagram))
    return fail(ErrorKind::badData, fmt::format("datagram of {} bytes is no RPOS of X-Plane, which has {} and begins "
                                                "with its name",
                                                datagram.size(), kRposBytes));
  ByteReader reader(datagram, std::endian::little);
  reader.skip(kHeaderBytes);
  Geodetic position;
  position.lonDeg = reader.f64();
  position.latDeg = reader.f64();
  position.altM = reader.f64();
  RposState state;
  state.aglM = readF32(reader);
  state.pose.pitchDeg = readF32(reader);
  state.pose.headingDeg = readF32(reader);
  state.pose.rollDeg = readF32(reader);
  // X-Plane's own axes: x east, y up, z south.
  const double eastMS = readF32(reader), upMS = readF32(reader), southMS = readF32(reader);
  state.velocityEnuMS = {eastMS, -southMS, upMS};
  state.rollRateRadS = readF32(reader);
  state.pitchRateRadS = readF32(reader);
  state.yawRateRadS = readF32(reader);
  EYE_CHECK(reader.ok() && reader.remaining() == 0);

  const auto& pose = state.pose;
  if (!allWithin({pose.pitchDeg, pose.headingDeg, pose.rollDeg}, kMaxAngleDeg))
    return fail(ErrorKind::badData,
                fmt::format("RPOS attitude is not a number or out of range: roll {} pitch {} heading {} degrees",
                            pose.rollDeg, pose.pitchDeg, pose.headingDeg));
  if (!allWithin({eastMS, upMS, southMS, state.rollRateRadS, state.pitchRateRadS, state.yawRateRadS}, kMaxRate) ||
      !allWithin({state.aglM}, kMaxAltitudeM))
    return fail(ErrorKind::badData, "RPOS height, velocity or turn rate is not a number or out of range");
  const auto checked = checkedPosition(position);
  if (!checked) return fail(ErrorKind::badData, "RPOS " + checked.error().message);
  state.pose.position = *checked;
  normaliseAngles(state.pose);
  return state;
}

std::vector<std::byte> buildRpos(const RposState& state) {
  ByteWriter writer(std::endian::little);
  putText(writer, kName);
  writer.u8('4');
  writer.f64(state.pose.position.lonDeg);
  writer.f64(state.pose.position.latDeg);
  writer.f64(state.pose.position.altM);
  for (const double value :
       {state.aglM, state.pose.pitchDeg, state.pose.headingDeg, state.pose.rollDeg, state.velocityEnuMS.x,
        state.velocityEnuMS.z, -state.velocityEnuMS.y, state.rollRateRadS, state.pitchRateRadS, state.yawRateRadS})
    writer.f32(static_cast<float>(value));
  return writer.take();
}

}  // namespace eye

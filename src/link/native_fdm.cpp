#include "link/native_fdm.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "base/byte_reader.h"
#include "base/byte_writer.h"
#include "link/angles.h"
#include "link/pose_limits.h"

namespace eye {
namespace {

// Offsets of the fields that lie behind others which an image generator has no use for.
constexpr size_t kLonOffset = 8, kLatOffset = 16, kAltOffset = 24, kAttitudeOffset = 36;
constexpr size_t kClockOffsetV24 = 356, kVisibilityOffsetV24 = 364;
constexpr size_t kClockOffsetV25 = 500, kVisibilityOffsetV25 = 508;
static_assert(kVisibilityOffsetV24 + sizeof(float) <= kNativeFdmBytesV24);
static_assert(kVisibilityOffsetV25 + sizeof(float) <= kNativeFdmBytesV25);

// Hosts may let an angle run on over many turns; a float of more than this has lost the angle (or is garbage).
constexpr double kMaxAngleRad = 1000;

// Garbage may have a header: of bytes at random behind it these let a fiftieth pass.
constexpr std::array<WordRange, 7> wordsOf(uint32_t version) {
  constexpr double kTurnRad = 2 * std::numbers::pi;
  constexpr auto kMostAngleRad = static_cast<float>(kMaxAngleRad);
  return {wordIs(0, 0xffffffff, version),
          doubleWithin(kLonOffset, kTurnRad),
          doubleWithin(kLatOffset, kTurnRad / 4),
          doubleWithin(kAltOffset, kMaxAltitudeM),
          floatWithin(kAttitudeOffset, kMostAngleRad),
          floatWithin(kAttitudeOffset + 4, kMostAngleRad),
          floatWithin(kAttitudeOffset + 8, kMostAngleRad)};
}
constexpr auto kWordsV24 = wordsOf(24), kWordsV25 = wordsOf(25);
constexpr DatagramShape kShapes[] = {{kNativeFdmBytesV24, kNativeFdmBytesV24, kWordsV24},
                                     {kNativeFdmBytesV25, kNativeFdmBytesV25, kWordsV25}};

uint32_t versionOf(std::span<const std::byte> packet) {
  return ByteReader(packet, std::endian::big).u32();
}

std::optional<double> saneVisibility(std::span<const std::byte> packet, size_t offset) {
  ByteReader reader(packet.subspan(offset), std::endian::big);
  const double visibilityM = static_cast<double>(reader.f32());
  if (visibilityM >= kMinVisibilityM && visibilityM <= kMaxVisibilityM) return visibilityM;  // false for NaN
  return std::nullopt;
}

Result<void> checkVersion(std::span<const std::byte> packet) {
  const uint32_t version = versionOf(packet);
  if (looksLikeNativeFdm(packet)) return {};
  return fail(
      ErrorKind::badData,
      fmt::format("native-fdm packet of {} bytes says version {}; expected version 24 with {} or 25 with {} bytes",
                  packet.size(), version, kNativeFdmBytesV24, kNativeFdmBytesV25));
}

}  // namespace

std::span<const DatagramShape> nativeFdmShapes() {
  return kShapes;
}

bool looksLikeNativeFdm(std::span<const std::byte> packet) {
  if (packet.size() == kNativeFdmBytesV24) return versionOf(packet) == 24;
  if (packet.size() == kNativeFdmBytesV25) return versionOf(packet) == 25;
  return false;
}

Result<NativeFdmState> parseNativeFdm(std::span<const std::byte> packet) {
  const auto version = checkVersion(packet);
  if (!version) return tl::unexpected(version.error());

  ByteReader reader(packet, std::endian::big);
  reader.skip(8);  // version, padding
  const double lonRad = reader.f64();
  const double latRad = reader.f64();
  const double altM = reader.f64();
  reader.skip(kAttitudeOffset - reader.position());  // height above ground: the terrain is ours
  const double rollRad = static_cast<double>(reader.f32());
  const double pitchRad = static_cast<double>(reader.f32());
  const double headingRad = static_cast<double>(reader.f32());
  EYE_CHECK(reader.ok());

  for (const double angleRad : {rollRad, pitchRad, headingRad})
    if (!(std::abs(angleRad) <= kMaxAngleRad))
      return fail(ErrorKind::badData,
                  fmt::format("native-fdm attitude is not a number or out of range: roll {} pitch {} "
                              "heading {} rad",
                              rollRad, pitchRad, headingRad));
  const auto position = checkedPosition({degFromRad(latRad), degFromRad(lonRad), altM});
  if (!position) return fail(ErrorKind::badData, "native-fdm " + position.error().message);

  NativeFdmState state;
  state.pose = {*position, degFromRad(headingRad), degFromRad(pitchRad), degFromRad(rollRad)};
  normaliseAngles(state.pose);
  const bool v24 = packet.size() == kNativeFdmBytesV24;
  state.clockTicks = ByteReader(packet.subspan(v24 ? kClockOffsetV24 : kClockOffsetV25), std::endian::big).u32();
  state.visibilityM = saneVisibility(packet, v24 ? kVisibilityOffsetV24 : kVisibilityOffsetV25);
  return state;
}

std::vector<std::byte> buildNativeFdm(const NativeFdmState& state) {
  ByteWriter writer(std::endian::big);
  writer.u32(24);
  writer.u32(0);
  writer.f64(radFromDeg(state.pose.position.lonDeg));
  writer.f64(radFromDeg(state.pose.position.latDeg));
  writer.f64(state.pose.position.altM);
  writer.zeros(kAttitudeOffset - writer.size());
  writer.f32(static_cast<float>(radFromDeg(state.pose.rollDeg)));
  writer.f32(static_cast<float>(radFromDeg(state.pose.pitchDeg)));
  writer.f32(static_cast<float>(radFromDeg(state.pose.headingDeg)));
  writer.zeros(kClockOffsetV24 - writer.size());
  writer.u32(state.clockTicks);
  writer.zeros(kVisibilityOffsetV24 - writer.size());
  writer.f32(static_cast<float>(state.visibilityM.value_or(0)));
  writer.zeros(kNativeFdmBytesV24 - writer.size());
  return writer.take();
}

}  // namespace eye

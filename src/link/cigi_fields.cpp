#include "link/cigi_fields.h"

#include <fmt/format.h>

#include <cmath>

#include "base/byte_reader.h"
#include "base/error.h"
#include "link/angles.h"
#include "link/pose_limits.h"

namespace eye::cigi {
namespace {

constexpr Range kLatitude{"latitude", -90, 90};
constexpr Range kLongitude{"longitude", -360, 360};
constexpr Range kOffset{"offset", -1e8, 1e8};
constexpr uint32_t kDayOfDate = 10'000, kMonthOfDate = 1'000'000;  // MMDDYYYY

At next(At at, uint8_t bytes) {
  const auto later = [&](uint8_t offset) { return static_cast<uint8_t>(offset == kAbsent ? kAbsent : offset + bytes); };
  return {later(at.v3), later(at.v4)};
}

int daysIn(int month, int year) {
  if (month == 2) return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) ? 29 : 28;
  return month == 4 || month == 6 || month == 9 || month == 11 ? 30 : 31;
}

}  // namespace

void FieldReader::reject(std::string why) {
  if (!problem_) problem_ = std::move(why);
}

void FieldReader::require(bool holds, const char* why) {
  if (!holds) reject(why);
}

uint64_t FieldReader::load(At at, size_t count) {
  const size_t offset = at.in(format_.version);
  EYE_CHECK(offset + count <= packet_.size());  // whoever made this reader has looked at the size
  ByteReader reader(packet_.subspan(offset, count), format_.order);
  switch (count) {
    case 1:
      return reader.u8();
    case 2:
      return reader.u16();
    case 4:
      return reader.u32();
    default:
      return reader.u64();
  }
}

void FieldReader::check(double value, const Range& range) {
  if (value >= range.lowest && value <= range.highest) return;
  if (!std::isfinite(value))
    reject(fmt::format("{} is not a finite number", range.name));
  else
    reject(fmt::format("{} {} is outside {} to {}", range.name, value, range.lowest, range.highest));
}

void FieldReader::u8(At at, uint8_t& value) {
  if (has(at)) value = static_cast<uint8_t>(load(at, 1));
}

void FieldReader::u8(At at, uint8_t& value, const Range& range) {
  u8(at, value);
  check(value, range);
}

void FieldReader::i8(At at, int8_t& value) {
  if (has(at)) value = static_cast<int8_t>(load(at, 1));
}

void FieldReader::u16(At at, uint16_t& value) {
  if (has(at)) value = static_cast<uint16_t>(load(at, 2));
}

void FieldReader::u32(At at, uint32_t& value) {
  if (has(at)) value = static_cast<uint32_t>(load(at, 4));
}

void FieldReader::f32(At at, double& value, const Range& range) {
  if (!has(at)) return;
  value = static_cast<double>(std::bit_cast<float>(static_cast<uint32_t>(load(at, 4))));
  check(value, range);
}

void FieldReader::f64(At at, double& value, const Range& range) {
  if (!has(at)) return;
  value = std::bit_cast<double>(load(at, 8));
  check(value, range);
}

void FieldReader::bits(At at, uint8_t mask, uint8_t& value) {
  if (has(at)) value = static_cast<uint8_t>((load(at, 1) & mask) >> std::countr_zero(mask));
}

void FieldReader::flag(At at, uint8_t mask, bool& value) {
  if (has(at)) value = (load(at, 1) & mask) != 0;
}

void FieldReader::frame(At at, uint8_t mask, Point& point) {
  if (!has(at)) return;
  bool inBodyFrame = false;
  flag(at, mask, inBodyFrame);
  if (inBodyFrame)
    point = BodyOffset{};
  else
    point = Geodetic{};
}

void FieldReader::point(At at, Point& point, double lowestAltitudeM) {
  const At second = next(at, 8), third = next(at, 16);
  if (auto* offset = std::get_if<BodyOffset>(&point)) {
    f64(at, offset->xM, kOffset);
    f64(second, offset->yM, kOffset);
    f64(third, offset->zM, kOffset);
    return;
  }
  auto& geodetic = std::get<Geodetic>(point);
  f64(at, geodetic.latDeg, kLatitude);
  f64(second, geodetic.lonDeg, kLongitude);
  f64(third, geodetic.altM, {"altitude", lowestAltitudeM, kMaxAltitudeM});
  if (!problem_ && std::abs(geodetic.lonDeg) > 180.0) geodetic.lonDeg = wrappedDeg180(geodetic.lonDeg);
}

void FieldReader::date(At at, DateTime& date) {
  uint32_t number = 0;
  u32(at, number);
  const uint32_t year = number % kDayOfDate, month = number / kMonthOfDate, day = number / kDayOfDate % 100;
  if (year < 1 || month < 1 || month > 12 || day < 1 ||
      day > static_cast<uint32_t>(daysIn(static_cast<int>(month), static_cast<int>(year)))) {
    reject(fmt::format("date {} is no MMDDYYYY", number));
    return;
  }
  date.year = static_cast<uint16_t>(year);
  date.month = static_cast<uint8_t>(month);
  date.day = static_cast<uint8_t>(day);
}

void FieldWriter::store(At at, uint64_t value, size_t count) {
  if (!has(at)) return;
  const size_t offset = at.in(format_.version);
  EYE_CHECK(offset + count <= packet_.size());
  for (size_t i = 0; i < count; ++i) {
    const size_t significance = format_.order == std::endian::big ? count - 1 - i : i;
    packet_[offset + i] = static_cast<std::byte>(value >> (8 * significance) & 0xff);
  }
}

void FieldWriter::bits(At at, uint8_t mask, uint8_t value) {
  if (!has(at)) return;
  const size_t offset = at.in(format_.version);
  EYE_CHECK(offset < packet_.size());
  const auto inPlace = static_cast<std::byte>((value << std::countr_zero(mask)) & mask);
  packet_[offset] = (packet_[offset] & static_cast<std::byte>(~mask)) | inPlace;
}

void FieldWriter::point(At at, const Point& point, double) {
  const At second = next(at, 8), third = next(at, 16);
  if (const auto* offset = std::get_if<BodyOffset>(&point)) {
    f64(at, offset->xM, kOffset);
    f64(second, offset->yM, kOffset);
    f64(third, offset->zM, kOffset);
    return;
  }
  const auto& geodetic = std::get<Geodetic>(point);
  f64(at, geodetic.latDeg, kLatitude);
  f64(second, geodetic.lonDeg, kLongitude);
  f64(third, geodetic.altM, {"altitude", 0, 0});
}

void FieldWriter::date(At at, const DateTime& date) {
  u32(at, date.month * kMonthOfDate + date.day * kDayOfDate + date.year);
}

}  // namespace eye::cigi

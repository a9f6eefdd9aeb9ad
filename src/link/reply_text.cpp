#include "link/reply_text.h"

#include <fmt/format.h>

namespace eye::cigi {
namespace {

constexpr double kTicksPerS = 100'000;  // of 10 microseconds

std::string lineOf(const StartOfFrame& start) {
  std::string line =
      fmt::format("Start of Frame {}, {}, database {}", start.igFrame, textOf(start.mode), start.databaseNumber);
  if (start.hostFrame) line += fmt::format(", host frame {}", *start.hostFrame);
  if (start.ticks) line += fmt::format(", clock {:.5f} s", *start.ticks / kTicksPerS);
  if (start.status != 0) line += fmt::format(", status {}", start.status);
  if (start.overframing) line += ", overframing";
  if (start.paging) line += ", paging";
  return line;
}

std::string normalText(double azimuthDeg, double elevationDeg) {
  return fmt::format("normal azimuth {:.1f} elevation {:.1f}", azimuthDeg, elevationDeg);
}

// The last four bits are all that an answer tells of the host frame that asked.
std::string headOf(const char* what, uint16_t id, uint8_t nibble) {
  return fmt::format("{} {} (host frame ...{:x})", what, id, nibble);
}

std::string lineOf(const HeightResponse& r) {
  const std::string head = headOf(r.ofTerrain ? "HOT" : "HAT", r.id, r.hostFrameNibble);
  return r.heightM ? fmt::format("{}: {:.2f} m", head, *r.heightM) : head + ": not valid";
}

std::string lineOf(const HeightExtendedResponse& r) {
  const std::string head = headOf("HAT/HOT", r.id, r.hostFrameNibble);
  if (!r.surface) return head + ": not valid";
  return fmt::format("{}: HAT {:.2f} m, HOT {:.2f} m, {}, material {}", head, r.surface->aboveTerrainM,
                     r.surface->ofTerrainM, normalText(r.surface->normalAzimuthDeg, r.surface->normalElevationDeg),
                     r.surface->material);
}

std::string lineOf(const SightResponse& r) {
  const std::string head = headOf("LOS", r.id, r.hostFrameNibble);
  if (!r.rangeM) return head + ": nothing met, or not valid";
  return fmt::format("{}: {} {:.2f} m", head, r.visible ? "visible, range" : "met at", *r.rangeM);
}

std::string lineOf(const SightExtendedResponse& r) {
  const std::string head = headOf("LOS extended", r.id, r.hostFrameNibble);
  if (!r.valid) return head + ": nothing met, or not valid";
  const std::string place = r.inBodyFrame
                                ? fmt::format("x {:.2f} y {:.2f} z {:.2f} m", r.latDegOrXM, r.lonDegOrYM, r.altMOrZM)
                                : fmt::format("{:.6f} {:.6f} {:.2f} m", r.latDegOrXM, r.lonDegOrYM, r.altMOrZM);
  return fmt::format("{}: {} {:.2f} m, {}, {}", head, r.visible ? "visible, range" : "met at", r.rangeM.value_or(0),
                     place, normalText(r.normalAzimuthDeg, r.normalElevationDeg));
}

template <class Other>
std::string lineOf(const Other&) {
  return "";
}

}  // namespace

std::string textOf(IgMode mode) {
  constexpr const char* kNames[] = {"standby", "operate", "debug", "maintenance"};
  return kNames[static_cast<size_t>(mode)];
}

std::string textOf(const Packet& packet) {
  return std::visit([](const auto& p) { return lineOf(p); }, packet);
}

}  // namespace eye::cigi

// Layouts of the packets that set sky and weather; see cigi_layout_host.h.
#pragma once

#include "link/cigi_fields.h"
#include "link/cigi_ranges.h"

namespace eye::cigi {

template <class Io>
void layout(Io& io, Of<Io, CelestialSphere>& p) {
  io.flag({4, 4}, 0x01, p.clockRuns);
  io.flag({4, 4}, 0x02, p.sun);
  io.flag({4, 4}, 0x04, p.moon);
  io.flag({4, 4}, 0x08, p.stars);
  io.f32({12, 16}, p.starPercent, kPercent);
  io.present({4, 4}, 0x10, p.dateTime);
  if (!p.dateTime) return;
  io.u8({2, 6}, p.dateTime->hour, kHour);
  io.u8({3, 7}, p.dateTime->minute, kMinute);
  io.f32({kAbsent, 8}, p.dateTime->second, kSecond);
  io.date({8, 12}, *p.dateTime);
}

template <class Io>
void layout(Io& io, Of<Io, Atmosphere>& p) {
  io.flag({2, kAbsent}, 0x01, p.model);
  io.flag({kAbsent, 4}, 0x80, p.model);
  io.u8({3, kAbsent}, p.humidityPercent);
  io.bits({kAbsent, 4}, 0x7f, p.humidityPercent);
  io.require(p.humidityPercent <= 100, "humidity is beyond 100 %");
  io.f32({4, 8}, p.temperatureC, kTemperature);
  io.f32({8, 12}, p.visibilityM, kVisibility);
  io.f32({12, 16}, p.windMS, kWind);
  io.f32({16, 20}, p.updraughtMS, kWind);
  io.f32({20, 24}, p.windFromDeg, kDirection);
  io.f32({24, 28}, p.pressureHpa, kPressure);
}

template <class Io>
void layout(Io& io, Of<Io, Weather>& p) {
  io.u16({2, 8}, p.scopeId);
  io.u8({4, 4}, p.layer);
  io.u8({5, 5}, p.humidityPercent, kPercent);
  io.flag({6, 6}, 0x01, p.enabled);
  io.flag({6, 6}, 0x02, p.scud);
  io.flag({6, 6}, 0x04, p.gusts);
  io.flag({6, 6}, 0x08, p.lightning);
  io.bits({6, 6}, 0xf0, p.cloudType);
  io.choice({7, 7}, 0x03, p.scope, Scope::entity, "scope");
  io.bits({7, 7}, 0x1c, p.severity);
  io.flag({kAbsent, 7}, 0x20, p.topScud);
  io.f32({8, 12}, p.temperatureC, kTemperature);
  io.f32({12, 16}, p.visibilityM, kVisibility);
  io.f32({16, 20}, p.scudPercent, kPercent);
  io.f32({20, 24}, p.coveragePercent, kPercent);
  io.f32({24, 28}, p.baseM, kCloudBase);
  io.f32({28, 32}, p.thicknessM, kCloudDepth);
  io.f32({32, 36}, p.transitionM, kCloudDepth);
  io.f32({36, 40}, p.windMS, kWind);
  io.f32({40, 44}, p.updraughtMS, kWind);
  io.f32({44, 48}, p.windFromDeg, kDirection);
  io.f32({48, 52}, p.pressureHpa, kPressure);
  io.f32({52, 56}, p.aerosolGM3, kAerosol);
  io.f32({kAbsent, 60}, p.topScudPercent, kPercent);
  io.f32({kAbsent, 64}, p.topTransitionM, kCloudDepth);
}

}  // namespace eye::cigi

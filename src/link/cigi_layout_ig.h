// Layouts of the packets from image generator to host; see cigi_layout_host.h.
#pragma once

#include "link/cigi_fields.h"
#include "link/cigi_ranges.h"

namespace eye::cigi {

template <class Io>
void layout(Io& io, Of<Io, StartOfFrame>& p) {
  io.i8({3, 5}, p.databaseNumber);
  io.u8({4, kAbsent}, p.status);
  io.choice({5, 7}, 0x03, p.mode, IgMode::maintenance, "mode");
  io.flag({5, 7}, 0x08, p.hostEarthModel);
  io.u32({8, 8}, p.igFrame);
  io.present({5, 7}, 0x04, p.ticks);
  if (p.ticks) io.u32({12, 12}, *p.ticks);
  if (p.hostFrame) io.u32({16, 16}, *p.hostFrame);
  // A word of 16 bits whose upper eight hold the flags.
  const auto upperByte = static_cast<uint8_t>(io.bigEndian() ? 20 : 21);
  io.flag({kAbsent, upperByte}, 0x01, p.overframing);
  io.flag({kAbsent, upperByte}, 0x02, p.paging);
  io.flag({kAbsent, upperByte}, 0x04, p.excessVariableData);
}

template <class Io>
void layout(Io& io, Of<Io, HeightResponse>& p) {
  io.u16({2, 6}, p.id);
  io.flag({4, 4}, 0x02, p.ofTerrain);
  if (io.since(2)) io.bits({4, 4}, 0xf0, p.hostFrameNibble);
  io.present({4, 4}, 0x01, p.heightM);
  if (p.heightM) io.f64({8, 8}, *p.heightM, kHeight);
}

template <class Io>
void layout(Io& io, Of<Io, HeightExtendedResponse>& p) {
  io.u16({2, 6}, p.id);
  if (io.since(2)) io.bits({4, 4}, 0xf0, p.hostFrameNibble);
  io.present({4, 4}, 0x01, p.surface);
  if (!p.surface) return;
  io.f64({8, 8}, p.surface->aboveTerrainM, kHeight);
  io.f64({16, 16}, p.surface->ofTerrainM, kHeight);
  io.u32({24, 24}, p.surface->material);
  io.f32({28, 28}, p.surface->normalAzimuthDeg, kAzimuth);
  io.f32({32, 32}, p.surface->normalElevationDeg, kElevation);
}

template <class Io>
void layout(Io& io, Of<Io, SightResponse>& p) {
  io.u16({2, 4}, p.id);
  io.flag({4, 8}, 0x04, p.visible);
  if (io.since(2)) io.bits({4, 8}, 0xf0, p.hostFrameNibble);
  io.u8({5, 9}, p.responses);
  io.present({4, 8}, 0x02, p.entityId);
  if (p.entityId) io.u16({6, 6}, *p.entityId);
  io.present({4, 8}, 0x01, p.rangeM);
  if (p.rangeM) io.f64({8, 16}, *p.rangeM, kRange);
}

template <class Io>
void layout(Io& io, Of<Io, SightExtendedResponse>& p) {
  io.u16({2, 4}, p.id);
  io.flag({4, 8}, 0x01, p.valid);
  io.flag({4, 8}, 0x08, p.visible);
  if (io.since(2))
    io.bits({4, 8}, 0xf0, p.hostFrameNibble);
  else
    io.flag({4, kAbsent}, 0x10, p.inBodyFrame);
  io.u8({5, 9}, p.responses);
  io.present({4, 8}, 0x02, p.entityId);
  if (p.entityId) io.u16({6, 6}, *p.entityId);
  io.present({4, 8}, 0x04, p.rangeM);
  if (p.rangeM) io.f64({8, 16}, *p.rangeM, kRange);
  if (!p.valid) return;
  io.f64({16, 24}, p.latDegOrXM, kCoordinate);
  io.f64({24, 32}, p.lonDegOrYM, kCoordinate);
  io.f64({32, 40}, p.altMOrZM, kCoordinate);
  io.u8({40, 48}, p.red);
  io.u8({41, 49}, p.green);
  io.u8({42, 50}, p.blue);
  io.u8({43, 51}, p.alpha);
  io.u32({44, 52}, p.material);
  io.f32({48, 56}, p.normalAzimuthDeg, kAzimuth);
  io.f32({52, 60}, p.normalElevationDeg, kElevation);
}

}  // namespace eye::cigi

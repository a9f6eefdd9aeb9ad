// Random CIGI packets within the ranges of the protocol, with values that a float on the wire keeps.
#pragma once

#include <random>

#include "link/cigi.h"

namespace eye::test {

class RandomCigi {
 public:
  RandomCigi(uint64_t seed, cigi::Version version)
      : random_(seed), is4_(version.major == 4), isNew_(cigi::isSince(version, 2)), is33_(cigi::isSince(version, 3)) {}

  // One of the packets of the variant, by its index; without its parts that the version does not have.
  cigi::Packet packet(size_t alternative) {
    switch (alternative) {
      case 0:
        return igControl();
      case 1:
        return entity();
      case 2:
        return cigi::ViewControl{u16(),           u8(),          u16(),
                                 some(-99, 99),   some(-99, 99), some(-99, 99),
                                 some(-180, 180), some(-90, 90), some(0, 360)};
      case 3:
        return viewDefinition();
      case 4:
        return cigi::Velocity{u16(),        maybe(u8()), isNew_ && flag(), f(-900, 900), f(-900, 900),
                              f(-900, 900), f(-90, 90),  f(-90, 90),       f(-90, 90)};
      case 5:
        return acceleration();
      case 6:
        return celestial();
      case 7:
        return cigi::Atmosphere{flag(), percent(), f(-60, 50), f(0, 1e5), f(0, 60), f(-9, 9), f(0, 360), f(900, 1100)};
      case 8:
        return weather();
      case 9:
        return cigi::HeightRequest{u16(), cigi::HeightKind(random_() % 3), period(), u16(), point()};
      case 10:
        return cigi::SightSegmentRequest{
            u16(),   flag(),  flag(), u8(), period(), u16(), isNew_ ? maybe(u16()) : std::nullopt,
            point(), point(), u32()};
      case 11:
        return cigi::SightVectorRequest{u16(),        flag(),     flag(),   u8(),       period(), u16(),
                                        f(-180, 180), f(-90, 90), f(0, 10), f(10, 9e4), point(),  u32()};
      case 12:
        return startOfFrame();
      case 13:
        return cigi::HeightResponse{u16(), flag(), nibble(), maybe(d(-500, 9000))};
      case 14:
        return cigi::HeightExtendedResponse{
            u16(), nibble(), maybe(cigi::SurfacePoint{d(-9, 9000), d(-500, 9000), u32(), f(-180, 180), f(-90, 90)})};
      case 15:
        return cigi::SightResponse{u16(), flag(), nibble(), u8(), maybe(u16()), maybe(d(0, 1e6))};
      default:
        return sightExtendedResponse();
    }
  }

  cigi::IgControl igControl() {
    return {i8(),
            cigi::IgMode(random_() % 3),
            is33_ && flag(),
            is4_ && flag(),
            u32(),
            maybe(u32()),
            isNew_ ? std::optional(u32()) : std::nullopt};
  }
  cigi::StartOfFrame startOfFrame() {
    return {i8(),
            is4_ ? uint8_t{0} : u8(),
            cigi::IgMode(random_() % 4),
            flag(),
            u32(),
            maybe(u32()),
            isNew_ ? std::optional(u32()) : std::nullopt,
            is4_ && flag(),
            is4_ && flag(),
            is4_ && flag()};
  }
  cigi::Entity entity() { return {u16(), traits(), place()}; }

 private:
  cigi::EntityTraits traits() {
    cigi::EntityTraits t;
    t.state = cigi::EntityState(random_() % 3);
    t.detectCollisions = flag();
    t.inheritAlpha = flag();
    t.smoothing = is33_ && flag();
    t.alpha = u8();
    if (is4_ && flag())
      t.entityType = EntityType{u8(), u8(), u16(), u8(), u8(), u8(), u8()};
    else
      t.type = u16();
    if (is4_) return t;
    t.animateBackward = flag();
    t.animateForever = flag();
    t.animation = cigi::AnimationState(random_() % 4);
    return t;
  }
  cigi::EntityPlace place() {
    return {cigi::Clamp(random_() % 3), u16(), f(-180, 180), f(-90, 90), f(0, 360), point()};
  }
  cigi::ViewDefinition viewDefinition() {
    const bool orthographic = flag();
    const double most = orthographic ? 5000 : 89;
    return {u16(),
            u8(),
            cigi::Mirror(random_() % 4),
            uint8_t(random_() % 8),
            uint8_t(random_() % 8),
            orthographic,
            flag(),
            some(0.1, 10),
            some(1000, 1e6),
            some(-most, 0),
            some(0, most),
            some(0, most),
            some(-most, 0)};
  }
  cigi::Acceleration acceleration() {
    cigi::Acceleration a{u16(), f(-90, 90), f(-90, 90), f(-90, 90), 0, 0, {}, false, 0, 0, 0};
    if (!is4_) {
      a.retardationMS2 = f(-9, 9);
      a.terminalVelocityMS = f(0, 900);
      return a;
    }
    a.partId = maybe(u8());
    a.inBodyFrame = flag();
    a.rollDegS2 = f(-90, 90);
    a.pitchDegS2 = f(-90, 90);
    a.yawDegS2 = f(-90, 90);
    return a;
  }
  cigi::CelestialSphere celestial() {
    cigi::DateTime time{uint16_t(1 + random_() % 9999), uint8_t(1 + random_() % 12), uint8_t(1 + random_() % 28),
                        uint8_t(random_() % 24),        uint8_t(random_() % 60),     is4_ ? f(0, 59) : 0};
    return {flag(), flag(), flag(), flag(), maybe(time), f(0, 100)};
  }
  cigi::Weather weather() {
    return {cigi::Scope(random_() % 3),
            u16(),
            u8(),
            percent(),
            uint8_t(random_() % 8),
            flag(),
            flag(),
            flag(),
            flag(),
            is4_ && flag(),
            uint8_t(random_() % 16),
            f(-60, 50),
            f(0, 1e5),
            f(0, 100),
            f(0, 100),
            f(-400, 9000),
            f(0, 5000),
            f(0, 300),
            f(0, 60),
            f(-9, 9),
            f(0, 360),
            f(900, 1100),
            f(0, 10),
            is4_ ? f(0, 100) : 0,
            is4_ ? f(0, 300) : 0};
  }
  cigi::SightExtendedResponse sightExtendedResponse() {
    cigi::SightExtendedResponse r;
    r.id = u16();
    r.valid = flag();
    r.visible = flag();
    r.hostFrameNibble = nibble();
    r.responses = u8();
    r.entityId = maybe(u16());
    r.rangeM = maybe(d(0, 1e6));
    r.inBodyFrame = !isNew_ && flag();
    if (!r.valid) return r;
    r.latDegOrXM = d(-90, 90);
    r.lonDegOrYM = d(-180, 180);
    r.altMOrZM = d(-400, 9000);
    r.red = u8();
    r.green = u8();
    r.blue = u8();
    r.alpha = u8();
    r.material = u32();
    r.normalAzimuthDeg = f(-180, 180);
    r.normalElevationDeg = f(-90, 90);
    return r;
  }
  cigi::Point point() {
    if (flag()) return cigi::BodyOffset{d(-1e4, 1e4), d(-1e4, 1e4), d(-1e4, 1e4)};
    return Geodetic{d(-90, 90), d(-180, 180), d(-400, 1e5)};
  }

  double d(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  // Drawn as a float: of a double that is rounded to one, g++ 12 at -O3 drops the rounding here.
  double f(double low, double high) {
    std::uniform_real_distribution<float> range(static_cast<float>(low), static_cast<float>(high));
    return static_cast<double>(range(random_));
  }
  std::optional<double> some(double low, double high) { return maybe(f(low, high)); }
  template <class T>
  std::optional<T> maybe(const T& value) {
    return flag() ? std::optional(value) : std::nullopt;
  }
  bool flag() { return (random_() & 1) != 0; }
  uint8_t u8() { return static_cast<uint8_t>(random_()); }
  int8_t i8() { return static_cast<int8_t>(random_()); }
  uint16_t u16() { return static_cast<uint16_t>(random_()); }
  uint32_t u32() { return static_cast<uint32_t>(random_()); }
  uint8_t percent() { return static_cast<uint8_t>(random_() % 101); }
  uint8_t nibble() { return isNew_ ? static_cast<uint8_t>(random_() % 16) : uint8_t{0}; }
  uint8_t period() { return isNew_ ? u8() : uint8_t{0}; }

  std::mt19937_64 random_;
  bool is4_, isNew_, is33_;
};

// Every way in which messages are written.
inline const std::vector<cigi::Format>& cigiFormats() {
  static const std::vector<cigi::Format> formats = [] {
    std::vector<cigi::Format> all;
    for (const auto order : {std::endian::little, std::endian::big})
      for (const cigi::Version version : {cigi::Version{3, 0}, {3, 1}, {3, 2}, {3, 3}, {4, 0}})
        all.push_back({version, order});
    return all;
  }();
  return formats;
}

inline constexpr size_t kIgControlIndex = 0, kStartOfFrameIndex = 12;

}  // namespace eye::test

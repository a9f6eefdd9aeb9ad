// A CIGI 3.x packet in the labels under which Wireshark shows it.
#pragma once

#include "dissection.h"
#include "link/cigi.h"

namespace eye::test {

inline double at(const cigi::Point& point, int coordinate) {
  if (const auto* o = std::get_if<cigi::BodyOffset>(&point))
    return coordinate == 0 ? o->xM : coordinate == 1 ? o->yM : o->zM;
  const auto& g = std::get<Geodetic>(point);
  return coordinate == 0 ? g.latDeg : coordinate == 1 ? g.lonDeg : g.altM;
}
inline double inBody(const cigi::Point& point) {
  return std::holds_alternative<cigi::BodyOffset>(point) ? 1 : 0;
}
template <class T>
double given(const std::optional<T>& value) {
  return value ? 1 : 0;
}
template <class T>
double orZero(const std::optional<T>& value) {
  return static_cast<double>(value.value_or(T{}));
}

inline Dissected labelled(const cigi::IgControl& p) {
  return {"IG Control",
          {{"Database Number", p.databaseNumber},
           {"IG Mode", double(p.mode)},
           {"Timestamp Valid", given(p.ticks)},
           {"Timestamp (microseconds)", orZero(p.ticks)}}};
}
inline Dissected labelled(const cigi::StartOfFrame& p) {
  return {"Start of Frame",
          {{"Database Number", p.databaseNumber},
           {"IG Status Code", p.status},
           {"IG Mode", double(p.mode)},
           {"Timestamp Valid", given(p.ticks)},
           {"Earth Reference Model", p.hostEarthModel},
           {"Timestamp (microseconds)", orZero(p.ticks)}}};
}
inline Dissected labelled(const cigi::Entity& p) {
  const auto& t = *p.traits;
  const auto& q = *p.place;
  return {"Entity Control",
          {{"Entity ID", p.id},
           {"Entity State", double(t.state)},
           {"Attach State", inBody(q.position)},
           {"Collision Detection Request", t.detectCollisions},
           {"Inherit Alpha", t.inheritAlpha},
           {"Ground/Ocean Clamp", double(q.clamp)},
           {"Animation Direction", t.animateBackward},
           {"Animation Loop Mode", t.animateForever},
           {"Animation State", double(t.animation)},
           {"Alpha", t.alpha},
           {"Entity Type", t.type},
           {"Parent ID", q.parentId},
           {"Roll (degrees)", q.rollDeg},
           {"Pitch (degrees)", q.pitchDeg},
           {"Yaw (degrees)", q.yawDeg},
           {"Latitude (degrees)/X Offset (m)", at(q.position, 0)},
           {"Longitude (degrees)/Y Offset (m)", at(q.position, 1)},
           {"Altitude (m)/Z Offset (m)", at(q.position, 2)}}};
}
inline Dissected labelled(const cigi::ViewControl& p) {
  return {"View Control",
          {{"View ID", p.viewId},
           {"Group ID", p.groupId},
           {"X Offset Enable", given(p.xM)},
           {"Y Offset Enable", given(p.yM)},
           {"Z Offset Enable", given(p.zM)},
           {"Roll Enable", given(p.rollDeg)},
           {"Pitch Enable", given(p.pitchDeg)},
           {"Yaw Enable", given(p.yawDeg)},
           {"Entity ID", p.entityId},
           {"X Offset (m)", orZero(p.xM)},
           {"Y Offset (m)", orZero(p.yM)},
           {"Z Offset (m)", orZero(p.zM)},
           {"Roll (degrees)", orZero(p.rollDeg)},
           {"Pitch (degrees)", orZero(p.pitchDeg)},
           {"Yaw (degrees)", orZero(p.yawDeg)}}};
}
inline Dissected labelled(const cigi::ViewDefinition& p) {
  return {"View Definition",
          {{"View ID", p.viewId},
           {"Group ID", p.groupId},
           {"Near Enable", given(p.nearM)},
           {"Far Enable", given(p.farM)},
           {"Left Enable", given(p.leftDegOrM)},
           {"Right Enable", given(p.rightDegOrM)},
           {"Top Enable", given(p.topDegOrM)},
           {"Bottom Enable", given(p.bottomDegOrM)},
           {"Mirror Mode", double(p.mirror)},
           {"Pixel Replication Mode", p.pixelReplication},
           {"Projection Type", p.orthographic},
           {"Reorder", p.toTop},
           {"View Type", p.viewType},
           {"Near (m)", orZero(p.nearM)},
           {"Far (m)", orZero(p.farM)},
           {"Left (degrees)", orZero(p.leftDegOrM)},
           {"Right (degrees)", orZero(p.rightDegOrM)},
           {"Top (degrees)", orZero(p.topDegOrM)},
           {"Bottom (degrees)", orZero(p.bottomDegOrM)}}};
}
inline Dissected labelled(const cigi::Velocity& p) {
  return {"Rate Control",
          {{"Entity ID", p.entityId},
           {"Articulated Part ID", orZero(p.partId)},
           {"Apply to Articulated Part", given(p.partId)},
           {"X Linear Rate (m/s)", p.xMS},
           {"Y Linear Rate (m/s)", p.yMS},
           {"Z Linear Rate (m/s)", p.zMS},
           {"Roll Angular Rate (degrees/s)", p.rollDegS},
           {"Pitch Angular Rate (degrees/s)", p.pitchDegS},
           {"Yaw Angular Rate (degrees/s)", p.yawDegS}}};
}
inline Dissected labelled(const cigi::Acceleration& p) {
  return {"Trajectory Definition",
          {{"Entity ID", p.entityId},
           {"Acceleration X (m/s^2)", p.xMS2},
           {"Acceleration Y (m/s^2)", p.yMS2},
           {"Acceleration Z (m/s^2)", p.zMS2},
           {"Retardation Rate (m/s^2)", p.retardationMS2},
           {"Terminal Velocity (m/s)", p.terminalVelocityMS}}};
}
inline Dissected labelled(const cigi::CelestialSphere& p) {
  const cigi::DateTime none{0, 0, 0, 0, 0, 0};
  const auto& t = p.dateTime ? *p.dateTime : none;
  return {"Celestial Sphere Control",
          {{"Hour (h)", t.hour},
           {"Minute (min)", t.minute},
           {"Ephemeris Model Enable", p.clockRuns},
           {"Sun Enable", p.sun},
           {"Moon Enable", p.moon},
           {"Star Field Enable", p.stars},
           {"Date/Time Valid", given(p.dateTime)},
           {"Date (MMDDYYYY)", t.month * 1e6 + t.day * 1e4 + t.year},
           {"Star Field Intensity (%)", p.starPercent}}};
}
inline Dissected labelled(const cigi::Atmosphere& p) {
  return {"Atmosphere Control",
          {{"Atmospheric Model Enable", p.model},
           {"Global Humidity (%)", p.humidityPercent},
           {"Global Air Temperature (degrees C)", p.temperatureC},
           {"Global Visibility Range (m)", p.visibilityM},
           {"Global Horizontal Wind Speed (m/s)", p.windMS},
           {"Global Vertical Wind Speed (m/s)", p.updraughtMS},
           {"Global Wind Direction (degrees)", p.windFromDeg},
           {"Global Barometric Pressure (mb or hPa)", p.pressureHpa}}};
}
inline Dissected labelled(const cigi::Weather& p) {
  return {"Weather Control",
          {{"Entity ID/Region ID", p.scopeId},
           {"Layer ID", p.layer},
           {"Humidity (%)", p.humidityPercent},
           {"Weather Enable", p.enabled},
           {"Scud Enable", p.scud},
           {"Random Winds Enable", p.gusts},
           {"Random Lightning Enable", p.lightning},
           {"Cloud Type", p.cloudType},
           {"Scope", double(p.scope)},
           {"Severity", p.severity},
           {"Air Temperature (degrees C)", p.temperatureC},
           {"Visibility Range (m)", p.visibilityM},
           {"Scud Frequency (%)", p.scudPercent},
           {"Coverage (%)", p.coveragePercent},
           {"Base Elevation (m)", p.baseM},
           {"Thickness (m)", p.thicknessM},
           {"Transition Band (m)", p.transitionM},
           {"Horizontal Wind Speed (m/s)", p.windMS},
           {"Vertical Wind Speed (m/s)", p.updraughtMS},
           {"Wind Direction (degrees)", p.windFromDeg},
           {"Barometric Pressure (mb or hPa)", p.pressureHpa},
           {"Aerosol Concentration (g/m^3)", p.aerosolGM3}}};
}
inline Dissected labelled(const cigi::HeightRequest& p) {
  return {"HAT/HOT Request",
          {{"HAT/HOT ID", p.id},
           {"Request Type", double(p.kind)},
           {"Coordinate System", inBody(p.point)},
           {"Entity ID", p.entityId},
           {"Latitude (degrees)/X Offset (m)", at(p.point, 0)},
           {"Longitude (degrees)/Y Offset (m)", at(p.point, 1)},
           {"Altitude (m)/Z Offset (m)", at(p.point, 2)}}};
}
inline Dissected labelled(const cigi::SightSegmentRequest& p) {
  return {"Line of Sight Segment Request",
          {{"LOS ID", p.id},
           {"Request Type", p.extended},
           {"Source Point Coordinate System", inBody(p.source)},
           {"Destination Point Coordinate System", inBody(p.destination)},
           {"Response Coordinate System", p.answerInBodyFrame},
           {"Alpha Threshold", p.alphaThreshold},
           {"Entity ID", p.sourceEntityId},
           {"Source Latitude (degrees)/Source X Offset (m)", at(p.source, 0)},
           {"Source Longitude (degrees)/Source Y Offset (m)", at(p.source, 1)},
           {"Source Altitude (m)/Source Z Offset (m)", at(p.source, 2)},
           {"Destination Latitude (degrees)/ Destination X Offset (m)", at(p.destination, 0)},
           {"Destination Longitude (degrees)/Destination Y Offset (m)", at(p.destination, 1)},
           {"Destination Altitude (m)/ Destination Z Offset (m)", at(p.destination, 2)},
           {"Material Mask", p.materialMask}}};
}
inline Dissected labelled(const cigi::SightVectorRequest& p) {
  return {"Line of Sight Vector Request",
          {{"LOS ID", p.id},
           {"Request Type", p.extended},
           {"Source Point Coordinate System", inBody(p.source)},
           {"Response Coordinate System", p.answerInBodyFrame},
           {"Alpha Threshold", p.alphaThreshold},
           {"Entity ID", p.entityId},
           {"Azimuth (degrees)", p.azimuthDeg},
           {"Elevation (degrees)", p.elevationDeg},
           {"Minimum Range (m)", p.minRangeM},
           {"Maximum Range (m)", p.maxRangeM},
           {"Source Latitude (degrees)/Source X Offset (m)", at(p.source, 0)},
           {"Source Longitude (degrees)/Source Y Offset (m)", at(p.source, 1)},
           {"Source Altitude (m)/Source Z Offset (m)", at(p.source, 2)},
           {"Material Mask", p.materialMask}}};
}
inline Dissected labelled(const cigi::HeightResponse& p) {
  return {"HAT/HOT Response",
          {{"HAT/HOT ID", p.id},
           {"Valid", given(p.heightM)},
           {"Response Type", p.ofTerrain},
           {"Height", orZero(p.heightM)}}};
}
inline Dissected labelled(const cigi::HeightExtendedResponse& p) {
  const cigi::SurfacePoint s = p.surface.value_or(cigi::SurfacePoint{});
  return {"HAT/HOT Extended Response",
          {{"HAT/HOT ID", p.id},
           {"Valid", given(p.surface)},
           {"HAT", s.aboveTerrainM},
           {"HOT", s.ofTerrainM},
           {"Material Code", s.material},
           {"Normal Vector Azimuth (degrees)", s.normalAzimuthDeg},
           {"Normal Vector Elevation (degrees)", s.normalElevationDeg}}};
}
inline Dissected labelled(const cigi::SightResponse& p) {
  return {"Line of Sight Response",
          {{"LOS ID", p.id},
           {"Valid", given(p.rangeM)},
           {"Entity ID Valid", given(p.entityId)},
           {"Visible", p.visible},
           {"Response Count", p.responses},
           {"Entity ID", orZero(p.entityId)},
           {"Range (m)", orZero(p.rangeM)}}};
}
inline Dissected labelled(const cigi::SightExtendedResponse& p) {
  return {"Line of Sight Extended Response",
          {{"LOS ID", p.id},
           {"Valid", p.valid},
           {"Entity ID Valid", given(p.entityId)},
           {"Range Valid", given(p.rangeM)},
           {"Visible", p.visible},
           {"Response Count", p.responses},
           {"Entity ID", orZero(p.entityId)},
           {"Range (m)", orZero(p.rangeM)},
           {"Latitude (degrees)/X Offset (m)", p.latDegOrXM},
           {"Longitude (degrees)/Y Offset (m)", p.lonDegOrYM},
           {"Altitude (m)/Z Offset(m)", p.altMOrZM},
           {"Red", p.red},
           {"Green", p.green},
           {"Blue", p.blue},
           {"Alpha", p.alpha},
           {"Material Code", p.material},
           {"Normal Vector Azimuth (degrees)", p.normalAzimuthDeg},
           {"Normal Vector Elevation (degrees)", p.normalElevationDeg}}};
}
// What only some of 3.0 to 3.3 have.
inline void labelNewer(const cigi::Packet& packet, uint8_t minor, std::map<std::string, double>& to) {
  const auto* control = std::get_if<cigi::IgControl>(&packet);
  const auto* frame = std::get_if<cigi::StartOfFrame>(&packet);
  const auto* extended = std::get_if<cigi::SightExtendedResponse>(&packet);
  if (minor < 2) {
    if (control != nullptr) to["Frame Counter"] = control->hostFrame;
    if (frame != nullptr) to["Frame Counter"] = frame->igFrame;
    if (extended != nullptr) to["Intersection Point Coordinate System"] = extended->inBodyFrame;
    return;
  }
  if (control != nullptr) {
    to["Minor Version"] = minor;
    to["Host Frame Number"] = control->hostFrame;
    to["IG Frame Number"] = orZero(control->igFrame);
    if (minor >= 3) to["Extrapolation/Interpolation Enable"] = control->smoothing;
  }
  if (frame != nullptr) {
    to["Minor Version"] = minor;
    to["IG Frame Number"] = frame->igFrame;
    to["Last Host Frame Number"] = orZero(frame->hostFrame);
  }
  if (const auto* entity = std::get_if<cigi::Entity>(&packet); entity != nullptr && minor >= 3)
    to["Linear Extrapolation/Interpolation Enable"] = entity->traits->smoothing;
  if (const auto* velocity = std::get_if<cigi::Velocity>(&packet)) to["Coordinate System"] = velocity->inBodyFrame;
  if (const auto* height = std::get_if<cigi::HeightRequest>(&packet)) to["Update Period"] = height->everyFrames;
  if (const auto* vector = std::get_if<cigi::SightVectorRequest>(&packet)) to["Update Period"] = vector->everyFrames;
  if (const auto* segment = std::get_if<cigi::SightSegmentRequest>(&packet)) {
    to["Update Period"] = segment->everyFrames;
    to["Destination Entity ID Valid"] = given(segment->destinationEntityId);
    to["Destination Entity ID"] = orZero(segment->destinationEntityId);
  }
  const std::string nibble = "Host Frame Number LSN";
  if (extended != nullptr) to[nibble] = extended->hostFrameNibble;
  if (const auto* h = std::get_if<cigi::HeightResponse>(&packet)) to[nibble] = h->hostFrameNibble;
  if (const auto* x = std::get_if<cigi::HeightExtendedResponse>(&packet)) to[nibble] = x->hostFrameNibble;
  if (const auto* s = std::get_if<cigi::SightResponse>(&packet)) to[nibble] = s->hostFrameNibble;
}

inline Dissected labelled(const cigi::Packet& packet, uint8_t minor) {
  Dissected all = std::visit([](const auto& p) { return labelled(p); }, packet);
  labelNewer(packet, minor, all.fields);
  return all;
}

}  // namespace eye::test

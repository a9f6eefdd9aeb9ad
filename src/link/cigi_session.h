// What a CIGI host has said so far, for one view: entities, view, sky and air. Messages in, a snapshot for the frame
// out. Owner thread: link.
#pragma once

#include <set>
#include <string>

#include "link/air.h"
#include "link/cigi.h"
#include "link/cigi_entities.h"
#include "link/ground_probe.h"
#include "link/view_edges.h"

namespace eye::cigi {

// The sky's clock.
struct Sky {
  std::optional<double> julianDayUtc;  // at the moment `atNs`
  bool clockRuns = false;
  int64_t atNs = 0;
};

struct Snapshot {
  EyeChain eye;
  uint32_t hostFrame = 0;
  ViewEdges edges;
  Sky sky;
  Air air;
};

// When the sky stands, whole seconds: the sun moves 0.004 degrees in one, and a picture that does not change need not
// be drawn again.
std::optional<double> julianDayAt(const Sky& sky, int64_t nowNs);

class Session {
 public:
  explicit Session(uint16_t viewId) : viewId_(viewId) {}

  // `atNs`: when what the message says was true; `name`: of the link, for remarks in the log; `arrivedNs`: when it
  // came, where that is not the same. False: a newer frame has overtaken the message, and nothing of it is taken but
  // its questions that are asked once. A datagram that a network has doubled asks nothing a second time.
  bool take(const Message& message, int64_t atNs, const std::string& name, std::optional<int64_t> arrivedNs = {});
  // Forgets everything but what is counted: for a new host.
  void reset();
  uint64_t resets() const { return resets_; }  // also by what the host itself says: another run of it, standby

  Snapshot snapshot() const;
  const IgControl& control() const { return control_; }  // the newest
  uint64_t lostFrames() const { return lostFrames_; }
  uint64_t turnedAway() const { return entities_.turnedAway(); }
  // What is to be answered now: questions of this moment's message, and those that repeat. Points are geodetic.
  std::vector<GroundQuestion> takeQuestions();

 private:
  bool isLate(uint32_t hostFrame, int64_t arrivedNs) const;
  bool beginsAnew(uint32_t hostFrame, int64_t arrivedNs);
  bool header(const IgControl& control, const std::string& name, int64_t arrivedNs);
  void lookForEye(const std::string& name);
  void packet(const Packet& packet, const Stamp& stamp, const std::string& name);
  void take(const ViewControl& control);
  void take(const ViewDefinition& definition, const std::string& name);
  void take(const CelestialSphere& sphere, int64_t atNs);
  void take(const Weather& weather);
  // cigi_questions.cpp
  bool isDoubled(const Message& message, int64_t arrivedNs);
  void ask(const GroundRequest& request, const Stamp& stamp, const std::string& name);
  void repeatQuestions(int64_t nowNs);
  GroundQuestion resolved(const GroundRequest& request, uint32_t hostFrame, int64_t nowNs) const;
  std::optional<Placed> entityPlace(uint16_t id, int64_t nowNs) const;
  std::optional<Vec3d> ecefOf(const Point& point, uint16_t entityId, int64_t nowNs) const;
  // What a host is told once in the log.
  enum class Remark { standby, tooMany, clamp, otherView, orthographic, crossedEdges, noEye, tooManyRepeating };
  void remark(const std::string& name, Remark remark, const std::string& text);

  const uint16_t viewId_;
  EntityTable entities_;
  IgControl control_;
  bool started_ = false;
  uint64_t lostFrames_ = 0, resets_ = 0;
  uint32_t newestLate_ = 0;                        // of the frames that came behind a newer one
  int lateRun_ = 0;                                // how many of them behind one another, each the next of the last
  std::array<std::optional<uint32_t>, 128> seen_;  // host frames by their last bits: more than can be late
  int64_t atNs_ = 0, arrivedNs_ = 0;               // of the newest frame

  uint8_t groupId_ = 0;  // of the view; 0: none
  uint16_t eyeEntityId_ = 0;
  int framesWithoutEye_ = 0;  // in a row, up to what is waited for
  Vec3d eyeOffsetM_{};
  double eyeYawDeg_ = 0, eyePitchDeg_ = 0, eyeRollDeg_ = 0;
  ViewEdges edges_;
  Sky sky_;
  Air air_;

  struct Repeating {
    GroundRequest request;
    uint8_t everyFrames;
    uint32_t answeredFrame;  // of the host
  };
  struct Asked {
    uint64_t requestsHash;
    int64_t arrivedNs;
  };
  std::vector<Asked> asked_;  // lately, oldest first
  std::vector<Repeating> repeating_;
  std::vector<GroundQuestion> questions_;
  std::set<Remark> remarks_;  // said already
};

}  // namespace eye::cigi

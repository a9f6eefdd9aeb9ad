// Where aircraft state comes from, whatever the URL: a live host, a recording, a scenario or a fixed pose.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "geo/cloud_layer.h"
#include "link/ground_probe.h"
#include "link/host_state.h"
#include "link/view_edges.h"

namespace eye {

struct SourceSample {
  Pose pose;
  HostCounts counts;
  std::optional<double> visibilityM;
  CloudLayers clouds{};
  std::optional<double> julianDayUtc;  // that the host's sky shows
  ViewEdges edges;                     // what the host has said of the view
  std::optional<uint32_t> hostFrame;   // the host's number of the newest packet, where its protocol has one
  // Of a live host, on this machine's clock (monotonicNs).
  int64_t arrivedNs = 0;           // the newest packet; 0: none yet
  int64_t atNs = 0;                // when what it says was true
  bool stampedByHost = false;      // that is by the host's stamp, else the arrival
  std::vector<StampedPose> heard;  // the poses that have come since the last sample, the oldest first
  // Where the host itself says its aircraft is at a moment, by rates; empty: it says none.
  std::function<Pose(int64_t)> motion;
  // From `atNs` for so long anybody may carry the aircraft on, by the host's rates or own ones, and no longer: this is
  // the one bound.
  int64_t carryOnNs = 0;
  bool live = false;      // fed by packets
  bool valid = false;     // false until the first packet of a live host
  bool finished = false;  // a recording or scenario is over (it holds its last pose)

  // A host that has spoken, and not for longer than it may be carried on. `nowS`: of the clock above.
  bool isSilent(double nowS) const {
    return arrivedNs > 0 && nowS - static_cast<double>(arrivedNs) * 1e-9 > static_cast<double>(carryOnNs) * 1e-9;
  }
};

// What a source is told of a frame that is complete, for those whose host wants to know.
struct FrameReport {
  bool overBudget = false;                   // it took longer than a 60th of a second
  bool pagingBehind = false;                 // terrain that it wanted finer was not there
  std::optional<uint32_t> shownHostFrame{};  // of the source's own host
};

class StateSource {
 public:
  virtual ~StateSource() = default;
  // The state for the frame shown at `timeS` seconds since the start. Never blocks. Render thread.
  virtual SourceSample sample(double timeS) = 0;
  // Of a live host: waits for a state that no frame has had; false after the time. Render thread.
  virtual bool await(int) { return false; }
  // After each frame. Never blocks. Render thread.
  virtual void frameDone(const FrameReport&) {}
  virtual bool isLive() const = 0;
  virtual bool isFixed() const = 0;  // the same pose for ever
};

// native-fdm://ADDR:PORT  cigi://ADDR:PORT  dis://ADDR:PORT  xplane://ADDR:PORT  file://TRACK  demo://[SCENARIO]
// pose://lat,lon,alt,h,p,r, the live ones with ?options: docs/PROTOCOLS.md. `openProbe` (may be empty) makes what
// answers a host's questions about the ground; it is called at most once a source, on a thread of the source's own.
using OpenProbe = std::function<Result<std::unique_ptr<GroundProbe>>()>;
Result<std::unique_ptr<StateSource>> openStateSource(const std::string& url, const OpenProbe& openProbe = {});
// "lat,lon,alt,heading,pitch,roll", degrees and metres, each checked for its range.
Result<Pose> parsePose(const std::string& text);

}  // namespace eye

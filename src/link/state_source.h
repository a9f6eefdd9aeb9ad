// Where aircraft state comes from, whatever the URL: a live host, a recording, a scenario or a fixed pose.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "link/host_state.h"

namespace eye {

struct SourceSample {
  Pose pose;
  HostCounts counts;
  std::optional<double> visibilityM;
  int64_t arrivedNs = 0;  // of the newest packet; 0 without a live host
  bool live = false;      // fed by packets
  bool valid = false;     // false until the first packet of a live host
  bool finished = false;  // a recording or scenario is over (it holds its last pose)
};

class StateSource {
 public:
  virtual ~StateSource() = default;
  // The state for the frame shown at `timeS` seconds since the start. Never blocks. Render thread.
  virtual SourceSample sample(double timeS) = 0;
  virtual bool isLive() const = 0;
  virtual bool isFixed() const = 0;  // the same pose for ever
};

// native-fdm://ADDR:PORT  file://TRACK  demo://[SCENARIO]  pose://lat,lon,alt,h,p,r
Result<std::unique_ptr<StateSource>> openStateSource(const std::string& url);
// "lat,lon,alt,heading,pitch,roll", degrees and metres, each checked for its range.
Result<Pose> parsePose(const std::string& text);

}  // namespace eye

// What the flight suite flies: three tasks in the shape of paper 000's, through the mountains of a database, and
// recordings.
#pragma once

#include <string>
#include <vector>

#include "bench/ground_heights.h"
#include "bench/places.h"
#include "link/flight_plan.h"
#include "link/track.h"

namespace eye {

struct FlightTask {
  std::string name;
  int published = 0;  // the paper's number of the task it is like; 0: none
  double ssePx = 1;
  Track track;
  // Of recordings.
  bool isMoved = false;  // over other ground than it was flown over
  double raisedM = 0;    // so that it stays clear of the ground
};

// Low with high resolution, and two tracks in the mountains, 2,000 ft above the ground.
Result<std::vector<FlightTask>> builtInTasks(const Place& mountains, GroundHeights& ground, double durationS);

// The middle of a recording, where it was flown if all of that is within `bounds`, else over their middle.
Result<FlightTask> recordedTask(const std::string& path, const TileBounds& bounds, GroundHeights& ground,
                                double durationS);

// The plan's course, `heightM` above a smooth cover of the ground: the highest within a second, then its Gaussian mean.
Result<Track> trackAboveGround(const FlightPlan& plan, double heightM, GroundHeights& ground);

// Pure. The middle of a track, from its time 0 on; the whole of a short one.
Track middleOf(const Track& track, double durationS);
bool isWithin(const Track& track, const TileBounds& bounds);
// The same flight with its middle sample over `to`: metres east and north of it are kept, altitudes too.
Track movedTo(const Track& track, const LatLon& to);

}  // namespace eye

// The image generator: what it is made of, and one frame of it. Owner thread: render (the program's main thread).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/depth_map_control.h"
#include "app/frame_record.h"
#include "app/options.h"
#include "app/overlay.h"
#include "app/viewpoint_tracker.h"
#include "link/state_source.h"
#include "paging/pager.h"
#include "render/renderer.h"

namespace eye {

// Several hosts: the one that spoke last gives the state; before any has spoken, the first that needs no packets. What
// a host says of view, sky and air counts whether it says a place or not.
class Sources {
 public:
  static Result<Sources> open(const std::vector<std::string>& urls, const OpenProbe& openProbe);
  static Sources of(std::unique_ptr<StateSource> source);
  SourceSample sample(double timeS);
  void frameDone(const FrameReport& report);
  bool await(int timeoutMs);  // of the one that is live: StateSource::await
  size_t liveCount() const;
  bool anyLive() const { return liveCount() > 0; }
  bool allFixed() const;
  const std::string& description() const { return description_; }

 private:
  std::vector<std::unique_ptr<StateSource>> sources_;
  std::string description_;
  std::optional<double> visibilityM_;  // where the newest pose was
};

// What of a drawn chunk shows in the picture.
struct DrawnKey {
  uint64_t chunk = 0, imagery = 0;  // tile codes
  uint8_t skirtMask = 0;
  std::array<double, 4> skirtDepthM{};
  bool operator==(const DrawnKey&) const = default;
};

class ImageGenerator {
 public:
  // `source`: where the state comes from instead of options.hosts.
  static Result<std::unique_ptr<ImageGenerator>> create(const Options& options,
                                                        std::unique_ptr<StateSource> source = nullptr);

  // Draws the frame of clock `timeS`. Reads back what is asked for: see picture() and depth().
  Result<FrameRecord> frame(double timeS, bool readColour, bool readDepth);
  std::span<const uint8_t> picture() const { return output_.rgba; }  // of the last frame drawn; until the next
  std::span<const float> depth() const { return output_.depth; }
  int widthPx() const { return output_.widthPx; }
  int heightPx() const { return output_.heightPx; }
  const View& view() const { return view_; }
  FrameInput lastInput() const;  // what the last frame was drawn from, reading nothing back; until the next
  const Selection& selection() const { return selection_; }  // of the last frame; its nodes are the terrain's
  const TerrainCache& terrain() const { return pager_->cache(); }

  // Until the host has said something new, or the time is over.
  void awaitHost(int timeoutMs) { sources_.await(timeoutMs); }
  size_t liveHosts() const { return sources_.liveCount(); }
  bool sourceFinished() const { return finished_; }
  bool sourceIsFixed() const { return sources_.allFixed(); }
  bool sourceIsLive() const { return sources_.anyLive(); }
  Renderer& renderer() { return *renderer_; }

 private:
  explicit ImageGenerator(const Options& options) : options_(options), tracker_(options_) {}
  View currentView(const Pose& pose, const ViewEdges& hosts) const;
  Lighting currentLighting(const SourceSample& host) const;
  void select(const LookAhead* ahead);
  bool isFrozen(const DebugView& debug) const;
  DrawnKey keyOf(const DrawnChunk& drawn) const;
  bool sameAsLast(const Lighting& lighting) const;

  const Options options_;
  ViewpointTracker tracker_;
  Sources sources_;
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<Pager> pager_;  // after the renderer: it gives its chunks back to it
  DepthMapControl depthMap_;
  StatisticsOverlay overlay_;
  int settledFrames_ = 0;  // drawn behind one another with nothing missing

  uint64_t number_ = 0;
  Pose hostPose_, pose_;  // as the host says; of the view that is drawn
  DisplayedEye eye_;      // of the last frame
  bool finished_ = false;
  View view_;
  Selection selection_;
  std::vector<ChunkDraw> draws_;
  FrameOutput output_;

  // Of the last frame drawn, for --redraw changed.
  struct Drawn {
    View view;
    Lighting lighting;
    std::vector<DrawnKey> chunks;
    bool readColour = false, readDepth = false, overlay = false;
    std::optional<glm::ivec2> depthMapPx;
    DebugView debug;
  };
  std::optional<Drawn> drawn_;
};

}  // namespace eye

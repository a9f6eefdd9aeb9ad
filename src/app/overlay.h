// The statistics over the picture (F1): Dear ImGui. Owner thread: render.
#pragma once

#include <array>
#include <string>

#include "app/frame_record.h"

namespace eye {

class StatisticsOverlay {
 public:
  void add(const FrameRecord& record);
  // Dear ImGui calls for one frame, between NewFrame and Render.
  void draw(const std::string& device, const std::string& source) const;

 private:
  static constexpr int kHistory = 240;  // four seconds at 60 Hz
  std::array<float, kHistory> frameMs_{};
  int next_ = 0;
  FrameRecord last_;
};

}  // namespace eye

#include "app/overlay.h"

#include <algorithm>

#include <imgui.h>

namespace eye {
namespace {

constexpr double kMiB = 1 << 20;

void line(const char* name, const char* format, double a, double b = 0, double c = 0, double d = 0) {
  ImGui::TextDisabled("%-9s", name);
  ImGui::SameLine();
  ImGui::Text(format, a, b, c, d);
}

}  // namespace

void StatisticsOverlay::add(const FrameRecord& record) {
  last_ = record;
  if (!record.drawn) return;
  frameMs_[static_cast<size_t>(next_)] = static_cast<float>(record.frameMs);
  next_ = (next_ + 1) % kHistory;
}

void StatisticsOverlay::draw(const std::string& device, const std::string& source) const {
  const FrameRecord& r = last_;
  ImGui::SetNextWindowPos(ImVec2(8, 8), ImGuiCond_Always);
  ImGui::SetNextWindowBgAlpha(0.72f);
  ImGui::Begin("Eyepoint", nullptr,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoSavedSettings);
  ImGui::TextUnformatted(device.c_str());
  ImGui::TextUnformatted(source.c_str());
  const float slowest = *std::max_element(frameMs_.begin(), frameMs_.end());
  ImGui::PlotLines("##frame times", frameMs_.data(), kHistory, next_, "frame ms, 4 s; line of 16.7 at mid-height", 0.0f,
                   std::max(33.3f, slowest), ImVec2(330, 70));
  line("frame", "%6.2f ms   CPU %6.2f   GPU %6.2f", r.frameMs, r.cpuMs, r.gpuMs);
  for (const PassTime& pass : r.passes) line(pass.name, "%6.2f ms", pass.ms);
  line("position", "%.5f %.5f  %.1f m", r.pose.position.latDeg, r.pose.position.lonDeg, r.pose.position.altM);
  line("attitude", "hdg %.1f  pitch %.1f  roll %.1f", r.pose.headingDeg, r.pose.pitchDeg, r.pose.rollDeg);
  line("triangles", "%.0f in %.0f draws", static_cast<double>(r.triangles), static_cast<double>(r.draws));
  line("chunks", "%.0f drawn, %.0f off screen, %.0f below horizon", r.selection.drawn, r.selection.frustumCulled,
       r.selection.horizonCulled);
  if (r.depthMapPx) {
    line("depth map", "%.0f x %.0f", r.depthMapPx->x, r.depthMapPx->y);
    line("clusters", "%.0f drawn, %.0f hidden, %.0f off screen", r.clusters.drawn, r.clusters.occluded,
         r.clusters.outside);
  }
  line("paging", "%.0f resident, %.0f missing, %.1f MiB read", static_cast<double>(r.paging.resident),
       r.selection.missing, static_cast<double>(r.paging.bytesRead) / kMiB);
  line("memory", "GPU %.0f MiB, RAM %.0f MiB", static_cast<double>(r.paging.gpuBytes) / kMiB,
       static_cast<double>(r.paging.ramBytes) / kMiB);
  const auto packets = static_cast<double>(r.host.packets), rejected = static_cast<double>(r.host.rejected);
  if (r.hostAgeMs >= 0 && r.host.unread == 0)
    line("host", "%.0f packets, %.0f rejected, age %.1f ms", packets, rejected, r.hostAgeMs);
  if (r.hostAgeMs >= 0 && r.host.unread > 0)
    line("host", "%.0f packets, %.0f rejected, %.0f unread, age %.1f ms", packets, rejected,
         static_cast<double>(r.host.unread), r.hostAgeMs);
  if (r.hostAgeMs >= 0)
    line("shown", r.eye.stampedByHost ? "%.1f ms behind; jitter %.1f, host's clock" : "%.1f ms behind; jitter %.1f",
         r.eye.delayMs, r.eye.jitterMs);
  if (r.eye.silent) ImGui::TextColored(ImVec4(1, 0.7f, 0.2f, 1), "The host is silent: the eye waits");
  ImGui::TextDisabled("F1 statistics  F2 freeze culling  F3 depth map\nF4 level, fate  F11 full screen  Esc quit");
  ImGui::End();
}

}  // namespace eye

#include "app/debug_view.h"

#include <sstream>

#include <imgui.h>

#include "render/tint_lists.h"

namespace eye {
namespace {

constexpr int kTints = 3;
constexpr int kLevelsShown = 16;  // more than most databases have

void swatch(const char* id, const glm::vec3& colour, const char* text) {
  const float side = ImGui::GetTextLineHeight();
  ImGui::ColorButton(id, ImVec4(colour.r, colour.g, colour.b, 1), ImGuiColorEditFlags_NoTooltip, ImVec2(side, side));
  ImGui::SameLine();
  ImGui::TextUnformatted(text);
}

void fates() {
  swatch("visible", tintOfFate(EYE_FATE_VISIBLE), "visible");
  swatch("occluded", tintOfFate(EYE_FATE_OCCLUDED), "occluded");
  swatch("facing away", tintOfFate(EYE_FATE_BACK_FACING), "facing away");
  swatch("outside", tintOfFate(EYE_FATE_OUTSIDE), "outside the frustum");
  ImGui::TextDisabled("uncoloured: not tested");
}

void levels() {
  for (int level = 0; level < kLevelsShown; ++level) {
    const std::string text = std::to_string(level);
    if (level % 4 != 0) ImGui::SameLine(static_cast<float>(level % 4) * 48);
    swatch(text.c_str(), tintOfLevel(level), text.c_str());
  }
}

}  // namespace

std::optional<DebugView> debugViewOf(const std::string& text) {
  DebugView view;
  std::stringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    const bool isTint = word == "level" || word == "fate";
    if (isTint && view.tint != Tint::none) return std::nullopt;
    if (isTint) {
      view.tint = word == "level" ? Tint::level : Tint::fate;
    } else if (word == "freeze") {
      view.freeze = true;
    } else if (word == "depth-map") {
      view.depthMap = true;
    } else {
      return std::nullopt;
    }
  }
  if (!view.any() || text.back() == ',') return std::nullopt;
  return view;
}

DebugView switched(DebugView view, const WindowKeys& keys) {
  view.freeze ^= keys.freeze % 2 != 0;
  view.depthMap ^= keys.depthMap % 2 != 0;
  view.tint = static_cast<Tint>((static_cast<int>(view.tint) + keys.tint) % kTints);
  return view;
}

void drawDebugLegend(const DebugView& view, bool isFrozen, std::optional<glm::ivec2> depthMapPx, int widthPx) {
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(widthPx) - 8, 8), ImGuiCond_Always, ImVec2(1, 0));
  ImGui::SetNextWindowBgAlpha(0.72f);
  ImGui::Begin("Culling", nullptr,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoSavedSettings);
  if (view.freeze) ImGui::TextUnformatted(isFrozen ? "F2  culling frozen" : "F2  freezes when the terrain is there");
  if (view.depthMap && depthMapPx)
    ImGui::Text("F3  depth map %d x %d and its pyramid\nlight 32 m to dark 260 km, a shade a doubling", depthMapPx->x,
                depthMapPx->y);
  if (view.depthMap && !depthMapPx) ImGui::TextUnformatted("F3  no depth map in this frame");
  if (view.tint == Tint::level) ImGui::TextUnformatted("F4  level of detail");
  if (view.tint == Tint::fate) ImGui::TextUnformatted("F4  what culling makes of each cluster");
  if (view.tint == Tint::fate && !depthMapPx) ImGui::TextUnformatted("no depth map in this frame: nothing is tested");
  if (view.tint == Tint::level) levels();
  if (view.tint == Tint::fate) fates();
  ImGui::End();
}

}  // namespace eye

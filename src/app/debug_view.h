// What is shown of culling itself: --debug-view, switched by F2 to F4. Owner thread: render.
#pragma once

#include <optional>
#include <string>

#include <glm/glm.hpp>

#include "gpu/window_keys.h"
#include "render/renderer.h"

namespace eye {

struct DebugView {
  bool freeze = false;     // F2: what is drawn stays as it was, whatever the eye does
  bool depthMap = false;   // F3
  Tint tint = Tint::none;  // F4
  bool any() const { return freeze || depthMap || tint != Tint::none; }
  bool operator==(const DebugView&) const = default;
};

// "freeze", "depth-map", "level" or "fate", or several with commas between them; nothing where a word is another, or
// where both tints are asked for.
std::optional<DebugView> debugViewOf(const std::string& text);
// After so many presses of the keys.
DebugView switched(DebugView view, const WindowKeys& keys);

// Says what is shown, and what the colours mean: Dear ImGui calls in the upper right of a picture so wide.
// `depthMapPx`: of this frame. `isFrozen`: freeze alone waits until something is there.
void drawDebugLegend(const DebugView& view, bool isFrozen, std::optional<glm::ivec2> depthMapPx, int widthPx);

}  // namespace eye

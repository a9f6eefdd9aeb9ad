// A GLFW window and its keys: F1 to F4 are counted, F11 fullscreen, Escape. Owner thread: main, as GLFW demands.
#pragma once

#include <memory>
#include <string>

#include "base/error.h"
#include "gpu/window_keys.h"

struct GLFWwindow;

namespace eye {

struct WindowOptions {
  int widthPx = 800, heightPx = 600;
  bool fullscreen = false;
  int monitor = 0;
  std::string title = "Eyepoint";
};

class Window {
 public:
  // notFound where there is no display, usage where there is no such monitor. One window at a time.
  static Result<std::unique_ptr<Window>> open(const WindowOptions& options);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  bool poll();  // false when the user closed it
  const WindowKeys& keys() const { return keys_; }
  bool minimised() const { return minimised_; }
  // Of what is drawn into; 0 while it is minimised.
  void sizePx(int& widthPx, int& heightPx) const;
  GLFWwindow* handle() const { return window_; }

 private:
  Window() = default;
  static void onMinimise(GLFWwindow* window, int minimised);
  static void onKey(GLFWwindow* window, int key, int scancode, int action, int modifiers);
  void toggleFullscreen();

  GLFWwindow* window_ = nullptr;
  int monitor_ = 0;
  WindowKeys keys_;
  bool minimised_ = false;
  int windowedX_ = 0, windowedY_ = 0, windowedWidth_ = 0, windowedHeight_ = 0;  // where to return from fullscreen
};

}  // namespace eye

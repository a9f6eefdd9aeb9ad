#include "gpu/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace eye {

Result<std::unique_ptr<Window>> Window::open(const WindowOptions& options) {
  std::unique_ptr<Window> made(new Window);
  if (glfwInit() == GLFW_FALSE) {
    const char* reason = nullptr;
    glfwGetError(&reason);
    return fail(ErrorKind::notFound, fmt::format("no display for a window ({}): set DISPLAY, or run with --headless",
                                                 reason != nullptr ? reason : "GLFW does not say why"));
  }
  int monitorCount = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&monitorCount);
  if (options.monitor < 0 || (options.monitor > 0 && options.monitor >= monitorCount)) {
    return fail(ErrorKind::usage,
                fmt::format("--monitor {}: there are {} monitors, counted from 0", options.monitor, monitorCount));
  }
  GLFWmonitor* monitor = options.monitor < monitorCount ? monitors[options.monitor] : nullptr;
  const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  const bool fullscreen = options.fullscreen && mode != nullptr;
  made->monitor_ = options.monitor;
  made->windowedWidth_ = options.widthPx;
  made->windowedHeight_ = options.heightPx;
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);  // one of several displays of a cockpit keeps its picture
  made->window_ = fullscreen
                      ? glfwCreateWindow(mode->width, mode->height, options.title.c_str(), monitor, nullptr)
                      : glfwCreateWindow(options.widthPx, options.heightPx, options.title.c_str(), nullptr, nullptr);
  if (made->window_ == nullptr) {
    const char* reason = nullptr;
    glfwGetError(&reason);
    return fail(ErrorKind::unsupported,
                fmt::format("a window of {}x{} cannot be opened ({}): try another --size or --headless",
                            options.widthPx, options.heightPx, reason != nullptr ? reason : "unknown"));
  }
  int monitorX = 0, monitorY = 0;
  if (monitor != nullptr) glfwGetMonitorPos(monitor, &monitorX, &monitorY);
  if (!fullscreen && options.monitor > 0) glfwSetWindowPos(made->window_, monitorX, monitorY);
  made->windowedX_ = monitorX;
  made->windowedY_ = monitorY;
  glfwSetWindowUserPointer(made->window_, made.get());
  glfwSetKeyCallback(made->window_, &Window::onKey);
  glfwSetWindowIconifyCallback(made->window_, &Window::onMinimise);
  return made;
}

Window::~Window() {
  if (window_ != nullptr) glfwDestroyWindow(window_);
  glfwTerminate();
}

bool Window::poll() {
  glfwPollEvents();
  return glfwWindowShouldClose(window_) == GLFW_FALSE;
}

void Window::sizePx(int& widthPx, int& heightPx) const {
  glfwGetFramebufferSize(window_, &widthPx, &heightPx);
}

void Window::onMinimise(GLFWwindow* handle, int minimised) {
  static_cast<Window*>(glfwGetWindowUserPointer(handle))->minimised_ = minimised == GLFW_TRUE;
}

void Window::onKey(GLFWwindow* handle, int key, int, int action, int) {
  if (action != GLFW_PRESS) return;
  Window& window = *static_cast<Window*>(glfwGetWindowUserPointer(handle));
  window.keys_.overlay += key == GLFW_KEY_F1;
  window.keys_.freeze += key == GLFW_KEY_F2;
  window.keys_.depthMap += key == GLFW_KEY_F3;
  window.keys_.tint += key == GLFW_KEY_F4;
  if (key == GLFW_KEY_F11) window.toggleFullscreen();
  if (key == GLFW_KEY_ESCAPE) glfwSetWindowShouldClose(handle, GLFW_TRUE);
}

void Window::toggleFullscreen() {
  if (glfwGetWindowMonitor(window_) != nullptr) {
    glfwSetWindowMonitor(window_, nullptr, windowedX_, windowedY_, windowedWidth_, windowedHeight_, GLFW_DONT_CARE);
    return;
  }
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  if (monitor_ >= count) return;  // unplugged
  const GLFWvidmode* mode = glfwGetVideoMode(monitors[monitor_]);
  glfwGetWindowPos(window_, &windowedX_, &windowedY_);
  glfwGetWindowSize(window_, &windowedWidth_, &windowedHeight_);
  glfwSetWindowMonitor(window_, monitors[monitor_], 0, 0, mode->width, mode->height, mode->refreshRate);
}

}  // namespace eye

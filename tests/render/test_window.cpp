// A real window on a virtual display: create, draw, resize, show again, close.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <sys/wait.h>
#include <unistd.h>
#include <csignal>
#include <cstdlib>

#include "render/scene.h"
#include "telemetry/trace.h"

using namespace eye;
using namespace eye::test;

namespace {

// Xvfb on a display number of its own choosing; DISPLAY is set for as long as this lives.
class VirtualDisplay {
 public:
  VirtualDisplay() {
    int ends[2];
    if (pipe(ends) != 0) return;
    child_ = fork();
    if (child_ == 0) {
      const std::string end = std::to_string(ends[1]);
      close(ends[0]);
      (void)!freopen("/dev/null", "w", stderr);
      execlp("Xvfb", "Xvfb", "-displayfd", end.c_str(), "-screen", "0", "1024x768x24", "-nolisten", "tcp", nullptr);
      _exit(127);
    }
    close(ends[1]);
    // The number and the newline come in two writes, and closing after the first would end the server.
    std::string text;
    for (char c = 0; c != '\n' && read(ends[0], &c, 1) == 1;) text += c;
    close(ends[0]);
    if (text.empty()) return;
    running_ = true;
    setenv("DISPLAY", fmt::format(":{}", std::atoi(text.c_str())).c_str(), 1);
  }
  ~VirtualDisplay() {
    unsetenv("DISPLAY");
    if (child_ <= 0) return;
    kill(child_, SIGTERM);
    waitpid(child_, nullptr, 0);
  }
  bool running() const { return running_; }

 private:
  pid_t child_ = -1;
  bool running_ = false;
};

}  // namespace

TEST_CASE("a window shows frames through a change of size, validation clean") {
  const VirtualDisplay display;
  if (!display.running()) {
    WARN("Xvfb is not installed: the window is not tested");
    return;
  }
  RendererOptions options;
  options.window = options.validate = true;
  options.widthPx = 320;
  options.heightPx = 240;
  if (const auto devices = Renderer::listDevices(); !devices) {
    WARN(devices.error().message);
    return;
  }
  const auto renderer = makeRenderer(options);
  REQUIRE(renderer != nullptr);
  CHECK(renderer->pollWindow());
  CHECK(renderer->widthPx() == 320);
  CHECK(renderer->keys().overlay == 0);
  const Pose pose{{48.8, 20.0, 3000}, 0, -8, 0};
  const auto draws = mountains(*renderer, 3, ecefFromGeodetic(pose.position));
  // The last size is not the window's: the picture is scaled into it, as for a frame while it is being resized.
  for (const auto& [width, height] : {std::pair{320, 240}, {320, 240}, {400, 300}}) {
    FrameInput input = lookFrom(pose, width, height);
    input.draws = draws;
    REQUIRE(renderer->awaitDisplay().value());
    CHECK(renderer->awaitDisplay().value());  // the image is held: there is nothing to wait for
    const int64_t beganNs = monotonicNs();
    const auto frame = renderer->drawFrame(input);
    REQUIRE(frame.has_value());
    CHECK(frame->completedNs > beganNs);
    CHECK(frame->completedNs < monotonicNs());
    CHECK(frame->widthPx == width);
    CHECK(frame->rgba.size() == static_cast<size_t>(width * height * 4));
    CHECK(frame->rgba[2] > frame->rgba[0]);  // the sky is bluer than red, whatever the window's order of channels
    CHECK(std::string(frame->passes.back().name) == "present");
    CHECK(renderer->awaitDisplay().value());
    renderer->presentAgain();
    CHECK(renderer->pollWindow());
  }
  // Without an image of the display a frame is drawn and not shown.
  FrameInput unseen = lookFrom(pose, 320, 240);
  unseen.draws = draws;
  const auto frame = renderer->drawFrame(unseen);
  REQUIRE(frame.has_value());
  CHECK(std::string(frame->passes.back().name) == "read_back");
  CHECK_FALSE(renderer->minimised());
  CHECK(renderer->validationMessages() == 0);
}

TEST_CASE("without a display the error says what to do") {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  RendererOptions options;
  options.window = true;
  const auto made = Renderer::create(options);
  REQUIRE_FALSE(made.has_value());
  CHECK(made.error().message.find("--headless") != std::string::npos);
}

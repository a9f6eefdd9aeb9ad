// Dear ImGui over the picture. Works with and without a window. Owner thread: render. Several at once are several
// contexts; one of them may have a window.
#pragma once

#include <functional>

#include "render/targets.h"

struct GLFWwindow;
struct ImGuiContext;

namespace eye {

class Overlay {
 public:
  // `window` may be null. Throws vk::SystemError.
  Overlay(const GpuDevice& gpu, const vk::raii::PipelineCache& cache, vk::Format colourFormat, GLFWwindow* window);
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  void bindTargets(const GpuDevice& gpu, const Targets& targets);
  // Lets `build` make its windows (ImGui calls) and records their drawing over the colour target, which is in
  // usageColourTarget before and after.
  void record(const vk::raii::CommandBuffer& commands, const Targets& targets, const std::function<void()>& build);

 private:
  GLFWwindow* window_;
  ImGuiContext* context_;
  vk::raii::RenderPass renderPass_{nullptr};
  vk::raii::DescriptorPool pool_{nullptr};
  vk::raii::Framebuffer framebuffer_{nullptr};
};

}  // namespace eye

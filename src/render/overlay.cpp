#include "render/overlay.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

namespace eye {
namespace {

// The Vulkan backend of Dear ImGui 1.86 knows no dynamic rendering, so it gets a render pass of its own.
vk::raii::RenderPass createRenderPass(const GpuDevice& gpu, vk::Format format) {
  const auto layout = vk::ImageLayout::eColorAttachmentOptimal;
  vk::AttachmentDescription colour;
  colour.setFormat(format).setLoadOp(vk::AttachmentLoadOp::eLoad).setStoreOp(vk::AttachmentStoreOp::eStore);
  colour.setInitialLayout(layout).setFinalLayout(layout);
  const vk::AttachmentReference reference(0, layout);
  vk::SubpassDescription subpass;
  subpass.setColorAttachments(reference);
  // It follows the shading pass directly and is followed by a copy.
  using Stage = vk::PipelineStageFlagBits;
  using Access = vk::AccessFlagBits;
  const vk::AccessFlags both = Access::eColorAttachmentRead | Access::eColorAttachmentWrite;
  const std::array dependencies{vk::SubpassDependency(VK_SUBPASS_EXTERNAL, 0, Stage::eColorAttachmentOutput,
                                                      Stage::eColorAttachmentOutput, both, both),
                                vk::SubpassDependency(0, VK_SUBPASS_EXTERNAL, Stage::eColorAttachmentOutput,
                                                      Stage::eColorAttachmentOutput, both, both)};
  return {gpu.device, vk::RenderPassCreateInfo({}, colour, subpass, dependencies)};
}

}  // namespace

Overlay::Overlay(const GpuDevice& gpu, const vk::raii::PipelineCache& cache, vk::Format colourFormat,
                 GLFWwindow* window)
    : window_(window), context_(ImGui::CreateContext()), renderPass_(createRenderPass(gpu, colourFormat)) {
  const vk::DescriptorPoolSize size(vk::DescriptorType::eCombinedImageSampler, 8);
  pool_ = vk::raii::DescriptorPool(
      gpu.device, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 8, size));
  ImGui::SetCurrentContext(context_);
  ImGui::GetIO().IniFilename = nullptr;  // nothing is written beside the user's files
  ImGui::StyleColorsDark();
  if (window_ != nullptr) ImGui_ImplGlfw_InitForVulkan(window_, true);
  ImGui_ImplVulkan_InitInfo info{};
  info.Instance = *gpu.instance;
  info.PhysicalDevice = *gpu.physical;
  info.Device = *gpu.device;
  info.QueueFamily = gpu.traits.queueFamily;
  info.Queue = *gpu.queue;
  info.PipelineCache = *cache;
  info.DescriptorPool = *pool_;
  info.MinImageCount = info.ImageCount = 2;  // the least that it takes; one frame is in flight
  info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  ImGui_ImplVulkan_Init(&info, *renderPass_);
  runOnce(gpu, [](const vk::raii::CommandBuffer& commands) { ImGui_ImplVulkan_CreateFontsTexture(*commands); });
  ImGui_ImplVulkan_DestroyFontUploadObjects();
}

Overlay::~Overlay() {
  ImGui::SetCurrentContext(context_);
  ImGui_ImplVulkan_Shutdown();
  if (window_ != nullptr) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext(context_);
}

void Overlay::bindTargets(const GpuDevice& gpu, const Targets& targets) {
  vk::FramebufferCreateInfo info;
  info.setRenderPass(*renderPass_).setAttachments(*targets.colour.view).setLayers(1);
  info.setWidth(static_cast<uint32_t>(targets.widthPx)).setHeight(static_cast<uint32_t>(targets.heightPx));
  framebuffer_ = vk::raii::Framebuffer(gpu.device, info);
}

void Overlay::record(const vk::raii::CommandBuffer& commands, const Targets& targets,
                     const std::function<void()>& build) {
  ImGui::SetCurrentContext(context_);
  ImGui_ImplVulkan_NewFrame();
  if (window_ != nullptr) ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(targets.widthPx), static_cast<float>(targets.heightPx));
  io.DisplayFramebufferScale = ImVec2(1, 1);
  if (window_ == nullptr) io.DeltaTime = 1.0f / 60.0f;  // no clock is read, so that pictures repeat
  ImGui::NewFrame();
  build();
  ImGui::Render();
  const vk::Rect2D area({0, 0}, {static_cast<uint32_t>(targets.widthPx), static_cast<uint32_t>(targets.heightPx)});
  commands.beginRenderPass(vk::RenderPassBeginInfo(*renderPass_, *framebuffer_, area), vk::SubpassContents::eInline);
  ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), *commands);
  commands.endRenderPass();
}

}  // namespace eye

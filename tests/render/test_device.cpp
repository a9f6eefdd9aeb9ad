// Finding a device, and what is said where there is none.
#include <catch2/catch.hpp>

#include <cstdlib>

#include "render/scene.h"

using namespace eye;
using namespace eye::test;

TEST_CASE("devices are listed with what they lack") {
  const auto devices = Renderer::listDevices();
  if (!devices) {
    WARN(devices.error().message);
    return;
  }
  for (const DeviceDescription& device : *devices) {
    CHECK_FALSE(device.name.empty());
    CHECK_FALSE(device.type.empty());
    CHECK_FALSE(device.driver.empty());
    CHECK(device.usable == device.lacks.empty());
  }
}

TEST_CASE("a part of a device's name chooses it; a wrong one lists what there is") {
  const auto devices = Renderer::listDevices();
  if (!devices || !devices->front().usable) {
    WARN("no usable Vulkan device here");
    return;
  }
  RendererOptions options;
  options.widthPx = 64;
  options.heightPx = 48;
  options.device = devices->front().name.substr(0, 4);
  const auto renderer = makeRenderer(options);
  REQUIRE(renderer != nullptr);
  CHECK(renderer->device().name.find(options.device) != std::string::npos);

  options.device = "Voodoo 2";
  const auto wrong = Renderer::create(options);
  REQUIRE_FALSE(wrong.has_value());
  CHECK(wrong.error().kind == ErrorKind::notFound);
  CHECK(wrong.error().message.find("Voodoo 2") != std::string::npos);
  CHECK(wrong.error().message.find(devices->front().name) != std::string::npos);
}

TEST_CASE("without a driver the error says what to install") {
  const char* before = std::getenv("VK_ICD_FILENAMES");
  const std::string kept = before != nullptr ? before : "";
  setenv("VK_ICD_FILENAMES", "/nowhere/none.json", 1);
  const auto made = Renderer::create({});
  const auto listed = Renderer::listDevices();
  if (before != nullptr) {
    setenv("VK_ICD_FILENAMES", kept.c_str(), 1);
  } else {
    unsetenv("VK_ICD_FILENAMES");
  }
  REQUIRE_FALSE(made.has_value());
  CHECK(made.error().kind == ErrorKind::notFound);
  CHECK(made.error().message.find("mesa-vulkan-drivers") != std::string::npos);
  REQUIRE_FALSE(listed.has_value());
  CHECK(listed.error().message == made.error().message);
}

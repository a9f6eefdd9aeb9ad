// Whole pictures: no NaN, no validation message, from below the sea to far in space.
#include <catch2/catch.hpp>

#include <fstream>

#include "render/scene.h"

using namespace eye;
using namespace eye::test;

namespace {

// For looking at: written where EYE_PICTURES names a folder.
void keepPicture(const FrameOutput& frame, const std::string& name) {
  const char* folder = std::getenv("EYE_PICTURES");
  if (folder == nullptr) return;
  std::ofstream out(std::string(folder) + "/" + name + ".ppm", std::ios::binary);
  out << "P6\n" << frame.widthPx << " " << frame.heightPx << "\n255\n";
  for (size_t i = 0; i < frame.rgba.size(); i += 4) out.write(reinterpret_cast<const char*>(&frame.rgba[i]), 3);
}

}  // namespace

TEST_CASE("mountains under a sky, validation clean") {
  RendererOptions options;
  options.validate = true;
  const auto renderer = makeRenderer(options);
  if (!renderer) return;
  const Pose pose{{49.0 - 0.2, 20.0, 3000}, 0, -8, 0};
  FrameInput input = lookFrom(pose, 800, 600);
  const std::vector<ChunkDraw> draws = mountains(*renderer, 13, input.view.eyeEcefM);
  input.draws = draws;
  const auto frame = renderer->drawFrame(input);
  REQUIRE(frame.has_value());
  CHECK(frame->rgba.size() == 800u * 600u * 4u);
  CHECK(renderer->validationMessages() == 0);
  keepPicture(*frame, "mountains");
  for (const PassTime& pass : frame->passes) INFO(pass.name << " " << pass.ms);
}

// Films and pictures of a flight, made with the real ffmpeg and looked at with its ffprobe.
#include "app/recorder.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <catch2/catch.hpp>

using namespace eye;

namespace {

constexpr int kWidthPx = 32, kHeightPx = 18;

std::string outputOf(const std::string& command) {
  std::string text;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  pclose(pipe);
  return text;
}

}  // namespace

TEST_CASE("a film is as long as the flight, however slowly its frames came") {
  if (std::system("command -v ffmpeg >/dev/null && command -v ffprobe >/dev/null") != 0) {
    WARN("ffmpeg is not installed: films are not tested");
    return;
  }
  const std::string film = "test_recorder.mp4", folder = "test_recorder_frames";
  auto recorder =
      Recorder::create({.film = film, .folder = folder, .widthPx = kWidthPx, .heightPx = kHeightPx, .rateHz = 10});
  REQUIRE(recorder.has_value());
  const std::vector<uint8_t> rgba(size_t{kWidthPx} * kHeightPx * 4, 100);
  // One second at the film's rate and a little unsteady, half a second without a frame, and two frames that come early.
  const double timesS[] = {0.0, 0.11, 0.19, 0.3, 0.41, 0.5, 0.6, 0.7, 0.8, 0.9, 1.4, 1.41, 1.42};
  for (const double timeS : timesS) REQUIRE((*recorder)->add(rgba, kWidthPx, kHeightPx, timeS).has_value());
  REQUIRE((*recorder)->finish().has_value());
  // Up to the frame of 1.4 s there are 15 in 10 Hz; each of the early ones is in it once.
  const std::string frames = outputOf(
      "ffprobe -v error -count_frames -select_streams v -show_entries stream=nb_read_frames -of csv=p=0 " + film);
  CHECK(std::atoi(frames.c_str()) == 17);
  // As pictures each frame is there once.
  const auto pictures = std::filesystem::directory_iterator(folder);
  CHECK(std::distance(begin(pictures), end(pictures)) == static_cast<std::ptrdiff_t>(std::size(timesS)));
  std::filesystem::remove(film);
  std::filesystem::remove_all(folder);
}

TEST_CASE("a frame of another size is refused") {
  const std::string folder = "test_recorder_size";
  auto recorder = Recorder::create({.film = "", .folder = folder, .widthPx = kWidthPx, .heightPx = kHeightPx});
  REQUIRE(recorder.has_value());
  const std::vector<uint8_t> rgba(4 * 4 * 4);
  CHECK_FALSE((*recorder)->add(rgba, 4, 4, 0).has_value());
  CHECK((*recorder)->finish().has_value());
  std::filesystem::remove_all(folder);
}

#include "app/option_values.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>

#include <fmt/format.h>

namespace eye {
namespace {

constexpr int kLargestSidePx = 8192;

// Numbers behind one another with one separator, nothing else. Finite.
std::optional<std::vector<double>> splitNumbers(const std::string& text, char separator, size_t count) {
  std::vector<double> numbers;
  std::stringstream stream(text);
  std::string word;
  while (std::getline(stream, word, separator)) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (word.empty() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
    numbers.push_back(value);
  }
  if (numbers.size() != count || (!text.empty() && text.back() == separator)) return std::nullopt;
  return numbers;
}

// WxH, both whole and from `least` to kLargestSidePx.
std::optional<glm::ivec2> sizeOf(const std::string& text, int least) {
  const auto numbers = splitNumbers(text, 'x', 2);
  if (!numbers) return std::nullopt;
  for (const double side : *numbers)
    if (std::floor(side) != side || side < least || side > kLargestSidePx) return std::nullopt;
  return glm::ivec2(static_cast<int>((*numbers)[0]), static_cast<int>((*numbers)[1]));
}

}  // namespace

// CLI::Range lets NaN through, since NaN is not less than anything.
CLI::Validator within(double least, double most) {
  return CLI::Validator(
      [=](std::string& text) {
        const auto number = splitNumbers(text, ' ', 1);
        return number && (*number)[0] >= least && (*number)[0] <= most
                   ? std::string()
                   : fmt::format("'{}' is not a number from {} to {}", text, least, most);
      },
      fmt::format("{}..{}", least, most), kNumber);
}

CLI::Validator wholeWithin(uint64_t least, uint64_t most) {
  return CLI::Validator(
      [=](std::string& text) {
        uint64_t number = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        return error == std::errc() && end == text.data() + text.size() && number >= least && number <= most
                   ? std::string()
                   : fmt::format("'{}' is not a whole number from {} to {}", text, least, most);
      },
      fmt::format("{}..{}", least, most), kNumber);
}

void setSize(Options& options, const std::string& text) {
  const auto size = sizeOf(text, 16);
  if (!size)
    throw CLI::ValidationError("--size", fmt::format("'{}' is no size; give WxH from 16x16 to {}x{}, such as 1280x720",
                                                     text, kLargestSidePx, kLargestSidePx));
  options.widthPx = size->x;
  options.heightPx = size->y;
}

CullingMode cullingOf(const std::string& text) {
  return text == "none" ? CullingMode::none : text == "frustum" ? CullingMode::frustum : CullingMode::dynamic;
}

TextureFilter filterOf(const std::string& text) {
  return text == "nearest"       ? TextureFilter::nearest
         : text == "bilinear"    ? TextureFilter::bilinear
         : text == "trilinear"   ? TextureFilter::trilinear
         : text == "anisotropic" ? TextureFilter::anisotropic
                                 : TextureFilter::device;
}

std::string nameOf(TextureFilter filter) {
  switch (filter) {
    case TextureFilter::nearest:
      return "nearest";
    case TextureFilter::bilinear:
      return "bilinear";
    case TextureFilter::trilinear:
      return "trilinear";
    case TextureFilter::anisotropic:
      return "anisotropic";
    case TextureFilter::device:
      break;
  }
  return "auto";
}

std::string nameOf(CullingMode culling) {
  return culling == CullingMode::none ? "none" : culling == CullingMode::frustum ? "frustum" : "dynamic";
}

void setDepthMap(Options& options, const std::string& text) {
  if (text == "auto" || text == "off") {
    options.depthMap = text == "auto" ? DepthMapMode::automatic : DepthMapMode::off;
    return;
  }
  const auto size = sizeOf(text, 1);
  if (!size)
    throw CLI::ValidationError(
        "--depth-map", fmt::format("'{}' is no depth map; give auto, off or WxH from 1x1 to {}x{}, such as 400x300",
                                   text, kLargestSidePx, kLargestSidePx));
  options.depthMap = DepthMapMode::fixed;
  options.depthMapPx = *size;
}

void setDebugView(Options& options, const std::string& text) {
  const std::optional<DebugView> view = debugViewOf(text);
  if (!view)
    throw CLI::ValidationError("--debug-view",
                               fmt::format("'{}' is no debug view; give freeze, depth-map, and level or fate, with "
                                           "commas between them",
                                           text));
  options.debugView = *view;
}

void setFrustum(Options& options, const std::string& text) {
  const auto n = splitNumbers(text, ',', 4);
  if (!n || (*n)[0] >= (*n)[1] || (*n)[2] >= (*n)[3] || std::abs((*n)[0]) >= 89.9 || std::abs((*n)[1]) >= 89.9 ||
      std::abs((*n)[2]) >= 89.9 || std::abs((*n)[3]) >= 89.9)
    throw CLI::ValidationError("--frustum",
                               fmt::format("'{}' is no frustum; give left,right,bottom,top half-angles in degrees, "
                                           "signed, within 89.9, such as -30,30,-23.4,23.4",
                                           text));
  options.frustumDeg = std::array<double, 4>{(*n)[0], (*n)[1], (*n)[2], (*n)[3]};
}

void setMirror(Options& options, const std::string& text) {
  options.mirrors = std::array<bool, 2>{text.starts_with('h'), text.ends_with('v')};
}

void setViewOffset(Options& options, const std::string& text) {
  const auto n = splitNumbers(text, ',', 3);
  if (!n || std::abs((*n)[0]) > 360 || std::abs((*n)[1]) > 90 || std::abs((*n)[2]) > 360)
    throw CLI::ValidationError("--view-offset",
                               fmt::format("'{}' is no offset; give heading,pitch,roll in degrees, within 360, 90 and "
                                           "360, such as -60,0,0 for a view to the left",
                                           text));
  options.viewOffsetDeg = std::array<double, 3>{(*n)[0], (*n)[1], (*n)[2]};
}

void setRate(Options& options, const std::string& text) {
  options.rateOfHost = text == "host";
  options.rateHz.reset();
  if (options.rateOfHost) return;
  if (text == "max") {
    options.rateHz = std::numeric_limits<double>::infinity();
    return;
  }
  const auto number = splitNumbers(text, ' ', 1);
  if (!number || (*number)[0] <= 0 || (*number)[0] > 1000)
    throw CLI::ValidationError("--rate", fmt::format("'{}' is no rate; give hertz in (0, 1000], max or host", text));
  options.rateHz = (*number)[0];
}

void setHostDelay(Options& options, const std::string& text) {
  if (text == "auto" || text == "off") {
    options.hostDelay = text == "off" ? HostDelayMode::off : HostDelayMode::automatic;
    return;
  }
  const auto number = splitNumbers(text, ' ', 1);
  if (!number || (*number)[0] < 0 || (*number)[0] > 500)
    throw CLI::ValidationError("--host-delay",
                               fmt::format("'{}' is no delay; give milliseconds from 0 to 500, auto or off", text));
  options.hostDelay = HostDelayMode::fixed;
  options.hostDelayMs = (*number)[0];
}

void setBackground(Options& options, const std::string& text) {
  const auto n = splitNumbers(text, ',', 3);
  if (!n || std::ranges::any_of(*n, [](double part) { return part < 0 || part > 1; }))
    throw CLI::ValidationError("--background", fmt::format("'{}' is no colour; give R,G,B from 0 to 1", text));
  options.background = glm::vec3(glm::dvec3((*n)[0], (*n)[1], (*n)[2]));
}

void setDate(Options& options, const std::string& text) {
  auto n = text.size() == 10 ? splitNumbers(text, '-', 3) : std::nullopt;
  if (n && std::ranges::any_of(*n, [](double part) { return std::abs(part) > 9999; })) n.reset();  // such as 1e9
  const auto whole = [&](size_t i) { return static_cast<int>((*n)[i]); };
  if (n) options.date = CalendarDate{whole(0), whole(1), whole(2)};
  const bool valid =
      n && whole(0) >= 1900 && whole(0) <= 2100 &&
      std::chrono::year_month_day(std::chrono::year(whole(0)), std::chrono::month(static_cast<unsigned>(whole(1))),
                                  std::chrono::day(static_cast<unsigned>(whole(2))))
          .ok() &&
      fmt::format("{:04}-{:02}-{:02}", whole(0), whole(1), whole(2)) == text;
  if (!valid)
    throw CLI::ValidationError(
        "--date", fmt::format("'{}' is no date; give YYYY-MM-DD from 1900 to 2100, such as 2026-06-21", text));
}

bool onOff(const std::string& name, const std::string& text) {
  if (text == "on" || text == "true") return true;
  if (text == "off" || text == "false") return false;
  throw CLI::ValidationError(name, fmt::format("'{}' is neither on nor off", text));
}

}  // namespace eye

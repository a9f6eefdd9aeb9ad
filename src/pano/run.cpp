#include "pano/run.h"

#include <algorithm>
#include <future>
#include <sstream>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "base/progress_line.h"
#include "link/pose_limits.h"
#include "pano/annotate.h"
#include "pano/gazetteer.h"
#include "pano/peaks.h"
#include "raster/distance_map.h"
#include "raster/gdal.h"
#include "raster/picture.h"

namespace eye {
namespace {

constexpr double kPersonM = 2;
constexpr double kLeastAboveGroundM = 0.6;  // the near plane is half a metre away
constexpr double kMostAltM = 100000;        // refraction as an arc is a matter of the air

}  // namespace

std::string titleOf(const Geodetic& eye, std::span<const Summit> summits) {
  const auto awayM = [&](const Summit& summit) {
    return glm::distance(ecefFromGeodetic({summit.latDeg, summit.lonDeg, 0}),
                         ecefFromGeodetic({eye.latDeg, eye.lonDeg, 0}));
  };
  const auto isAtHeightOf = [&](const Summit& summit) {
    constexpr double kMostM = 150;  // what gazetteers and coarse posts are off, and a tower
    return !summit.heightM || std::abs(eye.altM - *summit.heightM) < kMostM;
  };
  std::string title;
  double nearestM = kSummitReachM;
  for (const Summit& summit : summits)
    if (const double m = awayM(summit); m < nearestM && isAtHeightOf(summit)) nearestM = m, title = summit.name + "   ";
  return title + fmt::format("{:.4f}\u00b0 {}, {:.4f}\u00b0 {}, {:.0f} m", std::abs(eye.latDeg),
                             eye.latDeg < 0 ? "S" : "N", std::abs(eye.lonDeg), eye.lonDeg < 0 ? "W" : "E", eye.altM);
}

Result<EyeWish> parseEyeWish(const std::string& text) {
  const auto refuse = [&](const std::string& why) {
    return fail(ErrorKind::usage,
                fmt::format("--at '{}': {}; give lat,lon or lat,lon,altitude or lat,lon,+height above the ground, such "
                            "as 49.1795,20.0881,+2",
                            text, why));
  };
  std::vector<double> numbers;
  bool isAboveGround = false;
  std::stringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) {
    if (numbers.size() == 2 && word.starts_with('+')) isAboveGround = true, word.erase(0, 1);
    const auto number = parseNumber(word);
    if (!number) return refuse(fmt::format("'{}' is not a number", word));
    numbers.push_back(*number);
  }
  if (numbers.size() < 2 || numbers.size() > 3 || text.ends_with(','))
    return refuse("it is no position of two or three numbers");
  const auto position = checkedPosition({numbers[0], numbers[1], 0});
  if (!position) return refuse(position.error().message);
  EyeWish wish{position->latDeg, position->lonDeg, {}, {}};
  if (numbers.size() < 3) return wish;
  if (!(numbers[2] <= kMostAltM)) return refuse(fmt::format("the eye is higher than {} m", kMostAltM));
  (isAboveGround ? wish.aboveGroundM : wish.altM) = numbers[2];
  return wish;
}

Result<Geodetic> placeEye(const EyeWish& wish, GroundQuery& ground) {
  const Geodetic wished{wish.latDeg, wish.lonDeg, 0};
  const Result<Geodetic> stand = climb(ground, wished, wish.onSummit ? kSummitReachM : 0);
  if (!stand) return tl::unexpected(stand.error());
  const double groundM = stand->altM;
  const double altM = wish.altM.value_or(groundM + wish.aboveGroundM.value_or(kPersonM));
  if (altM < groundM + kLeastAboveGroundM)
    return fail(ErrorKind::usage,
                fmt::format("--at {},{}: {:.1f} m is not {} m above the ground, which is at {:.1f} m there; give a "
                            "greater altitude, or +2",
                            wish.latDeg, wish.lonDeg, altM, kLeastAboveGroundM, groundM));
  return Geodetic{stand->latDeg, stand->lonDeg, altM};
}

Result<void> runPanorama(const PanoramaJob& job) {
  PanoramaOptions options = job.options;
  const Result<std::vector<Summit>> summits = loadGazetteers(job.peaks);
  if (!summits) return tl::unexpected(summits.error());
  Result<GroundQuery> ground = GroundQuery::open(options.terrain);
  if (!ground) return tl::unexpected(ground.error());
  const Result<Geodetic> eye = placeEye(job.at, *ground);
  if (!eye) return tl::unexpected(eye.error());
  options.eye = *eye;

  ProgressLine line;
  options.progress = [&](const std::string& what, double share) {
    if (line.isDue()) line.print(fmt::format("{} {}", progressBar(share), what));
  };
  Result<RenderedPanorama> rendered = renderPanorama(options);
  if (!rendered) return tl::unexpected(rendered.error());
  Panorama& panorama = rendered->panorama;
  if (rendered->coarseChunks > 0)
    spdlog::warn("{} chunks are drawn coarser than they should be; give a larger --cache-gpu", rendered->coarseChunks);

  // The map goes out while the picture gets its names.
  auto map = std::async(std::launch::async, [&] {
    return writeDistanceMap(job.out + ".distance.tif", panorama.told(), panorama.frame.widthPx,
                            panorama.frame.heightPx);
  });
  options.progress("peaks", 0.95);
  const auto peaks = findPeaks(panorama, options, *summits);
  if (!peaks) return tl::unexpected(peaks.error());
  drawRidges(panorama);
  const Result<int> named = annotate(panorama, *peaks, titleOf(options.eye, *summits));
  if (!named) return tl::unexpected(named.error());
  options.progress("writing", 0.97);
  const auto picture =
      writePng(job.out + ".png", panorama.rgba, panorama.frame.widthPx, panorama.frame.heightPx, PngEffort::quick);
  if (const Result<void> written = map.get(); !written) return written;
  if (!picture) return picture;
  if (const Result<void> written = writePeaks(job.out + ".peaks.csv", *peaks); !written) return written;
  const auto visible = std::ranges::count_if(*peaks, &PanoramaPeak::visible);
  fmt::print("{0}.png\n{0}.distance.tif\n{0}.peaks.csv: {1} peaks within reach, {2} visible, {3} named\n", job.out,
             peaks->size(), visible, *named);
  return {};
}

}  // namespace eye

#include "link/bad_link.h"

#include <fmt/format.h>

namespace eye {

Result<void> checkBadLink(const BadLinkOptions& options) {
  // Half a minute of delay at 60 Hz keeps 1,800 packets waiting, which is more than any network does.
  if (!(options.jitterMs >= 0 && options.jitterMs <= 30'000))
    return fail(ErrorKind::usage, fmt::format("--jitter {} is outside 0 to 30000 milliseconds", options.jitterMs));
  const std::pair<const char*, double> probabilities[] = {
      {"--loss", options.loss}, {"--duplicate", options.duplicate}, {"--reorder", options.reorder}};
  for (const auto& [name, value] : probabilities)
    if (!(value >= 0 && value <= 1))
      return fail(ErrorKind::usage, fmt::format("{} {} is no probability from 0 to 1", name, value));
  return {};
}

double BadLink::uniform() {
  // 53 random bits; std::uniform_real_distribution may differ between standard libraries.
  return static_cast<double>(random_() >> 11) * 0x1p-53;
}

std::vector<int64_t> BadLink::departures(int64_t dueNs, int64_t periodNs) {
  // Every packet draws the same numbers, so that changing one option leaves the others' effects where they were.
  const bool lost = happens(options_.loss), twice = happens(options_.duplicate), late = happens(options_.reorder);
  const double delays[] = {uniform(), uniform()};
  if (lost) return {};
  std::vector<int64_t> departures;
  for (int copy = 0; copy < (twice ? 2 : 1); ++copy) {
    const auto jitterNs = static_cast<int64_t>(delays[copy] * options_.jitterMs * 1e6);
    departures.push_back(dueNs + jitterNs + (late ? periodNs + periodNs / 2 : 0));
  }
  return departures;
}

}  // namespace eye

#include "progress.h"

#include <fmt/format.h>

namespace eye {

void ProgressPrinter::show(const BakeProgress& progress) {
  if (!line_.isDue()) return;
  const double share = progress.estimate > 0 ? double(progress.tiles) / double(progress.estimate) : 0;
  line_.print(fmt::format("{} level {}, {} of about {} tiles, {:.0f} tiles/s, {:.1f} MB", progressBar(share),
                          progress.level, progress.tiles, progress.estimate, double(progress.baked) / line_.elapsedS(),
                          double(progress.bytes) / 1e6));
}

void ProgressPrinter::showShare(const char* what, uint64_t done, uint64_t total) {
  if (!line_.isDue()) return;
  line_.print(fmt::format("{} {} {} of {} tiles", progressBar(total > 0 ? double(done) / double(total) : 1), what, done,
                          total));
}

}  // namespace eye

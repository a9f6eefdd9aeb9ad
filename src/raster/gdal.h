// GDAL behind RAII and values: handles that close themselves, its messages as our errors, files written whole or not at
// all. A dataset is used by one thread at a time.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "base/error.h"

class GDALDataset;

namespace eye {

struct DatasetCloser {
  void operator()(GDALDataset* dataset) const;
};
using Dataset = std::unique_ptr<GDALDataset, DatasetCloser>;

// Registers the drivers; any thread, any number of times.
void initGdal();

// While it lives, GDAL's messages on this thread are collected instead of printed.
class GdalMessages {
 public:
  GdalMessages();
  ~GdalMessages();
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;
  // The first failure, on one line; empty where there was none.
  const std::string& failure() const { return failure_; }

 private:
  static void collect(int severity, int number, const char* message);
  std::string failure_;
};

// Read-only. `path` may be anything that GDAL takes: a file, /vsizip/..., a VRT.
Result<Dataset> openRaster(const std::string& path);

// Writes beside the target and renames, so that a reader sees the old file or the new one. Devices and pipes are
// written directly.
Result<void> writeFileWhole(const std::string& path, std::span<const std::byte> bytes);

}  // namespace eye

#include "raster/picture.h"

#include <gdal_priv.h>

#include "raster/encode.h"

namespace eye {

Result<void> writePng(const std::string& path, std::span<const uint8_t> rgba, int widthPx, int heightPx,
                      PngEffort effort) {
  EYE_CHECK(widthPx > 0 && heightPx > 0 && rgba.size() == size_t(widthPx) * size_t(heightPx) * 4);
  const Dataset source = wrapPixels(rgba.data(), widthPx, heightPx, 3, GDT_Byte, 1, 4);
  if (!source) return fail(ErrorKind::io, path + ": out of memory while encoding the picture");
  const char* const options[] = {effort == PngEffort::quick ? "ZLEVEL=1" : "ZLEVEL=6", nullptr};
  return encodeToFile(*source, "PNG", options, path);
}

}  // namespace eye

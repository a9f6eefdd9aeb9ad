#include "raster/encode.h"

#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <atomic>

#include <fmt/format.h>

namespace eye {

Dataset wrapPixels(const void* pixels, int widthPx, int heightPx, int bands, int gdalType, int bytesPerValue,
                   int pixelBytes) {
  initGdal();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  EYE_CHECK(driver != nullptr);
  Dataset dataset(driver->Create("", widthPx, heightPx, 0, static_cast<GDALDataType>(gdalType), nullptr));
  if (!dataset) return dataset;
  for (int band = 0; band < bands; ++band) {
    const auto* first = static_cast<const uint8_t*>(pixels) + band * bytesPerValue;
    char pointer[32]{};
    CPLPrintPointer(pointer, const_cast<uint8_t*>(first), sizeof(pointer) - 1);
    CPLStringList options;
    options.SetNameValue("DATAPOINTER", pointer);
    options.SetNameValue("PIXELOFFSET", fmt::format("{}", pixelBytes).c_str());
    options.SetNameValue("LINEOFFSET", fmt::format("{}", int64_t{pixelBytes} * widthPx).c_str());
    if (dataset->AddBand(static_cast<GDALDataType>(gdalType), options.List()) != CE_None) return nullptr;
  }
  return dataset;
}

Result<void> encodeToFile(GDALDataset& source, const char* driverName, const char* const* options,
                          const std::string& path) {
  static std::atomic<int> serial{0};
  const std::string memoryPath = fmt::format("/vsimem/eye_encode_{}", serial++);
  GdalMessages messages;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(driverName);
  if (driver == nullptr) {
    return fail(ErrorKind::unsupported, fmt::format("{}: this GDAL has no {} driver; install it", path, driverName));
  }
  // Closing writes the rest, so the copy is closed before its bytes are read.
  Dataset copy(driver->CreateCopy(memoryPath.c_str(), &source, FALSE, const_cast<char**>(options), nullptr, nullptr));
  const bool made = copy != nullptr;
  copy.reset();
  vsi_l_offset size = 0;
  const auto* bytes = reinterpret_cast<const std::byte*>(VSIGetMemFileBuffer(memoryPath.c_str(), &size, FALSE));
  Result<void> result;
  if (made && bytes != nullptr && messages.failure().empty()) {
    result = writeFileWhole(path, {bytes, static_cast<size_t>(size)});
  } else {
    result = fail(ErrorKind::io, fmt::format("{}: {} encoding failed: {}", path, driverName, messages.failure()));
  }
  VSIUnlink(memoryPath.c_str());
  return result;
}

}  // namespace eye

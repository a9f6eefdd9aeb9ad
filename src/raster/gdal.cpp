#include "raster/gdal.h"

#include <fcntl.h>
#include <gdal_priv.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <mutex>

#include <fmt/format.h>

namespace eye {

void DatasetCloser::operator()(GDALDataset* dataset) const {
  GdalMessages quiet;
  dataset->ReleaseRef();  // a view on it may hold it longer
}

void initGdal() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALAllRegister();
    CPLSetConfigOption("GDAL_PAM_ENABLED", "NO");  // no .aux.xml files beside what users gave us
  });
}

GdalMessages::GdalMessages() {
  CPLPushErrorHandlerEx(
      [](CPLErr severity, CPLErrorNum number, const char* message) { collect(severity, number, message); }, this);
}

GdalMessages::~GdalMessages() {
  CPLPopErrorHandler();
}

void GdalMessages::collect(int severity, int /*number*/, const char* message) {
  auto* self = static_cast<GdalMessages*>(CPLGetErrorHandlerUserData());
  if (severity < CE_Failure || !self->failure_.empty()) return;
  self->failure_ = message;
  for (char& c : self->failure_) {
    if (c == '\n' || c == '\r') c = ' ';
  }
}

Result<Dataset> openRaster(const std::string& path) {
  initGdal();
  GdalMessages messages;
  Dataset dataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (dataset) return dataset;
  // Archives are opened by path into GDAL's file system, so GDAL is asked whether it is there.
  VSIStatBufL status;
  if (VSIStatL(path.c_str(), &status) != 0) {
    return fail(ErrorKind::notFound, fmt::format("{}: no such file; check the path", path));
  }
  return fail(ErrorKind::badData, fmt::format("{}: GDAL cannot open it as a raster ({}); try gdalinfo on it", path,
                                              messages.failure().empty() ? "unknown format" : messages.failure()));
}

namespace {

Error writeError(const std::string& path, int code) {
  if (code == ENOSPC || code == EDQUOT) {
    return {ErrorKind::noSpace, fmt::format("{}: the disk is full; free some space or write elsewhere", path)};
  }
  return {ErrorKind::io,
          fmt::format("{}: cannot write: {}; check the folder and its permissions", path, std::strerror(code))};
}

// 0 or errno.
int writeAll(int file, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes = bytes.subspan(static_cast<size_t>(written));
  }
  return 0;
}

}  // namespace

Result<void> writeFileWhole(const std::string& path, std::span<const std::byte> bytes) {
  struct stat status {};
  const bool direct = ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
  const std::string target = direct ? path : fmt::format("{}.part{}", path, ::getpid());
  const int file = ::open(target.c_str(), O_WRONLY | O_CLOEXEC | (direct ? 0 : O_CREAT | O_TRUNC), 0666);
  if (file < 0) return tl::unexpected(writeError(path, errno));
  int code = writeAll(file, bytes);
  if (::close(file) != 0 && code == 0) code = errno;
  if (code == 0 && !direct && ::rename(target.c_str(), path.c_str()) != 0) code = errno;
  if (code == 0) return {};
  if (!direct) ::unlink(target.c_str());
  return tl::unexpected(writeError(path, code));
}

}  // namespace eye

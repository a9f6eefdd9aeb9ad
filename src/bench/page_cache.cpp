#include "bench/page_cache.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

namespace eye {
namespace {

std::optional<double> residentShare(int file) {
  struct stat status {};
  if (fstat(file, &status) != 0 || status.st_size <= 0) return std::nullopt;
  const auto bytes = static_cast<size_t>(status.st_size), page = static_cast<size_t>(sysconf(_SC_PAGESIZE));
  void* mapped = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file, 0);
  if (mapped == MAP_FAILED) return std::nullopt;
  std::vector<unsigned char> pages((bytes + page - 1) / page);
  const bool known = mincore(mapped, bytes, pages.data()) == 0;
  munmap(mapped, bytes);
  if (!known) return std::nullopt;
  const auto resident = std::ranges::count_if(pages, [](unsigned char flags) { return (flags & 1) != 0; });
  return static_cast<double>(resident) / static_cast<double>(pages.size());
}

}  // namespace

std::optional<double> dropFromPageCache(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  std::optional<double> share;
  if (posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED) == 0) share = residentShare(file);
  close(file);
  return share;
}

}  // namespace eye

#include "link/track_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace eye {
namespace {

bool endsInIgc(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension == ".igc";
}

}  // namespace

Result<std::vector<std::byte>> readTrackFile(const std::string& path) {
  std::error_code problem;
  const auto status = std::filesystem::status(path, problem);
  if (!std::filesystem::exists(status))
    return fail(ErrorKind::notFound, fmt::format("track '{}' does not exist; check the path", path));
  if (!std::filesystem::is_regular_file(status))
    return fail(ErrorKind::usage, fmt::format("track '{}' is not a file; give a CSV, IGC or pcap file", path));

  std::ifstream file(path, std::ios::binary);
  if (!file) return fail(ErrorKind::io, fmt::format("cannot open track '{}': {}", path, std::strerror(errno)));
  const auto bytesOnDisk = std::filesystem::file_size(path, problem);
  if (problem || bytesOnDisk > kMaxTrackFileBytes)
    return fail(ErrorKind::badData,
                fmt::format("track '{}' is longer than {} MiB; cut it into parts", path, kMaxTrackFileBytes >> 20));
  std::vector<std::byte> bytes(static_cast<size_t>(bytesOnDisk));
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (file.gcount() != static_cast<std::streamsize>(bytes.size()))
    return fail(ErrorKind::io, fmt::format("cannot read track '{}' to its end", path));
  return bytes;
}

bool isCapture(std::span<const std::byte> file) {
  if (file.size() < 4) return false;
  constexpr uint8_t kMagics[][4] = {{0xd4, 0xc3, 0xb2, 0xa1},
                                    {0xa1, 0xb2, 0xc3, 0xd4},  // microseconds
                                    {0x4d, 0x3c, 0xb2, 0xa1},
                                    {0xa1, 0xb2, 0x3c, 0x4d},   // nanoseconds
                                    {0x0a, 0x0d, 0x0d, 0x0a}};  // pcapng
  for (const auto& magic : kMagics)
    if (std::memcmp(file.data(), magic, sizeof(magic)) == 0) return true;
  return false;
}

Result<Track> loadTrack(const std::string& path) {
  const auto bytes = readTrackFile(path);
  if (!bytes) return tl::unexpected(bytes.error());
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  auto track = isCapture(*bytes) ? parsePcapTrack(*bytes) : endsInIgc(path) ? parseIgcTrack(text) : parseCsvTrack(text);
  if (!track) return fail(track.error().kind, fmt::format("track '{}': {}", path, track.error().message));
  return track;
}

}  // namespace eye

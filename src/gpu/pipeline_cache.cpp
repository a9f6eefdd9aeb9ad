#include "gpu/pipeline_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/user_folders.h"

namespace eye {
namespace {

constexpr char kMagic[8] = {'E', 'Y', 'E', 'P', 'I', 'P', 'E', '1'};
constexpr size_t kHeaderBytes = sizeof(kMagic) + sizeof(uint64_t);

uint64_t fnv1a(std::span<const uint8_t> bytes) {
  uint64_t hash = 0xcbf29ce484222325ull;
  for (const uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3ull;
  return hash;
}

// The header that Vulkan prescribes (VkPipelineCacheHeaderVersionOne) must be this device's.
bool isOfDevice(const GpuDevice& gpu, const std::vector<uint8_t>& bytes) {
  VkPipelineCacheHeaderVersionOne header;
  if (bytes.size() < sizeof(header)) return false;
  std::memcpy(&header, bytes.data(), sizeof(header));
  return header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendorID == gpu.properties.vendorID &&
         header.deviceID == gpu.properties.deviceID &&
         std::memcmp(header.pipelineCacheUUID, gpu.properties.pipelineCacheUUID.data(), VK_UUID_SIZE) == 0;
}

}  // namespace

std::string packPipelineCache(std::span<const uint8_t> driverBytes) {
  const uint64_t hash = fnv1a(driverBytes);
  std::string file(kHeaderBytes + driverBytes.size(), '\0');
  std::memcpy(file.data(), kMagic, sizeof(kMagic));
  std::memcpy(file.data() + sizeof(kMagic), &hash, sizeof(hash));
  if (!driverBytes.empty()) std::memcpy(file.data() + kHeaderBytes, driverBytes.data(), driverBytes.size());
  return file;
}

std::optional<std::vector<uint8_t>> unpackPipelineCache(const std::string& file) {
  if (file.size() < kHeaderBytes || std::memcmp(file.data(), kMagic, sizeof(kMagic)) != 0) return std::nullopt;
  uint64_t hash = 0;
  std::memcpy(&hash, file.data() + sizeof(kMagic), sizeof(hash));
  std::vector<uint8_t> bytes(file.begin() + kHeaderBytes, file.end());
  if (fnv1a(bytes) != hash) return std::nullopt;
  return bytes;
}

std::string pipelineCachePath(const GpuDevice& gpu) {
  const auto folder = userCacheFolder();
  if (!folder) return {};
  std::string uuid;
  for (const uint8_t byte : gpu.properties.pipelineCacheUUID) uuid += fmt::format("{:02x}", byte);
  return *folder / ("pipelines-" + uuid + ".bin");
}

vk::raii::PipelineCache loadPipelineCache(const GpuDevice& gpu, const std::string& path) {
  std::vector<uint8_t> bytes;
  if (std::ifstream in(path, std::ios::binary); in) {
    std::ostringstream content;
    content << in.rdbuf();
    bytes = unpackPipelineCache(content.str()).value_or(std::vector<uint8_t>{});
    if (!isOfDevice(gpu, bytes)) bytes.clear();
  }
  return {gpu.device, vk::PipelineCacheCreateInfo({}, bytes.size(), bytes.data())};
}

void savePipelineCache(const vk::raii::PipelineCache& cache, const std::string& path) {
  if (path.empty()) return;
  const std::string bytes = packPipelineCache(cache.getData());
  std::error_code failed;
  if (std::filesystem::file_size(path, failed) == bytes.size() && !failed) return;  // nothing new was compiled
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), failed);
  // Written beside and renamed, so that another program never reads half a file.
  const std::string beside = fmt::format("{}.{}", path, getpid());
  std::ofstream out(beside, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (out) {
    std::filesystem::rename(beside, path, failed);
  } else {
    std::filesystem::remove(beside, failed);
  }
}

}  // namespace eye

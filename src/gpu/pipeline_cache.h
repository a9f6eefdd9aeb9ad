// The driver's compiled pipelines, kept in a file between runs. Only ever a saving of time: a file that is missing,
// damaged or another driver's is ignored, and one that cannot be written is not missed.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"

namespace eye {

// $XDG_CACHE_HOME/eyepoint/pipelines-UUID.bin (default ~/.cache); empty where neither variable is set.
std::string pipelineCachePath(const GpuDevice& gpu);
vk::raii::PipelineCache loadPipelineCache(const GpuDevice& gpu, const std::string& path);
void savePipelineCache(const vk::raii::PipelineCache& cache, const std::string& path);

// What is in the file: a checksum before the driver's bytes, since drivers check no more than their header.
std::string packPipelineCache(std::span<const uint8_t> driverBytes);
std::optional<std::vector<uint8_t>> unpackPipelineCache(const std::string& fileBytes);

}  // namespace eye

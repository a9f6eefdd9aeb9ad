// Blobs of terrain chunks. The first byte chooses what the rest is: a mesh of one of three kinds of cell, or imagery.
#include "chunk_kinds.h"
#include "fuzz_input.h"
#include "terrain/chunk_codec.h"

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace eye;
  if (size == 0) return 0;
  const auto blob = fuzz::bytesOf(data + 1, size - 1);
  const size_t kind = data[0] % (fuzz::kChunkKeys.size() + 1);
  if (kind == fuzz::kChunkKeys.size()) {
    const auto chain = decodeImagery(blob, fuzz::kTextureSize);
    EYE_CHECK(!chain || chain->size() == mipChainBytes(fuzz::kTextureSize));
    return 0;
  }
  const auto mesh = decodeMesh(blob, fuzz::kChunkKeys[kind]);
  if (!mesh) return 0;
  for (const uint16_t index : mesh->indices) EYE_CHECK(index < mesh->vertices.size());
  return 0;
}

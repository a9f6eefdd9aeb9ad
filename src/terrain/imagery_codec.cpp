// The imagery half of chunk_codec.h. docs/TILE_FORMAT.md has the layout byte by byte.
//
// Planes of green, red and blue, each byte less the median edge predictor of JPEG-LS (Weinberger, Seroussi and Sapiro
// 2000), then zstd. Of none, left, up, gradient, Paeth and average it gave the smallest photographs and was within 3 %
// of the best on palettes. Red and blue less green saves a fifth on most pictures and costs as much on those of few
// colours, so both are tried.
#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include "base/byte_reader.h"
#include "base/byte_writer.h"
#include "terrain/chunk_codec.h"
#include "terrain/compression.h"

namespace eye {
namespace {

constexpr uint16_t kImageryMagic = 0x4945;  // "EI" in the file
constexpr uint8_t kImageryVersion = 1;
constexpr uint8_t kLessGreen = 1;  // flag: red and blue are stored less green
constexpr int kMinSize = 16, kMaxSize = 2048;

bool isTextureSize(int size) {
  return size >= kMinSize && size <= kMaxSize && std::has_single_bit(static_cast<unsigned>(size));
}

tl::unexpected<Error> damaged(const std::string& what) {
  return fail(ErrorKind::badData, "imagery blob: " + what);
}

// Median of west, north and west + north - northWest: the plane's prediction, clamped where there is an edge.
inline int predict(int west, int north, int northWest) {
  const int low = std::min(west, north), high = std::max(west, north);
  return std::clamp(west + north - northWest, low, high);
}

// Prediction errors of one plane, `at(i)` its values; outside the picture counts as the nearest texel seen, else 0.
template <class At>
void filterPlane(int size, At at, std::byte* out) {
  const size_t width = static_cast<size_t>(size);
  for (size_t row = 0; row < width; ++row) {
    for (size_t column = 0; column < width; ++column) {
      const size_t i = row * width + column;
      const int west = column > 0 ? at(i - 1) : row > 0 ? at(i - width) : 0;
      const int north = row > 0 ? at(i - width) : west;
      const int northWest = row > 0 && column > 0 ? at(i - width - 1) : north;
      out[i] = static_cast<std::byte>(at(i) - predict(west, north, northWest));
    }
  }
}

std::vector<std::byte> filter(std::span<const uint8_t> rgb, int size, bool lessGreen) {
  const size_t texels = static_cast<size_t>(size) * static_cast<size_t>(size);
  std::vector<std::byte> planes(3 * texels);
  const auto green = [&](size_t i) -> int { return rgb[3 * i + 1]; };
  const auto plane = [&](size_t channel) {
    return [&rgb, channel, lessGreen](size_t i) -> int {
      return static_cast<uint8_t>(rgb[3 * i + channel] - (lessGreen ? rgb[3 * i + 1] : 0));
    };
  };
  filterPlane(size, green, planes.data());
  filterPlane(size, plane(0), planes.data() + texels);
  filterPlane(size, plane(2), planes.data() + 2 * texels);
  return planes;
}

// Undoes filter() into RGBA. The three planes run side by side: each waits for its western neighbour, so together they
// fill the processor three times as well as one after another.
void unfilter(std::span<const std::byte> planes, int size, bool lessGreen, std::span<uint8_t> rgba) {
  const size_t width = static_cast<size_t>(size), texels = width * width;
  const std::byte* const errors[3] = {planes.data(), planes.data() + texels, planes.data() + 2 * texels};
  std::vector<uint8_t> above(3 * width, 0);  // the row above, plane by plane
  for (size_t row = 0; row < width; ++row) {
    int west[3], northWest[3];
    for (size_t p = 0; p < 3; ++p) west[p] = northWest[p] = above[p * width];
    uint8_t* texel = rgba.data() + row * width * 4;
    for (size_t column = 0; column < width; ++column, texel += 4) {
      const size_t i = row * width + column;
      for (size_t p = 0; p < 3; ++p) {
        uint8_t& slot = above[p * width + column];
        const int north = row > 0 ? slot : west[p];
        const int corner = row > 0 ? northWest[p] : north;
        const uint8_t value =
            static_cast<uint8_t>(predict(west[p], north, corner) + std::to_integer<int>(errors[p][i]));
        northWest[p] = slot;
        slot = value;
        west[p] = value;
      }
      const int green = west[0], base = lessGreen ? green : 0;
      texel[0] = static_cast<uint8_t>(west[1] + base);
      texel[1] = static_cast<uint8_t>(green);
      texel[2] = static_cast<uint8_t>(west[2] + base);
      texel[3] = 255;
    }
  }
}

// Box filter of 2 x 2 texels on the stored (sRGB-encoded) values, rounded to nearest. Not in linear light: the textures
// are sampled and blended in their encoding too (an sRGB format costs 11 to 15 % of a frame on a software device), so a
// mip level is what the sampler's own average of the finer one would be and levels do not differ in brightness.
void halve(const uint8_t* fine, size_t fineWidth, uint8_t* coarse) {
  const size_t width = fineWidth / 2;
  for (size_t row = 0; row < width; ++row) {
    const uint8_t* upper = fine + 2 * row * fineWidth * 4;
    const uint8_t* lower = upper + fineWidth * 4;
    for (size_t column = 0; column < width; ++column, upper += 8, lower += 8, coarse += 4) {
      for (size_t c = 0; c < 4; ++c) {
        coarse[c] = static_cast<uint8_t>((upper[c] + upper[c + 4] + lower[c] + lower[c + 4] + 2) >> 2);
      }
    }
  }
}

}  // namespace

int mipLevels(int size) {
  int levels = 0;
  for (int width = size; width > 0; width /= 2) ++levels;
  return levels;
}

size_t mipChainBytes(int size) {
  size_t bytes = 0;
  for (size_t width = static_cast<size_t>(size); width > 0; width /= 2) bytes += 4 * width * width;
  return bytes;
}

Blob encodeImagery(std::span<const uint8_t> rgb, int size) {
  EYE_CHECK(isTextureSize(size));
  EYE_CHECK(rgb.size() == static_cast<size_t>(size) * static_cast<size_t>(size) * 3);
  const Blob plain = compress(filter(rgb, size, false));
  const Blob less = compress(filter(rgb, size, true));
  const bool lessGreen = less.size() < plain.size();
  ByteWriter out(std::endian::little);
  out.u16(kImageryMagic);
  out.u8(kImageryVersion);
  out.u8(lessGreen ? kLessGreen : 0);
  out.u16(static_cast<uint16_t>(size));
  out.u16(0);
  out.bytes(lessGreen ? less : plain);
  return out.take();
}

Result<std::vector<uint8_t>> decodeImagery(std::span<const std::byte> blob, int size) {
  EYE_CHECK(isTextureSize(size));
  ByteReader in(blob, std::endian::little);
  if (in.u16() != kImageryMagic || !in.ok()) return damaged("not imagery");
  const uint8_t version = in.u8();
  if (in.ok() && version != kImageryVersion) {
    return fail(ErrorKind::unsupported, fmt::format("imagery blob: version {} is not known to this build", version));
  }
  const uint8_t flags = in.u8();
  const uint16_t storedSize = in.u16();
  const uint16_t reserved = in.u16();
  if (!in.ok()) return damaged("truncated");
  if (flags > kLessGreen || reserved != 0) return damaged("its header is damaged");
  if (storedSize != size) return damaged(fmt::format("{0} x {0} texels in a database of {1} x {1}", storedSize, size));

  const size_t width = static_cast<size_t>(size);
  thread_local std::vector<std::byte> planes;
  planes.resize(3 * width * width);
  if (const Result<void> ok = decompress(in.bytes(in.remaining()), planes); !ok) return damaged(ok.error().message);
  std::vector<uint8_t> chain(mipChainBytes(size));
  unfilter(planes, size, (flags & kLessGreen) != 0, chain);
  uint8_t* level = chain.data();
  for (size_t fine = width; fine > 1; fine /= 2) {
    uint8_t* const next = level + 4 * fine * fine;
    halve(level, fine, next);
    level = next;
  }
  return chain;
}

}  // namespace eye

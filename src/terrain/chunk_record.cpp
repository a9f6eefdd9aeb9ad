#include "terrain/chunk_record.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>
#include <zlib.h>

#include "base/byte_writer.h"

namespace eye {
namespace {

constexpr size_t kIntegers = 12, kReals = 23;
static_assert(kIntegers + kReals + 1 == kRecordColumnCount);

// No finite value that describes the Earth's surface is larger; what is larger is damage.
constexpr double kLargestM = 2e7;
// The Earth's relief, with a margin: -10,935 m and 8,849 m.
constexpr double kLowestM = -12000, kHighestM = 10000;
constexpr int kMaxLatticeShift = 16;

struct Row {
  std::array<int64_t, kIntegers> integers{};
  std::array<double, kReals> reals{};
};

Row rowFromRecord(const ChunkRecord& record) {
  const ChunkMeta& m = record.meta;
  const OrientedBox& box = m.box;
  Row row{
      .integers = {signedCode(m.key), m.key.level(), m.childCount, m.hasImagery ? 1 : 0, m.latticeShift,
                   m.originLattice.x, m.originLattice.y, m.originLattice.z, record.mesh.bytes, record.imagery.bytes,
                   record.mesh.crc32, record.imagery.crc32},
      .reals = {m.geometricErrorM,      m.texelErrorM,          m.minHeightM,           m.maxHeightM,
                m.sphereCentreEcefM.x,  m.sphereCentreEcefM.y,  m.sphereCentreEcefM.z,  m.sphereRadiusM,
                box.centreEcefM.x,      box.centreEcefM.y,      box.centreEcefM.z,      box.halfAxesEcefM[0].x,
                box.halfAxesEcefM[0].y, box.halfAxesEcefM[0].z, box.halfAxesEcefM[1].x, box.halfAxesEcefM[1].y,
                box.halfAxesEcefM[1].z, box.halfAxesEcefM[2].x, box.halfAxesEcefM[2].y, box.halfAxesEcefM[2].z,
                m.horizonPointScaled.x, m.horizonPointScaled.y, m.horizonPointScaled.z},
  };
  // SQLite keeps whole numbers as integers, so -0.0 would come back as 0.0 and miss its checksum.
  for (double& real : row.reals) real += 0.0;
  return row;
}

int64_t rowChecksum(const Row& row) {
  ByteWriter bytes(std::endian::little);
  for (const int64_t integer : row.integers) bytes.i64(integer);
  for (const double real : row.reals) bytes.f64(real);
  return blobSum(bytes.data()).crc32;
}

tl::unexpected<Error> bad(const std::string& what) {
  return fail(ErrorKind::badData, what);
}

bool inRange(int64_t value, int64_t low, int64_t high) {
  return value >= low && value <= high;
}

Result<ChunkRecord> recordFromRow(const Row& row) {
  const auto& i = row.integers;
  const auto& r = row.reals;
  const Result<TileKey> key = TileKey::fromCode(static_cast<uint64_t>(i[0]));
  if (!key) return tl::unexpected(key.error());
  constexpr int64_t kUint32Max = 0xFFFFFFFF;
  if (i[1] != key->level()) return bad("its level and its code disagree");
  if (!inRange(i[2], 0, 4) || !inRange(i[3], 0, 1) || !inRange(i[4], 0, kMaxLatticeShift)) {
    return bad("a count or flag is out of range");
  }
  for (size_t sum = 8; sum < 12; ++sum) {
    if (!inRange(i[sum], 0, kUint32Max)) return bad("a blob's size or checksum is out of range");
  }
  const auto vector = [&r](size_t first) { return Vec3d(r[first], r[first + 1], r[first + 2]); };
  ChunkRecord record;
  ChunkMeta& m = record.meta;
  m.key = *key;
  m.childCount = static_cast<uint8_t>(i[2]);
  m.hasImagery = i[3] != 0;
  m.latticeShift = static_cast<uint8_t>(i[4]);
  m.originLattice = LatticePoint(i[5], i[6], i[7]);
  record.mesh = {static_cast<uint32_t>(i[8]), static_cast<uint32_t>(i[10])};
  record.imagery = {static_cast<uint32_t>(i[9]), static_cast<uint32_t>(i[11])};
  m.geometricErrorM = r[0];
  m.texelErrorM = r[1];
  m.minHeightM = r[2];
  m.maxHeightM = r[3];
  m.sphereCentreEcefM = vector(4);
  m.sphereRadiusM = r[7];
  m.box.centreEcefM = vector(8);
  m.box.halfAxesEcefM = {vector(11), vector(14), vector(17)};
  m.horizonPointScaled = vector(20);
  return record;
}

// The middle of the tile on the ellipsoid: the mesh passes it within its heights and its error.
Vec3d tileCentreEcefM(const TileKey& key) {
  const LatLon middle = latLonFromParam(key, {0.5, 0.5});
  return ecefFromGeodetic({middle.latDeg, middle.lonDeg, 0.0});
}

Result<void> checkBounds(const ChunkMeta& m) {
  if (!(m.sphereRadiusM > 0)) return bad("its bounding sphere is empty");
  for (size_t a = 0; a < 3; ++a) {
    const Vec3d& one = m.box.halfAxesEcefM[a];
    const Vec3d& other = m.box.halfAxesEcefM[(a + 1) % 3];
    if (std::abs(glm::dot(one, other)) > 1e-6 * glm::length(one) * glm::length(other)) {
      return bad("its bounding box is not rectangular");
    }
  }
  const Vec3d centre = tileCentreEcefM(m.key);
  const double awayM = std::max(std::abs(m.minHeightM), std::abs(m.maxHeightM)) + m.geometricErrorM + 1.0;
  if (glm::distance(m.sphereCentreEcefM, centre) > m.sphereRadiusM + awayM) {
    return bad("its bounding sphere lies elsewhere than the tile");
  }
  const auto& axes = m.box.halfAxesEcefM;
  const double halfDiagonalM = glm::length(Vec3d(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])));
  if (glm::distance(m.box.centreEcefM, centre) > halfDiagonalM + awayM) {
    return bad("its bounding box lies elsewhere than the tile");
  }
  // A vertex is within 32768 steps of the origin along each axis.
  const double reachM = 32768.0 * std::sqrt(3.0) * m.stepM();
  const Vec3d originM = ecefFromLattice(m.originLattice, m.stepM());
  if (glm::distance(originM, m.sphereCentreEcefM) > m.sphereRadiusM + reachM) {
    return bad("its origin lies elsewhere than the tile");
  }
  return {};
}

}  // namespace

const char* const kRecordColumns =
    "chunk.code, level, child_count, has_imagery, lattice_shift, origin_x, origin_y, origin_z, mesh_bytes, "
    "imagery_bytes, mesh_crc32, imagery_crc32, error_m, texel_error_m, min_height_m, max_height_m, sphere_x_m, "
    "sphere_y_m, sphere_z_m, sphere_radius_m, box_x_m, box_y_m, box_z_m, box_axis0_x_m, box_axis0_y_m, "
    "box_axis0_z_m, box_axis1_x_m, box_axis1_y_m, box_axis1_z_m, box_axis2_x_m, box_axis2_y_m, box_axis2_z_m, "
    "horizon_x, horizon_y, horizon_z, meta_crc32";
const char* const kRecordParameters = "?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?";

BlobSum blobSum(std::span<const std::byte> blob) {
  const uLong crc = crc32_z(0, reinterpret_cast<const Bytef*>(blob.data()), blob.size());
  return {static_cast<uint32_t>(blob.size()), static_cast<uint32_t>(crc)};
}

void bindRecord(SqliteStatement& statement, const ChunkRecord& record) {
  const Row row = rowFromRecord(record);
  int parameter = 0;
  for (const int64_t integer : row.integers) statement.bindInteger(parameter++, integer);
  for (const double real : row.reals) statement.bindReal(parameter++, real);
  statement.bindInteger(parameter, rowChecksum(row));
}

Result<ChunkRecord> readRecord(const SqliteStatement& stored) {
  Row row;
  bool typesHold = true;
  int column = 0;
  for (int64_t& integer : row.integers) {
    const std::optional<int64_t> value = stored.integer(column++);
    typesHold = typesHold && value.has_value();
    integer = value.value_or(0);
  }
  for (double& real : row.reals) {
    const std::optional<double> value = stored.real(column++);
    typesHold = typesHold && value.has_value();
    real = value.value_or(0);
  }
  const std::optional<int64_t> checksum = stored.integer(column);
  if (!typesHold || !checksum) return bad("a column holds a value of the wrong type");
  if (*checksum != rowChecksum(row)) return bad("checksum does not match");
  // The checksum keeps accidents out; a file made to harm has the right one, so nothing is believed for it.
  Result<ChunkRecord> record = recordFromRow(row);
  if (!record) return record;
  if (const Result<void> ok = checkMeta(record->meta); !ok) return tl::unexpected(ok.error());
  return record;
}

Result<void> checkMeta(const ChunkMeta& m) {
  for (const double real : rowFromRecord({m, {}, {}}).reals) {
    if (!std::isfinite(real)) return bad("a value is not finite");
  }
  if (!(m.geometricErrorM >= 0 && m.geometricErrorM <= kLargestM)) return bad("its error is out of range");
  if (!(m.texelErrorM >= 0 && m.texelErrorM <= kLargestM)) return bad("its texel size is out of range");
  // Coarse chunks widen their heights by their error.
  if (m.minHeightM > m.maxHeightM || m.minHeightM < kLowestM - m.geometricErrorM ||
      m.maxHeightM > kHighestM + m.geometricErrorM) {
    return bad("its heights are out of range");
  }
  for (const Vec3d& v : {m.sphereCentreEcefM, m.box.centreEcefM, m.box.halfAxesEcefM[0], m.box.halfAxesEcefM[1],
                         m.box.halfAxesEcefM[2], Vec3d(m.sphereRadiusM, 0, 0)}) {
    if (glm::length(v) > kLargestM) return bad("its bounds are out of range");
  }
  if (m.latticeShift > kMaxLatticeShift) return bad("its lattice shift is out of range");
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(static_cast<double>(m.originLattice[axis]) * m.stepM()) > kLargestM) {
      return bad("its origin is out of range");
    }
  }
  const int children = m.key.level() < kMaxLevel ? m.key.children().count : 0;
  if (m.childCount != 0 && m.childCount != children) return bad("its child count is not that of the tile");
  const std::optional<TileKey> parent = m.key.parent();
  if (!m.hasImagery && (m.key.isPolar() || (parent && parent->isPolar()))) {
    return bad("imagery is missing, which pole cells and their children always have");
  }
  return checkBounds(m);
}

Error damagedTile(const std::string& path, const TileKey& key, const Error& what) {
  return {what.kind, fmt::format("{}: tile {} (code {:#x}): {}; bake it again with --resume or restore the file", path,
                                 key.name(), key.code(), what.message)};
}

}  // namespace eye

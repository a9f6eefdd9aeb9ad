// The database: what is written comes back, what is damaged says so, and whoever is killed leaves a valid file.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <catch2/catch.hpp>

#include "synthetic_chunk.h"
#include "terrain/database.h"

namespace eye {
namespace {

namespace fs = std::filesystem;

// A folder that goes away with the test.
struct TempFolder {
  TempFolder() {
    std::string name = (fs::temp_directory_path() / "eyepoint_db_XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path = name;
  }
  ~TempFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::string file(const std::string& name) const { return (path / name).string(); }
  fs::path path;
};

constexpr int kTextureSize = 16;

DatabaseInfo smallInfo() {
  return {.maxLevel = 6,
          .finestErrorM = 0.25,
          .textureSize = kTextureSize,
          .dataBounds = {49, 50, 20, 21},
          .description = "synthetic hills",
          .complete = false};
}

// Eight roots and the children of the first `families` tiles in the order of storing.
std::vector<TileKey> storeTree(DatabaseWriter& writer, int families) {
  std::vector<TileKey> keys;
  REQUIRE(writer.begin());
  for (int octant = 0; octant < kOctants; ++octant) keys.push_back(TileKey::octantRoot(octant));
  for (const TileKey& root : keys) REQUIRE(writer.putChunk(syntheticChunk(root, kTextureSize, true)));
  for (size_t i = 0; i < static_cast<size_t>(families); ++i) {
    const TileKey parent = keys[i];
    for (const TileKey& child : parent.children()) {
      REQUIRE(writer.putChunk(syntheticChunk(child, kTextureSize, false)));
      keys.push_back(child);
    }
    REQUIRE(writer.setChildren(parent, parent.children().count));
  }
  REQUIRE(writer.commit());
  return keys;
}

std::vector<TileKey> writeSmallDatabase(const std::string& path, int families = 12) {
  Result<DatabaseWriter> writer = DatabaseWriter::create(path, smallInfo());
  REQUIRE(writer);
  const std::vector<TileKey> keys = storeTree(*writer, families);
  REQUIRE(writer->finish());
  return keys;
}

std::string readFile(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void writeFile(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

bool sameMeta(const ChunkMeta& a, const ChunkMeta& b) {
  return a.key == b.key && a.geometricErrorM == b.geometricErrorM && a.texelErrorM == b.texelErrorM &&
         a.minHeightM == b.minHeightM && a.maxHeightM == b.maxHeightM && a.sphereCentreEcefM == b.sphereCentreEcefM &&
         a.sphereRadiusM == b.sphereRadiusM && a.box.centreEcefM == b.box.centreEcefM &&
         a.box.halfAxesEcefM == b.box.halfAxesEcefM && a.horizonPointScaled == b.horizonPointScaled &&
         a.originLattice == b.originLattice && a.latticeShift == b.latticeShift && a.childCount == b.childCount &&
         a.hasImagery == b.hasImagery;
}

bool sameChunk(const StoredChunk& a, const StoredChunk& b) {
  return sameMeta(a.meta, b.meta) && a.mesh == b.mesh && a.imagery == b.imagery;
}

// SQL on the file behind the library's back.
void runSql(const std::string& path, const std::string& sql) {
  sqlite3* database = nullptr;
  REQUIRE(sqlite3_open(path.c_str(), &database) == SQLITE_OK);
  char* message = nullptr;
  const int code = sqlite3_exec(database, sql.c_str(), nullptr, nullptr, &message);
  INFO(sql << ": " << (message != nullptr ? message : ""));
  CHECK(code == SQLITE_OK);
  sqlite3_free(message);
  sqlite3_close(database);
}

// The error of opening; every message is one line that begins with the file.
Error openError(const std::string& path) {
  const Result<DatabaseReader> reader = DatabaseReader::open(path);
  REQUIRE_FALSE(reader);
  CHECK_THAT(reader.error().message, Catch::StartsWith(path + ": ") && !Catch::Contains("\n"));
  return reader.error();
}

// Runs `body` in a child process and gives its wait status.
int inChild(const std::function<int()>& body) {
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) _exit(body());
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  return status;
}

}  // namespace

TEST_CASE("What is stored comes back, and the file alone is the database") {
  const TempFolder folder;
  const std::string path = folder.file("a.eyt");
  const std::vector<TileKey> keys = writeSmallDatabase(path);
  CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 1);  // no log beside it

  const Result<DatabaseReader> reader = DatabaseReader::open(path);
  REQUIRE(reader);
  CHECK(reader->path() == path);
  CHECK(reader->info().schemaVersion == kSchemaVersion);
  CHECK(reader->info().maxLevel == 6);
  CHECK(reader->info().finestErrorM == 0.25);
  CHECK(reader->info().textureSize == kTextureSize);
  CHECK(reader->info().dataBounds.eastDeg == 21);
  CHECK(reader->info().description == "synthetic hills");
  CHECK(reader->info().complete);

  uint64_t bytes = 0;
  for (size_t i = 0; i < keys.size(); ++i) {
    StoredChunk expected = syntheticChunk(keys[i], kTextureSize, i < 8);
    expected.meta.childCount = i < 12 ? static_cast<uint8_t>(keys[i].children().count) : uint8_t{0};
    const Result<StoredChunk> chunk = reader->read(keys[i]);
    REQUIRE(chunk);
    CHECK(sameChunk(*chunk, expected));
    CHECK(sameMeta(reader->readMeta(keys[i]).value(), expected.meta));
    bytes += expected.mesh.size() + expected.imagery.size();
  }
  CHECK(reader->bytesRead() == bytes);
  const Result<StoredChunk> absent = reader->read(TileKey::fromGrid(6, 2, 5, 5));
  REQUIRE_FALSE(absent);
  CHECK(absent.error().kind == ErrorKind::notFound);

  uint64_t last = 0, total = 0;
  CHECK(reader->verify([&](uint64_t done, uint64_t of) { last = done, total = of; }));
  CHECK(last == keys.size());
  CHECK(total == keys.size());
}

TEST_CASE("Tiles are walked coarse levels first, and summed by level") {
  const TempFolder folder;
  const std::string path = folder.file("a.eyt");
  DatabaseInfo info = smallInfo();
  info.maxLevel = kMaxLevel;
  Result<DatabaseWriter> writer = DatabaseWriter::create(path, info);
  REQUIRE(writer);
  std::vector<TileKey> keys = storeTree(*writer, 12);
  // Codes of level 19 are negative numbers to SQLite.
  keys.push_back(TileKey::fromGrid(kMaxLevel, 0, 0, 0));
  REQUIRE(writer->begin());
  REQUIRE(writer->putChunk(syntheticChunk(keys.back(), kTextureSize, false)));
  CHECK(writer->setChildren(keys.back(), 0));
  REQUIRE(writer->commit());

  const Result<DatabaseReader> reader = DatabaseReader::open(path);
  REQUIRE(reader);
  std::vector<TileKey> seen;
  REQUIRE(reader->forEach([&](const ChunkMeta& meta) -> Result<void> {
    CHECK(reader->read(meta.key));  // reading inside a walk
    seen.push_back(meta.key);
    return {};
  }));
  CHECK(std::is_sorted(seen.begin(), seen.end(), [](auto& a, auto& b) { return a.level() < b.level(); }));
  CHECK(seen.size() == keys.size());
  CHECK(std::is_permutation(seen.begin(), seen.end(), keys.begin()));
  const auto stop = [](const ChunkMeta&) -> Result<void> { return fail(ErrorKind::usage, "enough"); };
  CHECK(reader->forEach(stop).error().message == "enough");

  const auto levels = reader->levels();
  REQUIRE(levels);
  REQUIRE(levels->size() == 4);
  CHECK((*levels)[0].tiles == 8);
  CHECK((*levels)[0].leaves == 0);
  CHECK((*levels)[1].tiles == 24);
  CHECK((*levels)[1].leaves == 20);
  CHECK((*levels)[1].meanErrorM == Approx(5e5));
  CHECK((*levels)[1].maxErrorM == 5e5);
  CHECK((*levels)[0].meshBytes > 0);
  CHECK((*levels)[0].imageryBytes > 0);
  CHECK((*levels)[3].level == kMaxLevel);
  CHECK((*levels)[3].tiles == 1);
}

TEST_CASE("Zeroes with a sign come back and keep their checksum") {
  const TempFolder folder;
  const std::string path = folder.file("a.eyt");
  Result<DatabaseWriter> writer = DatabaseWriter::create(path, smallInfo());
  REQUIRE(writer);
  StoredChunk chunk = syntheticChunk(TileKey::octantRoot(0), kTextureSize, true);
  chunk.meta.texelErrorM = -0.0;
  REQUIRE(writer->begin());
  REQUIRE(writer->putChunk(chunk));
  REQUIRE(writer->commit());
  CHECK(writer->contains(chunk.meta.key).value());
  CHECK(writer->readMeta(chunk.meta.key).value()->texelErrorM == 0.0);
}

TEST_CASE("No child's error exceeds its parent's, however late it comes") {
  const TempFolder folder;
  const std::string path = folder.file("a.eyt");
  Result<DatabaseWriter> writer = DatabaseWriter::create(path, smallInfo());
  REQUIRE(writer);
  storeTree(*writer, 12);
  const TileKey root = TileKey::octantRoot(0), child = root.children().items[1];
  REQUIRE(writer->begin());
  for (const TileKey& grandchild : child.children()) {
    StoredChunk chunk = syntheticChunk(grandchild, kTextureSize, false);
    if (grandchild == child.children().items[2]) chunk.meta.geometricErrorM = 3e6;
    REQUIRE(writer->putChunk(chunk));
  }
  REQUIRE(writer->setChildren(child, 4));
  REQUIRE(writer->commit());
  CHECK(writer->readMeta(child).value()->geometricErrorM == 3e6);
  CHECK(writer->readMeta(root).value()->geometricErrorM == 3e6);
  CHECK(writer->readMeta(TileKey::octantRoot(1)).value()->geometricErrorM == 1e6);
  REQUIRE(writer->finish());
  CHECK(DatabaseReader::open(path)->verify({}));

  REQUIRE(writer->begin());
  const Result<void> early = writer->setChildren(child.children().items[0], 4);
  REQUIRE_FALSE(early);
  CHECK(early.error().kind == ErrorKind::notFound);
  CHECK_FALSE(writer->setChildren(TileKey::fromGrid(5, 0, 0, 0), 0));  // not in the file
  REQUIRE(writer->commit());
}

TEST_CASE("Chunks that cannot be true are not stored") {
  const TempFolder folder;
  Result<DatabaseWriter> writer = DatabaseWriter::create(folder.file("a.eyt"), smallInfo());
  REQUIRE(writer);
  REQUIRE(writer->begin());
  const TileKey key = TileKey::fromGrid(4, 0, 3, 2);
  const auto refused = [&](const char* why, const std::function<void(StoredChunk&)>& spoil) {
    StoredChunk chunk = syntheticChunk(key, kTextureSize, true);
    spoil(chunk);
    const Result<void> put = writer->putChunk(chunk);
    REQUIRE_FALSE(put);
    CHECK_THAT(put.error().message, Catch::Contains(why) && Catch::Contains("L4 octant 0 row 3 column 2"));
  };
  refused("not finite", [](StoredChunk& c) { c.meta.horizonPointScaled.y = NAN; });
  refused("not finite", [](StoredChunk& c) { c.meta.sphereRadiusM = INFINITY; });
  refused("error is out of range", [](StoredChunk& c) { c.meta.geometricErrorM = -1; });
  refused("heights", [](StoredChunk& c) { c.meta.maxHeightM = 2e6; });
  refused("heights", [](StoredChunk& c) { c.meta.minHeightM = c.meta.maxHeightM + 1; });
  refused("sphere is empty", [](StoredChunk& c) { c.meta.sphereRadiusM = 0; });
  refused("sphere lies elsewhere", [](StoredChunk& c) { c.meta.sphereCentreEcefM *= -1.0; });
  refused("box lies elsewhere", [](StoredChunk& c) { c.meta.box.centreEcefM *= -1.0; });
  refused("not rectangular", [](StoredChunk& c) { c.meta.box.halfAxesEcefM[0] = c.meta.box.halfAxesEcefM[1]; });
  refused("origin lies elsewhere", [](StoredChunk& c) { c.meta.originLattice *= -1; });
  refused("origin is out of range", [](StoredChunk& c) { c.meta.originLattice.x = INT64_MAX; });
  refused("shift", [](StoredChunk& c) { c.meta.latticeShift = 40; });
  refused("child count", [](StoredChunk& c) { c.meta.childCount = 3; });
  refused("imagery", [](StoredChunk& c) { c.imagery.clear(); });
  StoredChunk polar = syntheticChunk(TileKey::fromGrid(4, 0, 15, 0), kTextureSize, true);
  polar.meta.hasImagery = false;
  polar.imagery.clear();
  CHECK_FALSE(writer->putChunk(polar));
  CHECK_FALSE(writer->putChunk(syntheticChunk(TileKey::fromGrid(7, 0, 3, 2), kTextureSize, true)));  // above maxLevel
  CHECK(writer->putChunk(syntheticChunk(key, kTextureSize, true)));
}

TEST_CASE("Creating and resuming say what stands against it") {
  const TempFolder folder;
  const std::string path = folder.file("a.eyt");
  writeSmallDatabase(path);
  CHECK(DatabaseWriter::create(path, smallInfo()).error().kind == ErrorKind::usage);
  CHECK_THAT(DatabaseWriter::create(path, smallInfo()).error().message, Catch::Contains("exists already"));
  CHECK(DatabaseWriter::create(folder.file("no/such/b.eyt"), smallInfo()).error().kind == ErrorKind::io);
  CHECK(DatabaseWriter::resume(folder.file("none.eyt"), smallInfo()).error().kind == ErrorKind::notFound);
  DatabaseInfo bad = smallInfo();
  bad.textureSize = 100;
  CHECK(DatabaseWriter::create(folder.file("c.eyt"), bad).error().kind == ErrorKind::usage);
  CHECK_FALSE(fs::exists(folder.file("c.eyt")));

  CHECK(DatabaseWriter::resume(path, smallInfo()));
  const auto refusal = [&](const std::function<void(DatabaseInfo&)>& change) {
    DatabaseInfo info = smallInfo();
    change(info);
    const Result<DatabaseWriter> writer = DatabaseWriter::resume(path, info);
    REQUIRE_FALSE(writer);
    CHECK(writer.error().kind == ErrorKind::usage);
    return writer.error().message;
  };
  CHECK_THAT(refusal([](DatabaseInfo& i) { i.maxLevel = 9; }), Catch::Contains("highest level was 6 and is now 9"));
  CHECK_THAT(refusal([](DatabaseInfo& i) { i.finestErrorM = 1; }), Catch::Contains("error in metres was 0.25 and"));
  CHECK_THAT(refusal([](DatabaseInfo& i) { i.textureSize = 64; }), Catch::Contains("texture size was 16"));
  CHECK_THAT(refusal([](DatabaseInfo& i) { i.description += "x"; }), Catch::Contains("description"));
  CHECK_THAT(refusal([](DatabaseInfo& i) { i.dataBounds.westDeg = 19; }), Catch::Contains("extent"));
}

TEST_CASE("A resumed bake mends a damaged tile and goes on") {
  const TempFolder folder;
  const std::string path = folder.file("a.eyt");
  const std::vector<TileKey> keys = writeSmallDatabase(path);
  runSql(path, fmt::format("UPDATE chunk_data SET mesh = zeroblob(length(mesh)) WHERE code = {}", keys[20].code()));
  {
    Result<DatabaseWriter> writer = DatabaseWriter::resume(path, smallInfo());
    REQUIRE(writer);
    CHECK(writer->contains(keys[3]).value());
    CHECK_FALSE(writer->contains(TileKey::fromGrid(6, 0, 0, 0)).value());
    REQUIRE_FALSE(writer->contains(keys[20]).value());
    REQUIRE(writer->begin());
    REQUIRE(writer->putChunk(syntheticChunk(keys[20], kTextureSize, false)));
    REQUIRE(writer->commit());
    CHECK(writer->contains(keys[20]).value());
  }
  CHECK(DatabaseReader::open(path)->verify({}));
}

TEST_CASE("What is no terrain database is named for what it is") {
  const TempFolder folder;
  const std::string path = folder.file("a.eyt");
  CHECK(openError(path).kind == ErrorKind::notFound);
  CHECK_THAT(openError(folder.path.string()).message, Catch::Contains("is a folder"));
  writeFile(path, "");
  CHECK_THAT(openError(path).message, Catch::Contains("is empty"));
  writeFile(path, std::string(20000, 'x'));
  CHECK_THAT(openError(path).message, Catch::Contains("is not a terrain database"));
  writeFile(path, "short");
  CHECK_THAT(openError(path).message, Catch::Contains("is not a terrain database"));
  fs::remove(path);
  runSql(path, "CREATE TABLE t (x)");
  CHECK_THAT(openError(path).message, Catch::Contains("is an SQLite file but no terrain database"));

  fs::remove(path);
  writeSmallDatabase(path);
  const std::string good = readFile(path);
  const auto spoiled = [&](const std::string& sql) {
    writeFile(path, good);
    runSql(path, sql);
    return openError(path);
  };
  CHECK(spoiled("PRAGMA user_version = 99").kind == ErrorKind::unsupported);
  CHECK_THAT(openError(path).message, Catch::Contains("newer"));
  CHECK_THAT(spoiled("CREATE VIEW v AS SELECT 1").message, Catch::Contains("`v`"));
  CHECK_THAT(spoiled("CREATE TRIGGER t AFTER INSERT ON info BEGIN SELECT 1; END").message, Catch::Contains("`t`"));
  CHECK_THAT(spoiled("DROP TABLE chunk; CREATE VIEW chunk AS SELECT * FROM chunk_data").message,
             Catch::Contains("`chunk`"));
  CHECK_THAT(spoiled("DELETE FROM info WHERE key = 'max_level'").message, Catch::Contains("`max_level` is missing"));
  CHECK_THAT(spoiled("UPDATE info SET value = 'six' WHERE key = 'max_level'").message, Catch::Contains("missing"));
  CHECK_THAT(spoiled("UPDATE info SET value = 400 WHERE key = 'max_level'").message, Catch::Contains("highest level"));
  CHECK_THAT(spoiled("UPDATE info SET value = 1e999 WHERE key = 'finest_error_m'").message,
             Catch::Contains("finest level's error"));
  CHECK_THAT(spoiled("UPDATE info SET value = 5 WHERE key = 'max_level'").message, Catch::Contains("checksum"));
  CHECK_FALSE(spoiled("UPDATE info SET value = zeroblob(15000000) WHERE key = 'description'").message.empty());
}

TEST_CASE("A damaged tile is named, with what to do") {
  const TempFolder folder;
  const std::string path = folder.file("a.eyt");
  const std::vector<TileKey> keys = writeSmallDatabase(path);
  const std::string good = readFile(path);
  const TileKey victim = keys[14];
  const auto spoiled = [&](const std::string& sql) {
    writeFile(path, good);
    runSql(path, fmt::format("{} WHERE code = {}", sql, victim.code()));
    const Result<DatabaseReader> reader = DatabaseReader::open(path);
    REQUIRE(reader);
    CHECK(reader->read(keys[2]));
    const Result<StoredChunk> chunk = reader->read(victim);
    REQUIRE_FALSE(chunk);
    CHECK(reader->verify({}).error().message == chunk.error().message);
    return chunk.error().message;
  };
  CHECK(
      spoiled("UPDATE chunk_data SET mesh = CAST(x'00' || substr(mesh, 2) AS BLOB)") ==
      fmt::format("{}: tile {} (code {:#x}): checksum does not match; bake it again with --resume or restore the file",
                  path, victim.name(), victim.code()));
  CHECK_THAT(spoiled("UPDATE chunk_data SET imagery = zeroblob(5)"), Catch::Contains("checksum"));
  CHECK_THAT(spoiled("UPDATE chunk SET error_m = error_m / 2"), Catch::Contains("checksum"));
  CHECK_THAT(spoiled("UPDATE chunk SET mesh_bytes = -1"), Catch::Contains("checksum"));

  writeFile(path, good);
  runSql(path, fmt::format("DELETE FROM chunk_data WHERE code = {}", victim.code()));
  CHECK_FALSE(DatabaseReader::open(path)->read(victim));
  CHECK_FALSE(DatabaseReader::open(path)->verify({}));
  runSql(path, fmt::format("DELETE FROM chunk WHERE code = {}", victim.code()));
  CHECK(DatabaseReader::open(path)->read(victim).error().kind == ErrorKind::notFound);
  CHECK_THAT(DatabaseReader::open(path)->verify({}).error().message, Catch::Contains(victim.name()));
  writeFile(path, good);
  runSql(path, "DELETE FROM chunk; DELETE FROM chunk_data");
  CHECK_THAT(DatabaseReader::open(path)->verify({}).error().message, Catch::Contains("L0 octant 0"));
}

TEST_CASE("Verifying finds what checksums cannot: wrong blobs and bounds, lost trees") {
  const TempFolder folder;
  const std::string path = folder.file("a.eyt");
  int made = 0;
  // The verdict on a good tree with one more family, of which one tile is spoilt, under the ninth tile.
  const auto verdict = [&](const std::function<void(StoredChunk&)>& spoil, bool counted) {
    const std::string file = folder.file(std::to_string(++made) + ".eyt");
    Result<DatabaseWriter> writer = DatabaseWriter::create(file, smallInfo());
    REQUIRE(writer);
    const std::vector<TileKey> keys = storeTree(*writer, 8);
    REQUIRE(writer->begin());
    for (const TileKey& child : keys[9].children()) {
      StoredChunk chunk = syntheticChunk(child, kTextureSize, true);
      if (child == keys[9].children().items[1]) spoil(chunk);
      REQUIRE(writer->putChunk(chunk));
    }
    if (counted) REQUIRE(writer->setChildren(keys[9], 4));
    REQUIRE(writer->commit());
    REQUIRE(writer->finish());
    const Result<void> result = DatabaseReader::open(file)->verify({});
    return result ? std::string("good") : result.error().message;
  };
  CHECK(verdict([](StoredChunk&) {}, true) == "good");
  CHECK_THAT(verdict([](StoredChunk&) {}, false), Catch::Contains("its parent does not count it"));
  CHECK_THAT(verdict([](StoredChunk& c) { c.mesh.resize(50); }, true), Catch::Contains("mesh blob"));
  CHECK_THAT(verdict([](StoredChunk& c) { c.imagery = encodeImagery(syntheticPicture(32, 1), 32); }, true),
             Catch::Contains("imagery blob: 32 x 32"));
  CHECK_THAT(verdict([](StoredChunk& c) { c.meta.sphereRadiusM *= 0.9; }, true),
             Catch::Contains("outside its bounding sphere"));
  CHECK_THAT(verdict([](StoredChunk& c) { c.meta.box.halfAxesEcefM[1] *= 0.9; }, true),
             Catch::Contains("outside its bounding box"));
  CHECK_THAT(verdict([](StoredChunk& c) { c.meta.maxHeightM -= 20; }, true), Catch::Contains("outside its heights"));
  CHECK_THAT(verdict([](StoredChunk& c) { c.meta.originLattice.z += 1000; }, true), Catch::Contains("outside"));
}

TEST_CASE("Flipped bits and cut files never crash a reader, and never pass for good") {
  const TempFolder folder;
  const std::string path = folder.file("a.eyt"), damagedPath = folder.file("b.eyt");
  const std::vector<TileKey> keys = writeSmallDatabase(path);
  const std::string good = readFile(path);
  std::vector<StoredChunk> originals;
  for (const TileKey& key : keys) originals.push_back(DatabaseReader::open(path)->read(key).value());

  std::mt19937_64 random(99);
  int opened = 0, verified = 0;
  const auto judge = [&](const std::string& bytes) {
    writeFile(damagedPath, bytes);
    const Result<DatabaseReader> reader = DatabaseReader::open(damagedPath);
    if (!reader) return;
    ++opened;
    CHECK(reader->info().description == "synthetic hills");
    size_t intact = 0;
    for (size_t i = 0; i < keys.size(); ++i) {
      const Result<StoredChunk> chunk = reader->read(keys[i]);
      if (!chunk) continue;
      ++intact;
      CHECK(sameChunk(*chunk, originals[i]));
    }
    (void)reader->levels();
    if (reader->verify({})) {
      ++verified;
      CHECK(intact == keys.size());
    }
  };
  for (int i = 0; i < 200; ++i) {
    std::string bytes = good;
    // A quarter in the headers and the first page, where one bit changes most.
    const size_t at = i % 4 == 0 ? random() % 9000 : random() % bytes.size();
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << (random() % 8)));
    judge(bytes);
  }
  INFO(opened << " opened, " << verified << " verified");
  CHECK(opened > 100);
  CHECK(verified < 150);  // about half of so small a file is room between rows
  for (int i = 0; i < 50; ++i) judge(good.substr(0, random() % good.size()));
}

TEST_CASE("A flipped byte of any blob is found") {
  const TempFolder folder;
  const std::string path = folder.file("a.eyt"), damagedPath = folder.file("b.eyt");
  const std::vector<TileKey> keys = writeSmallDatabase(path, 2);
  const std::string good = readFile(path);
  for (const TileKey& key : keys) {
    const StoredChunk chunk = DatabaseReader::open(path)->read(key).value();
    for (const Blob* blob : {&chunk.mesh, &chunk.imagery}) {
      if (blob->empty()) continue;
      // A stretch of the blob as it lies in the file; blobs of a chunk are short enough to lie in one piece.
      const std::string bytes(reinterpret_cast<const char*>(blob->data()), blob->size());
      const size_t at = good.find(bytes);
      REQUIRE(at != std::string::npos);
      std::string spoilt = good;
      spoilt[at + bytes.size() / 2] ^= 1;
      writeFile(damagedPath, spoilt);
      const Result<void> verdict = DatabaseReader::open(damagedPath)->verify({});
      REQUIRE_FALSE(verdict);
      CHECK_THAT(verdict.error().message, Catch::Contains(key.name()) && Catch::Contains("checksum does not match"));
    }
  }
}

TEST_CASE("A writer that is killed leaves what it had committed") {
  const TempFolder folder;
  for (const bool byKill : {true, false}) {
    const std::string path = folder.file(byKill ? "kill.eyt" : "exit.eyt");
    const int status = inChild([&] {
      Result<DatabaseWriter> writer = DatabaseWriter::create(path, smallInfo());
      const std::vector<TileKey> keys = storeTree(*writer, 12);
      (void)writer->begin();
      for (const TileKey& child : keys[12].children()) {
        (void)writer->putChunk(syntheticChunk(child, kTextureSize, false));
      }
      (void)writer->setChildren(keys[12], 4);
      if (byKill) kill(getpid(), SIGKILL);
      _exit(0);  // without closing anything
      return 0;
    });
    CHECK((byKill ? WIFSIGNALED(status) : WIFEXITED(status)));
    std::vector<TileKey> keys;
    {
      const Result<DatabaseReader> reader = DatabaseReader::open(path);
      REQUIRE(reader);
      CHECK_FALSE(reader->info().complete);
      CHECK(reader->verify({}));
      REQUIRE(reader->forEach([&keys](const ChunkMeta& meta) -> Result<void> {
        keys.push_back(meta.key);
        return {};
      }));
    }
    CHECK(keys.size() == 8 + 8 * 3 + 4 * 3 + 3);  // as storeTree counts: 8 roots, 8 families of roots, 4 more
  }
}

TEST_CASE("A bake in progress can be read, and what it commits later too") {
  const TempFolder folder;
  const std::string path = folder.file("a.eyt");
  Result<DatabaseWriter> writer = DatabaseWriter::create(path, smallInfo());
  REQUIRE(writer);
  const std::vector<TileKey> keys = storeTree(*writer, 4);
  const Result<DatabaseReader> reader = DatabaseReader::open(path), second = DatabaseReader::open(path);
  REQUIRE(reader);
  REQUIRE(second);
  const TileKey parent = keys[8], child = parent.children().items[0];
  REQUIRE(writer->begin());
  for (const TileKey& key : parent.children()) REQUIRE(writer->putChunk(syntheticChunk(key, kTextureSize, true)));
  REQUIRE(writer->setChildren(parent, parent.children().count));
  CHECK(reader->read(child).error().kind == ErrorKind::notFound);
  CHECK(reader->read(keys[3]));
  REQUIRE(writer->commit());
  CHECK(reader->read(child));
  CHECK(second->read(child));
  CHECK(reader->verify({}));
  REQUIRE(writer->finish());
  CHECK(reader->read(child));
}

TEST_CASE("A file on a medium that cannot be written opens") {
  const TempFolder folder;
  const std::string path = folder.file("a #1?.eyt");
  writeSmallDatabase(path);
  // Both kinds: as the bake leaves it, and copied from the middle of a bake, marked as having a log.
  for (const char* mode : {"DELETE", "WAL"}) {
    runSql(path, std::string("PRAGMA journal_mode = ") + mode);
    if (std::string(mode) == "WAL") REQUIRE(readFile(path)[18] == 2);
    fs::permissions(path, fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read);
    fs::permissions(folder.path, fs::perms(0555));
    const int status = inChild([&] {
      if (geteuid() == 0 && setuid(65534) != 0) return 2;  // root may write everywhere
      const Result<DatabaseReader> reader = DatabaseReader::open(path);
      return reader && reader->verify({}) ? 0 : 1;
    });
    fs::permissions(folder.path, fs::perms(0755));
    fs::permissions(path, fs::perms(0644));
    CHECK(WEXITSTATUS(status) == 0);
  }
}

TEST_CASE("A full disk is said in one line and leaves a valid file") {
  const TempFolder folder;
  const int status = inChild([&]() -> int {
    if (mount("tmpfs", folder.path.c_str(), "tmpfs", 0, "size=512k") != 0) return 77;
    const std::string path = folder.file("a.eyt");
    int verdict = 0;
    {
      Result<DatabaseWriter> writer = DatabaseWriter::create(path, smallInfo());
      const std::vector<TileKey> keys = storeTree(*writer, 2);
      std::optional<Error> error;
      for (uint32_t row = 0; row < 60 && !error; ++row) {
        (void)writer->begin();
        StoredChunk chunk = syntheticChunk(TileKey::fromGrid(6, 0, row, 0), kTextureSize, true);
        std::vector<uint8_t> noise(16 * 16 * 3, static_cast<uint8_t>(row));
        chunk.mesh.resize(20000, static_cast<std::byte>(row));
        const Result<void> put = writer->putChunk(chunk);
        const Result<void> done = put ? writer->commit() : put;
        if (!done) error = done.error();
      }
      if (!error || error->kind != ErrorKind::noSpace) verdict = 3;
    }
    const Result<DatabaseReader> reader = DatabaseReader::open(path);
    if (!reader || !reader->read(TileKey::octantRoot(7))) verdict = 4;
    umount(folder.path.c_str());
    return verdict;
  });
  if (WEXITSTATUS(status) == 77) {
    WARN("no right to mount a small disk here: not tested");
    return;
  }
  CHECK(WEXITSTATUS(status) == 0);
}

}  // namespace eye

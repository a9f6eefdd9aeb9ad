// Two processes that share a bake, as on two machines: what merge makes of them is what one process bakes.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "system/program.h"
#include "system/rasters.h"
#include "terrain/database.h"

namespace eye::truth {
namespace {

std::vector<std::string> tilesOf(const std::string& path) {
  const auto reader = DatabaseReader::open(path);
  REQUIRE(reader);
  std::vector<std::string> tiles;
  REQUIRE(reader->forEach([&](const ChunkMeta& meta) -> Result<void> {
    const StoredChunk chunk = reader->read(meta.key).value();
    std::string& tile = tiles.emplace_back(meta.key.name() + std::to_string(meta.childCount));
    tile.append(reinterpret_cast<const char*>(&meta.geometricErrorM), sizeof(double));
    for (const Blob* blob : {&chunk.mesh, &chunk.imagery})
      tile.append(reinterpret_cast<const char*>(blob->data()), blob->size());
    return {};
  }));
  return tiles;
}

}  // namespace

TEST_CASE("shards: two processes and a merge give what one process gives") {
  const std::string source = testFile("shards.tif"), whole = testFile("shards_whole.eyt");
  const std::string merged = testFile("shards_merged.eyt");
  const std::string parts[] = {testFile("shards_1.eyt"), testFile("shards_2.eyt")};
  const HeightGrid hills({-88, -178, 4, 45, 90}, [](double lat, double lon) {
    return 3000 * std::sin(lat * 0.13) * std::cos(lon * 0.0174533 * 4);
  });
  writeElevation(source, hills);
  for (const std::string& file : {whole, merged, parts[0], parts[1]}) std::filesystem::remove(file);
  const auto bake = [&](const std::string& out, std::vector<std::string> more) {
    more.insert(more.end(), {"--elevation", source, "--texture-size", "16", "--out", out, "--log-level", "warn"});
    return runProgram("eyepoint-bake", more);
  };
  std::array<ProgramRun, 2> runs;
  {
    std::jthread first([&] { runs[0] = bake(parts[0], {"--shard", "1/2"}); });
    std::jthread second([&] { runs[1] = bake(parts[1], {"--shard", "2/2", "--resume"}); });
  }
  for (const ProgramRun& run : runs) {
    INFO(run.err);
    REQUIRE(run.exitCode == 0);
  }
  REQUIRE(bake(whole, {}).exitCode == 0);
  const ProgramRun merge = runProgram("eyepoint-bake", {"merge", merged, parts[1], parts[0]});
  INFO(merge.err);
  REQUIRE(merge.exitCode == 0);
  CHECK(runProgram("eyepoint-bake", {"verify", merged}).exitCode == 0);
  CHECK((tilesOf(merged) == tilesOf(whole)));

  const ProgramRun again = runProgram("eyepoint-bake", {"merge", merged, parts[1], parts[0]});
  CHECK(again.exitCode == 2);
  CHECK(again.errorLines().size() == 1);
  for (const char* shard : {"0/2", "3/2", "1", "x/y"}) {
    const ProgramRun refused = bake(testFile("shards_none.eyt"), {"--shard", shard});
    CHECK(refused.exitCode == 2);
    CHECK(refused.err.find("--shard") != std::string::npos);
  }
}

}  // namespace eye::truth

// Bakes that are shared out: each shard is sound, together they are the whole, however they were interrupted.
#include <sys/wait.h>

#include <spdlog/spdlog.h>
#include <unistd.h>
#include <catch2/catch.hpp>
#include <csignal>
#include <map>

#include "bake/bake_job.h"
#include "bake/merge.h"
#include "bake/shard.h"
#include "raster_files.h"

using namespace eye;

namespace {

constexpr int kShards = 3;

// A coarse globe with a finer spot: some 600 tiles.
BakeJob globeJob(const TestFolder& folder, const std::string& out, std::optional<Shard> shard = {}, int maxLevel = 10) {
  const std::string spot = folder.file("spot.tif"), globe = folder.file("globe.tif");
  if (!std::filesystem::exists(globe)) {
    writeHeights(spot, postGrid(49, 20, 1.0 / 60, 31, 31), hillsM);
    writeHeights(globe, postGrid(-88, -178, 4, 45, 90), [](double lat, double lon) {
      return 2000 * std::sin(lat * 0.11) * std::cos(lon * 0.017453292519943295 * 5);
    });
  }
  BakeJob job;
  job.elevation = {spot, globe};
  job.out = folder.file(out);
  job.plan.maxLevel = maxLevel;
  if (maxLevel == 10) job.plan.errorM = 20;
  job.plan.textureSize = 16;
  job.plan.shard = shard;
  return job;
}

Result<BakeOutcome> run(BakeJob job, std::function<void(const BakeProgress&)> progress = {}) {
  spdlog::set_level(spdlog::level::warn);
  BakeControl control;
  control.jobs = 1;
  control.progress = std::move(progress);
  job.resume = true;
  return runBake(job, control);
}

void mustComplete(const BakeJob& job) {
  const auto outcome = run(job);
  INFO((outcome ? std::string() : outcome.error().message));
  REQUIRE(outcome);
  REQUIRE(*outcome == BakeOutcome::complete);
}

// Every column and blob of every tile.
std::map<uint64_t, std::string> contentOf(const std::string& path) {
  const auto reader = DatabaseReader::open(path);
  INFO((reader ? std::string() : reader.error().message));
  REQUIRE(reader);
  const auto sound = reader->verify([](uint64_t, uint64_t) {});
  INFO((sound ? std::string() : sound.error().message));
  REQUIRE(sound);
  std::map<uint64_t, std::string> content;
  REQUIRE(reader->forEach([&](const ChunkMeta& meta) -> Result<void> {
    const StoredChunk chunk = reader->read(meta.key).value();
    std::string& text = content[meta.key.code()];
    text.append(reinterpret_cast<const char*>(&meta.geometricErrorM), sizeof(double));
    text.append(reinterpret_cast<const char*>(&meta.texelErrorM), sizeof(double));
    text += std::to_string(meta.childCount) + (meta.hasImagery ? "i" : "-");
    for (const Blob* blob : {&chunk.mesh, &chunk.imagery})
      text.append(reinterpret_cast<const char*>(blob->data()), blob->size());
    return {};
  }));
  return content;
}

Result<void> merge(const TestFolder& folder, const std::string& out, const std::vector<std::string>& parts) {
  std::vector<std::string> paths;
  for (const std::string& part : parts) paths.push_back(folder.file(part));
  return mergeShards(folder.file(out), paths, [](uint64_t, uint64_t) {});
}

std::string complaint(const Result<void>& result) {
  REQUIRE_FALSE(result);
  return result.error().message;
}

}  // namespace

TEST_CASE("Shards together are the whole bake, byte for byte of every tile, in whatever order") {
  TestFolder folder;
  mustComplete(globeJob(folder, "whole.eyt"));
  const auto whole = contentOf(folder.file("whole.eyt"));
  REQUIRE(whole.size() > 400);
  size_t tiles = 0;
  for (int i = 1; i <= kShards; ++i) {
    const std::string part = "part" + std::to_string(i) + ".eyt";
    mustComplete(globeJob(folder, part, Shard{i, kShards}));
    const auto content = contentOf(folder.file(part));  // a database of its own
    CHECK(content.size() < whole.size() * 4 / 5);
    tiles += content.size();
  }
  CHECK(tiles > whole.size());
  const auto merged = merge(folder, "merged.eyt", {"part3.eyt", "part1.eyt", "part2.eyt"});
  INFO((merged ? std::string() : merged.error().message));
  REQUIRE(merged);
  CHECK((contentOf(folder.file("merged.eyt")) == whole));
  CHECK_FALSE(std::filesystem::exists(folder.file("merged.eyt.part")));
  const auto a = DatabaseReader::open(folder.file("merged.eyt")).value();
  const auto b = DatabaseReader::open(folder.file("whole.eyt")).value();
  CHECK(a.info().description == b.info().description);
  CHECK(a.info().complete);
}

TEST_CASE("A bake of two levels is shared all the same") {
  TestFolder folder;
  mustComplete(globeJob(folder, "whole.eyt", {}, 1));
  std::vector<std::string> parts;
  for (int i = 1; i <= 4; ++i) {
    parts.push_back("part" + std::to_string(i));
    mustComplete(globeJob(folder, parts.back(), Shard{i, 4}, 1));
  }
  REQUIRE(merge(folder, "merged.eyt", parts));
  CHECK((contentOf(folder.file("merged.eyt")) == contentOf(folder.file("whole.eyt"))));
}

TEST_CASE("A shard that is killed goes on where it was, and the whole is the same") {
  TestFolder folder;
  mustComplete(globeJob(folder, "whole.eyt"));
  mustComplete(globeJob(folder, "one.eyt", Shard{1, 2}));
  const BakeJob job = globeJob(folder, "two.eyt", Shard{2, 2});
  const pid_t child = ::fork();
  if (child == 0) {
    (void)run(job, [](const BakeProgress& progress) {
      if (progress.baked > 40) ::kill(::getpid(), SIGKILL);
    });
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  CHECK(complaint(merge(folder, "early.eyt", {"one.eyt", "two.eyt"})).find("--resume") != std::string::npos);
  mustComplete(job);
  REQUIRE(merge(folder, "merged.eyt", {"one.eyt", "two.eyt"}));
  CHECK((contentOf(folder.file("merged.eyt")) == contentOf(folder.file("whole.eyt"))));
}

TEST_CASE("Merging says what is missing, twice, foreign or in the way") {
  TestFolder folder;
  mustComplete(globeJob(folder, "whole.eyt", {}, 1));
  for (int i = 1; i <= kShards; ++i) mustComplete(globeJob(folder, "part" + std::to_string(i), Shard{i, kShards}, 1));
  BakeJob foreign = globeJob(folder, "foreign", Shard{2, kShards}, 1);
  foreign.plan.textureSize = 32;
  mustComplete(foreign);
  CHECK(complaint(merge(folder, "m", {"part1", "part3"})).find("shards 2 of 3 are missing") != std::string::npos);
  CHECK(complaint(merge(folder, "m", {"part1", "part2", "part1"})).find("once") != std::string::npos);
  CHECK(complaint(merge(folder, "m", {"part1", "foreign", "part3"})).find("another bake") != std::string::npos);
  CHECK(complaint(merge(folder, "m", {"whole.eyt"})).find("no shard") != std::string::npos);
  CHECK(complaint(merge(folder, "m", {"nowhere"})).find("nowhere") != std::string::npos);
  CHECK(complaint(merge(folder, "whole.eyt", {"part1", "part2", "part3"})).find("exists") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder.file("m")));
  // What merging writes to before it is whole is not what it reads.
  std::filesystem::rename(folder.file("part3"), folder.file("m.part"));
  CHECK(complaint(merge(folder, "m", {"part1", "part2", "m.part"})).find("rename it") != std::string::npos);
  CHECK(std::filesystem::exists(folder.file("m.part")));
  // A shard is resumed as that shard alone.
  CHECK_FALSE(run(globeJob(folder, "part1", Shard{2, kShards}, 1)));
}

TEST_CASE("I/N names a shard") {
  CHECK(parseShard("2/16")->index == 2);
  CHECK(parseShard("2/16")->count == 16);
  for (const char* text : {"", "2", "0/4", "5/4", "1/0", "1/5000", "-1/4", "1/4x", "a/b", "1/", "/2"}) {
    INFO(text);
    CHECK_FALSE(parseShard(text));
  }
  const auto described = shardFrom("elevation: a; shard 3; imagery: b" + describeShard({3, 7}));
  REQUIRE(described);
  CHECK(described->sources == "elevation: a; shard 3; imagery: b");
  CHECK(described->shard.count == 7);
  CHECK_FALSE(shardFrom("elevation: a; imagery: b"));
}

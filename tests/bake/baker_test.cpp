#include <sys/mount.h>
#include <sys/wait.h>

#include <spdlog/spdlog.h>
#include <catch2/catch.hpp>
#include <csignal>
#include <thread>

#include "bake/bake_job.h"
#include "bake/demo_terrain.h"
#include "geo/demo_site.h"
#include "raster_files.h"

using namespace eye;

namespace {

// A small bake: some hundred tiles.
BakeJob smallJob(const TestFolder& folder, const std::string& out) {
  const std::string elevation = folder.file("hills.tif");
  if (!std::filesystem::exists(elevation)) {
    writeHeights(elevation, postGrid(49, 20, 1.0 / 300, 61, 61), hillsM);
  }
  BakeJob job;
  job.elevation = {elevation};
  job.out = folder.file(out);
  job.plan.errorM = 4;
  job.plan.textureSize = 32;
  return job;
}

BakeControl withJobs(int jobs) {
  spdlog::set_level(spdlog::level::warn);
  BakeControl control;
  control.jobs = jobs;
  return control;
}

// Every tile's content: equal strings for equal databases, whatever the order of pages in the file.
std::vector<std::string> contentOf(const std::string& path) {
  const auto reader = DatabaseReader::open(path);
  INFO((reader ? std::string() : reader.error().message));
  REQUIRE(reader);
  REQUIRE(reader->verify([](uint64_t, uint64_t) {}));
  std::vector<std::string> content;
  REQUIRE(reader->forEach([&](const ChunkMeta& meta) -> Result<void> {
    const StoredChunk chunk = reader->read(meta.key).value();
    std::string text = meta.key.name() + " " + std::to_string(meta.geometricErrorM) + " " +
                       std::to_string(meta.childCount) + " " + std::to_string(meta.texelErrorM) + " ";
    for (const Blob* blob : {&chunk.mesh, &chunk.imagery}) {
      text.append(reinterpret_cast<const char*>(blob->data()), blob->size());
    }
    content.push_back(std::move(text));
    return {};
  }));
  return content;
}

void mustComplete(const BakeJob& job, int jobs = 2) {
  const auto outcome = runBake(job, withJobs(jobs));
  INFO((outcome ? std::string() : outcome.error().message));
  REQUIRE(outcome);
  CHECK(*outcome == BakeOutcome::complete);
}

}  // namespace

TEST_CASE("A bake is sound, refines where the data is, and does not depend on the threads") {
  TestFolder folder;
  mustComplete(smallJob(folder, "one.eyt"), 1);
  mustComplete(smallJob(folder, "three.eyt"), 3);
  const auto one = contentOf(folder.file("one.eyt"));
  CHECK(one.size() > 100);
  CHECK((one == contentOf(folder.file("three.eyt"))));

  const auto reader = DatabaseReader::open(folder.file("one.eyt")).value();
  CHECK(reader.info().complete);
  CHECK(reader.readMeta(TileKey::containing(49.1, 20.1, reader.info().maxLevel)));
  CHECK(!reader.readMeta(TileKey::containing(-49.1, -20.1, 2)));
  const auto levels = reader.levels().value();
  for (size_t i = 1; i < levels.size(); ++i) CHECK(levels[i].maxErrorM <= levels[i - 1].maxErrorM);
  CHECK(levels[0].tiles == 8);
}

TEST_CASE("Killed at any time, what is there is sound, and resuming gives what an uninterrupted bake gives") {
  TestFolder folder;
  mustComplete(smallJob(folder, "whole.eyt"));
  const auto whole = contentOf(folder.file("whole.eyt"));
  const BakeJob job = smallJob(folder, "killed.eyt");
  int kills = 0;
  for (const int afterTiles : {30, 60, 90}) {
    const pid_t child = ::fork();
    if (child == 0) {
      BakeJob mine = job;
      mine.resume = true;
      BakeControl control = withJobs(1);
      control.progress = [&](const BakeProgress& progress) {
        if (progress.baked > static_cast<uint64_t>(afterTiles)) ::kill(::getpid(), SIGKILL);
      };
      (void)runBake(mine, control);
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    kills += WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
    const auto reader = DatabaseReader::open(job.out);
    // Killed before the first roots are in, there is nothing to fly yet.
    if (reader) CHECK(!reader->info().complete);
  }
  CHECK(kills > 0);
  BakeJob rest = job;
  rest.resume = true;
  mustComplete(rest);
  CHECK((whole == contentOf(job.out)));
}

TEST_CASE("Asked to stop, a bake finishes its batch and can go on") {
  TestFolder folder;
  mustComplete(smallJob(folder, "whole.eyt"));
  BakeJob job = smallJob(folder, "stopped.eyt");
  std::atomic<bool> stop{false};
  BakeControl control = withJobs(2);
  control.stop = &stop;
  control.progress = [&](const BakeProgress& progress) { stop = progress.baked > 40; };
  const auto outcome = runBake(job, control);
  REQUIRE(outcome);
  CHECK(*outcome == BakeOutcome::interrupted);
  contentOf(job.out);  // sound
  job.resume = true;
  mustComplete(job);
  CHECK((contentOf(job.out) == contentOf(folder.file("whole.eyt"))));
}

TEST_CASE("Resuming with other settings is refused, and so is overwriting") {
  TestFolder folder;
  BakeJob job = smallJob(folder, "a.eyt");
  mustComplete(job);
  CHECK(runBake(job, withJobs(1)).error().kind == ErrorKind::usage);
  job.resume = true;
  job.plan.errorM = 5;
  CHECK(runBake(job, withJobs(1)).error().kind == ErrorKind::usage);
}

TEST_CASE("A region refines only what meets it") {
  TestFolder folder;
  BakeJob job = smallJob(folder, "region.eyt");
  job.plan.region = TileBounds{49.0, 49.05, 20.0, 20.05};
  mustComplete(job);
  contentOf(job.out);
  const auto reader = DatabaseReader::open(job.out).value();
  const int finest = reader.info().maxLevel;
  CHECK(reader.readMeta(TileKey::containing(49.02, 20.02, finest)));
  CHECK(!reader.readMeta(TileKey::containing(49.18, 20.18, finest)));
}

TEST_CASE("A full disk is one clear error, and the database stays sound") {
  TestFolder folder;
  const std::string disk = folder.file("disk");
  std::filesystem::create_directory(disk);
  if (::mount("none", disk.c_str(), "tmpfs", 0, "size=300k") != 0) {
    WARN("no right to mount a small disk: not tested");
    return;
  }
  {
    BakeJob job = smallJob(folder, "unused.eyt");
    job.out = disk + "/full.eyt";
    const auto outcome = runBake(job, withJobs(2));
    REQUIRE(!outcome);
    CHECK(outcome.error().kind == ErrorKind::noSpace);
    CHECK(outcome.error().message.find('\n') == std::string::npos);
    const auto reader = DatabaseReader::open(job.out);
    if (reader) CHECK(reader->verify([](uint64_t, uint64_t) {}));
  }
  ::umount(disk.c_str());
}

TEST_CASE("The demo's ground has its runway level, its mountains high, and always the same") {
  CHECK(demoHeightM(kDemoRunwayLatDeg, kDemoRunwayLonDeg, 100) == kDemoRunwayElevationM);
  const double halfLonDeg = kDemoRunwayLengthM / 2 / (111195 * std::cos(kDemoRunwayLatDeg * 0.017453292519943295));
  for (const double side : {-1.0, 1.0}) {
    CHECK(demoHeightM(kDemoRunwayLatDeg + 0.004 * side, kDemoRunwayLonDeg + 1.2 * halfLonDeg * side, 100) ==
          kDemoRunwayElevationM);
  }
  double highest = 0, lowest = 9999;
  for (double lat = kDemoSouthDeg; lat <= kDemoNorthDeg; lat += 0.01) {
    for (double lon = kDemoWestDeg; lon <= kDemoEastDeg; lon += 0.01) {
      const double height = demoHeightM(lat, lon, 200);
      highest = std::max(highest, height);
      lowest = std::min(lowest, height);
    }
  }
  CHECK(lowest == 0);
  CHECK(highest > 0.6 * kDemoHighestTerrainM);
  CHECK(highest < 1.2 * kDemoHighestTerrainM);
}

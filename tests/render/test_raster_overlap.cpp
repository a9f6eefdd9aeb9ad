// Where a pass is cut for a device that bins before it rasterises, and how its threads share the cores. No device
// needed.
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <thread>

#include "gpu/time_slices.h"
#include "render/raster_overlap.h"

using namespace eye;

namespace {

std::vector<shader::DrawCommand> drawsOf(const std::vector<uint32_t>& indexCounts) {
  std::vector<shader::DrawCommand> draws;
  for (const uint32_t count : indexCounts) draws.push_back({count, 1, 0, 0, 0});
  return draws;
}

std::vector<uint32_t> drawsBegunAnew(const std::vector<uint32_t>& indexCounts) {
  return handOversOf(drawsOf(indexCounts));
}

// Nanoseconds; 0 where the system tells of no slices.
uint64_t sliceOfThisThreadNs() {
  std::array<unsigned char, 56> attributes{};  // sched_setattr(2): the runtime is 24 bytes in
  if (syscall(SYS_sched_getattr, 0L, attributes.data(), attributes.size(), 0L) != 0) return 0;
  uint64_t runtimeNs = 0;
  std::memcpy(&runtimeNs, attributes.data() + 24, sizeof runtimeNs);
  return runtimeNs;
}

}  // namespace

TEST_CASE("a pass is handed over where a quarter, half and three quarters of its indices are binned") {
  CHECK(drawsBegunAnew({30, 30, 30, 30, 30, 30, 30, 30}) == std::vector<uint32_t>{2, 4, 6});
  CHECK(drawsBegunAnew({90, 30, 0, 0, 30, 60}) == std::vector<uint32_t>{1, 2});  // what is not drawn counts for nothing
  CHECK(drawsBegunAnew({0, 0, 30, 30, 30, 30}) == std::vector<uint32_t>{3, 4, 5});
}

TEST_CASE("nothing is handed over before anything is binned, nor after the last draw") {
  CHECK(drawsBegunAnew({}).empty());
  CHECK(drawsBegunAnew({300}).empty());
  CHECK(drawsBegunAnew({0, 0, 0}).empty());
  CHECK(drawsBegunAnew({0, 300, 0}) == std::vector<uint32_t>{2});  // one for three shares at once
}

TEST_CASE("threads that are started later have the slices that were asked for, and others do not") {
  const uint64_t mainNs = sliceOfThisThreadNs();
  uint64_t beforeNs = 0, ownNs = 0, childNs = 0, againNs = 0;
  std::thread([&] {
    askForSlices({});  // a renderer of another test has asked for the main thread
    beforeNs = sliceOfThisThreadNs();
    askForSlices(std::chrono::microseconds(150));
    ownNs = sliceOfThisThreadNs();
    std::thread([&] { childNs = sliceOfThisThreadNs(); }).join();
    askForSlices({});
    againNs = sliceOfThisThreadNs();
  }).join();
  if (beforeNs == 0) {
    WARN("this system tells of no slices: Linux does from 6.12 on");
    return;
  }
  CHECK(ownNs == 150'000);
  CHECK(childNs == 150'000);
  CHECK(againNs == beforeNs);
  CHECK(sliceOfThisThreadNs() == mainNs);
}

TEST_CASE("patient threads are of the batch policy, and the one that starts them is not for long") {
  const auto policy = [] { return sched_getscheduler(0); };
  int own = -1, during = -1, child = -1, after = -1, childAfter = -1;
  std::thread([&] {
    own = policy();
    {
      const PatientThreads patient;
      during = policy();
      std::thread([&] { child = policy(); }).join();
    }
    after = policy();
    std::thread([&] { childAfter = policy(); }).join();
  }).join();
  if (own != SCHED_OTHER) {
    WARN("the tests run under a scheduling policy of their own");
    return;
  }
  CHECK(during == SCHED_BATCH);
  CHECK(child == SCHED_BATCH);
  CHECK(after == SCHED_OTHER);
  CHECK(childAfter == SCHED_OTHER);
}

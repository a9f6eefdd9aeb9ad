#include "paging/pager.h"

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <sqlite3.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <thread>

#include "paging/fake_store.h"
#include "paging/synthetic_forest.h"

namespace eye {
namespace {

constexpr uint64_t kPlenty = uint64_t{1} << 30;
constexpr double kLatDeg = 50, kLonDeg = 20;

const ForestFile& sharedForest() {
  static const ForestFile forest(around(kLatDeg, kLonDeg, 3, 9));
  return forest;
}

View viewAt(double latDeg, double lonDeg, double altM, double headingDeg = 180, double pitchDeg = -20) {
  return makeView({{latDeg, lonDeg, altM}, headingDeg, pitchDeg, 0}, symmetricFrustum(70, 800, 600, 1), 800, 600);
}

std::unique_ptr<Pager> open(FakeStore& gpu, const PagerOptions& options) {
  Result<std::unique_ptr<Pager>> pager = Pager::create(sharedForest().path(), gpu, options);
  INFO((pager ? std::string() : pager.error().message));
  REQUIRE(pager.has_value());
  return std::move(*pager);
}

void select(Pager& pager, const View& view, Selection& selection, CullingScheme culling = CullingScheme::frustum) {
  pager.cache().beginFrame();
  selectChunks(pager.cache(), view, {.ssePx = 2, .coarsening = pager.coarsening(), .culling = culling}, selection);
}

std::set<TileKey> drawnKeys(Pager& pager, const Selection& selection) {
  std::set<TileKey> keys;
  for (const DrawnChunk& draw : selection.draws) keys.insert(pager.cache().node(draw.node).meta.key);
  return keys;
}

// Waits out of wait mode: frames until nothing is missing or `frames` are over.
int settle(Pager& pager, const View& view, Selection& selection, int frames) {
  for (int frame = 0; frame < frames; ++frame) {
    select(pager, view, selection);
    pager.exchange(selection);
    if (selection.counts.missing == 0) return frame;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return frames;
}

// A child is a third or a quarter of its parent: without a hole and without an overlap the parts make eight roots.
bool coversGlobe(Pager& pager, const Selection& selection) {
  double sum = 0;
  for (const DrawnChunk& draw : selection.draws) {
    double part = 1;
    for (std::optional<TileKey> parent = pager.cache().node(draw.node).meta.key.parent(); parent;
         parent = parent->parent())
      part /= parent->children().count;
    sum += part;
  }
  return std::abs(sum - 8) < 1e-6;
}

// Catches what is logged while it lives.
class LogCatcher {
 public:
  LogCatcher() : before_(spdlog::default_logger()) {
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text_)));
  }
  ~LogCatcher() { spdlog::set_default_logger(before_); }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::shared_ptr<spdlog::logger> before_;
};

}  // namespace

TEST_CASE("the roots are there at once, and everything is given back at the end") {
  FakeStore gpu(kPlenty);
  {
    const auto pager = open(gpu, {});
    CHECK(pager->counts().resident == 8);
    CHECK(gpu.live() == 8);
    Selection selection;
    CHECK(settle(*pager, viewAt(kLatDeg, kLonDeg, 3000), selection, 5000) < 5000);
    CHECK(pager->counts().loaded + 8 == pager->counts().resident);
    CHECK(gpu.live() == pager->counts().resident);
    CHECK(pager->counts().bytesRead > 10000);
  }
  CHECK(gpu.live() == 0);
}

TEST_CASE("a budget without room for the roots, and a file that is not there, are errors that say what to do") {
  FakeStore gpu(20000);
  const auto tight = Pager::create(sharedForest().path(), gpu, {});
  REQUIRE_FALSE(tight.has_value());
  CHECK(tight.error().message.find("--cache-gpu") != std::string::npos);
  CHECK(gpu.live() == 0);
  CHECK_FALSE(Pager::create("/nowhere/terrain.eyt", gpu, {}).has_value());
}

TEST_CASE("waiting settles on the same terrain as frames in real time, every time the same") {
  const View view = viewAt(kLatDeg, kLonDeg, 2000);
  std::vector<std::set<TileKey>> drawn;
  for (int run = 0; run < 3; ++run) {
    FakeStore gpu(kPlenty);
    const auto pager = open(gpu, {.wait = run > 0});
    Selection selection;
    if (run == 0) {
      REQUIRE(settle(*pager, view, selection, 5000) < 5000);
    } else {
      int rounds = 0;
      do select(*pager, view, selection);
      while (pager->exchange(selection) > 0 && ++rounds < 50);
      CHECK(rounds < 12);  // a level at a time
    }
    CHECK(selection.counts.missing == 0);
    drawn.push_back(drawnKeys(*pager, selection));
  }
  CHECK(drawn[0].size() > 25);
  CHECK(drawn[0] == drawn[1]);
  CHECK(drawn[1] == drawn[2]);
}

TEST_CASE("waiting with too little GPU memory ends, and ends the same every time") {
  const View view = viewAt(kLatDeg, kLonDeg, 2000);
  std::vector<std::set<TileKey>> drawn;
  for (int run = 0; run < 2; ++run) {
    FakeStore gpu(150'000);
    const auto pager = open(gpu, {.ramBudgetBytes = run == 0 ? kPlenty : uint64_t{40'000}, .wait = true});
    Selection selection;
    int rounds = 0;
    do select(*pager, view, selection);
    while (pager->exchange(selection) > 0 && ++rounds < 50);
    CHECK(rounds < 50);
    CHECK(selection.counts.missing > 0);
    drawn.push_back(drawnKeys(*pager, selection));
  }
  CHECK(drawn[0] == drawn[1]);
}

TEST_CASE("budgets hold and no hole opens over a random flight") {
  struct Budget {
    uint64_t ram, gpu;
  };
  const std::vector<Budget> budgets{{kPlenty, kPlenty}, {100'000, 150'000}, {60'000, 2'000'000},
                                    {1, kPlenty},       {kPlenty, 70'000},  {1'000'000, 300'000}};
  for (const Budget& budget : budgets) {
    INFO("RAM " << budget.ram << ", GPU " << budget.gpu);
    FakeStore gpu(budget.gpu);
    const auto pager = open(gpu, {.ramBudgetBytes = budget.ram, .uploadBytesPerFrame = 200'000});
    std::mt19937 random(7);
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
    Selection selection;
    double latDeg = kLatDeg, lonDeg = kLonDeg, headingDeg = 0, altM = 3000;
    for (int frame = 0; frame < 2000; ++frame) {
      if (frame % 400 == 399) latDeg = uniform(-89, 89), lonDeg = uniform(-170, 170);
      if (frame % 400 == 200) latDeg = kLatDeg, lonDeg = kLonDeg;
      headingDeg += uniform(-5, 5);
      altM = std::clamp(altM * uniform(0.97, 1.03), 1700.0, 1e6);
      latDeg = std::clamp(latDeg + 0.02 * std::cos(radFromDeg(headingDeg)), -89.0, 89.0);
      lonDeg += 0.02 * std::sin(radFromDeg(headingDeg));
      const bool checksHoles = frame % 5 == 0;
      select(*pager, viewAt(latDeg, lonDeg, altM, headingDeg), selection,
             checksHoles ? CullingScheme::none : CullingScheme::frustum);
      std::vector<uint64_t> drawnHandles;
      for (const DrawnChunk& draw : selection.draws)
        drawnHandles.push_back(pager->cache().node(draw.node).meta.key.code());
      pager->exchange(selection);
      if (checksHoles) REQUIRE(coversGlobe(*pager, selection));
      for (size_t i = 0; i < drawnHandles.size(); ++i)  // what is about to be drawn stays where it is
        REQUIRE(pager->cache().node(selection.draws[i].node).meta.key.code() == drawnHandles[i]);
      const PagingCounts counts = pager->counts();
      REQUIRE(counts.ramBytes <= budget.ram);
      REQUIRE(counts.gpuBytes <= budget.gpu);
      REQUIRE(counts.resident == gpu.live());
      REQUIRE(counts.resident == 8 + counts.loaded - counts.evicted);
      if (frame % 20 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(pager->counts().damaged == 0);
    if (budget.ram > 10'000) CHECK(pager->counts().loaded > 2);
    if (budget.ram == 1) CHECK(pager->counts().loaded == 0);
    if (budget.gpu == kPlenty) CHECK(pager->counts().evicted == 0);
  }
}

TEST_CASE("a still eye comes to rest: nothing more is read, uploaded or evicted") {
  for (uint64_t gpuBudget : {kPlenty, uint64_t{150'000}}) {
    FakeStore gpu(gpuBudget);
    const auto pager = open(gpu, {.ramBudgetBytes = 2'000'000});
    Selection selection;
    for (const View& view : {viewAt(kLatDeg, kLonDeg, 4000), viewAt(kLatDeg, kLonDeg, 2500, 0)}) {
      settle(*pager, view, selection, 300);
      const PagingCounts before = pager->counts();
      const uint64_t uploads = gpu.uploads;
      settle(*pager, view, selection, 100);
      for (int i = 0; i < 20; ++i) {
        select(*pager, view, selection);
        CHECK(pager->exchange(selection) == 0);
      }
      CHECK(pager->counts().bytesRead == before.bytesRead);
      CHECK(pager->counts().loaded == before.loaded);
      CHECK(pager->counts().evicted == before.evicted);
      CHECK(pager->counts().requested == before.requested);
      CHECK(gpu.uploads == uploads);
      CHECK((selection.counts.missing == 0) == (gpuBudget == kPlenty));
      CHECK((pager->coarsening() == 1) == (gpuBudget == kPlenty));
    }
    CHECK(pager->counts().gpuBytes > 100'000);
  }
}

TEST_CASE("what was evicted returns from RAM") {
  const View here = viewAt(kLatDeg, kLonDeg, 20000), there = viewAt(-kLatDeg, kLonDeg - 180, 20000);
  Selection selection;
  uint64_t neededBytes = 0;
  for (const View& view : {here, there}) {
    FakeStore roomy(kPlenty);
    const auto pager = open(roomy, {});
    REQUIRE(settle(*pager, view, selection, 3000) < 3000);
    neededBytes = std::max(neededBytes, roomy.bytesResident());
  }
  FakeStore gpu(neededBytes + 5'000);
  const auto pager = open(gpu, {.ramBudgetBytes = kPlenty});
  REQUIRE(settle(*pager, here, selection, 3000) < 3000);
  REQUIRE(settle(*pager, there, selection, 3000) < 3000);
  REQUIRE(pager->counts().evicted > 0);
  const uint64_t loaded = pager->counts().loaded, bytesRead = pager->counts().bytesRead;
  REQUIRE(settle(*pager, here, selection, 3000) < 3000);
  CHECK(pager->counts().loaded > loaded);
  // On its way it may pass through another mixture of levels than the first time, and want a group that it did not
  // then.
  CHECK(pager->counts().bytesRead - bytesRead < bytesRead / 5);
}

TEST_CASE("a damaged chunk keeps its parent drawn, is reported once and not read again") {
  const ForestFile forest(around(kLatDeg, kLonDeg, 2, 6));
  const TileKey damaged = TileKey::containing(kLatDeg, kLonDeg, 4);
  forest.damage(damaged);
  const LogCatcher log;
  for (bool wait : {false, true}) {
    FakeStore gpu(kPlenty);
    Result<std::unique_ptr<Pager>> pager = Pager::create(forest.path(), gpu, {.wait = wait});
    REQUIRE(pager.has_value());
    Selection selection;
    const View view = viewAt(kLatDeg, kLonDeg, 3000, 180, -60);
    if (!wait) {
      settle(**pager, view, selection, 300);
    } else {
      do select(**pager, view, selection);
      while ((*pager)->exchange(selection) > 0);
    }
    CHECK(drawnKeys(**pager, selection).contains(*damaged.parent()));
    CHECK((*pager)->counts().damaged == 1);
    const uint64_t bytesRead = (*pager)->counts().bytesRead;
    for (int i = 0; i < 20; ++i) {
      select(**pager, view, selection);
      CHECK((*pager)->exchange(selection) == 0);
    }
    CHECK((*pager)->counts().bytesRead == bytesRead);
  }
  const std::string text = log.text();
  CHECK(std::ranges::count(text, '\n') == 2);  // one a pager
  CHECK(text.find(damaged.name()) != std::string::npos);
}

TEST_CASE("what cannot be read for a while comes when it can, and is spoken of once") {
  const ForestFile forest(around(kLatDeg, kLonDeg, 1, 4));
  const LogCatcher log;
  FakeStore gpu(kPlenty);
  Result<std::unique_ptr<Pager>> pager = Pager::create(forest.path(), gpu, {});
  REQUIRE(pager.has_value());
  sqlite3* other = nullptr;
  REQUIRE(sqlite3_open(forest.path().c_str(), &other) == SQLITE_OK);
  REQUIRE(sqlite3_exec(other, "BEGIN EXCLUSIVE", nullptr, nullptr, nullptr) == SQLITE_OK);
  Selection selection;
  const View view = viewAt(kLatDeg, kLonDeg, 30000);
  // A reader waits for a lock for five seconds before it gives up.
  for (int i = 0; i < 100 && log.text().empty(); ++i) {
    CHECK(settle(**pager, view, selection, 100) == 100);
  }
  CHECK(log.text().find("in use by another program") != std::string::npos);
  sqlite3_close(other);
  CHECK(settle(**pager, view, selection, 10'000) < 10'000);
  CHECK((*pager)->counts().damaged == 0);
  const std::string text = log.text();
  CHECK(std::ranges::count(text, '\n') == 1);
}

TEST_CASE("a pager that is at work can be destroyed at any moment") {
  for (int run = 0; run < 30; ++run) {
    FakeStore gpu(kPlenty);
    const uint64_t ram = run % 3 == 0 ? uint64_t{30'000} : kPlenty;  // also while a group waits for room
    const auto pager = open(gpu, {.ramBudgetBytes = ram});
    Selection selection;
    for (int frame = 0; frame < run % 5 + 1; ++frame) {
      select(*pager, viewAt(kLatDeg, kLonDeg, 3000), selection);
      pager->exchange(selection);
      std::this_thread::sleep_for(std::chrono::microseconds(300 * (run % 4)));
    }
  }
}

}  // namespace eye

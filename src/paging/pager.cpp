#include "paging/pager.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "paging/coarsening.h"
#include "paging/pace_meter.h"
#include "paging/paging_thread.h"
#include "paging/ram_cache.h"
#include "paging/residency.h"
#include "telemetry/trace.h"

namespace eye {
namespace {

// A group must have been out of every walk for so long before it makes room for another, so that an eye that sways does
// not load and evict in turns; at low rates for some frames at least. When waiting, frames are steps of one and the
// same view: none is needed.
constexpr double kIdleS = 0.13;
constexpr double kFewestIdleFrames = 3;
// Without a look-ahead nobody says how fast frames come.
constexpr double kUsualRateHz = 60;
// A read that failed may succeed later (a network drive, a file that is being replaced); damage stays.
constexpr int64_t kRetryNs = 2'000'000'000, kNever = std::numeric_limits<int64_t>::max();
// Of the RAM budget, kept free for results that are on their way; a group that needs more gets it when it is known.
constexpr uint64_t kRoomShare = 4;
// What is ahead by no more than this goes to the GPU at once.
constexpr double kSoonS = 1;
// When a group is needed that is seen and missed: before anything that is not seen, however soon that may be.
constexpr double kSeen = -std::numeric_limits<double>::infinity();

}  // namespace

struct Pager::Impl {
  Impl(DatabaseReader reader, GpuStore& gpu, const PagerOptions& pagerOptions)
      : options(pagerOptions),
        info(reader.info()),
        // What was evicted is, if it is still there, the only copy now.
        residency(gpu, [this](const TileKey& parent) { ram.use(parent); }),
        thread(std::move(reader), options.ramBudgetBytes) {}

  // Groups that are not resident, most urgent first: what the selection misses, behind it what the schedule has ahead.
  void listWanted(const Selection& selection);
  void listAhead();
  bool isOpen(const TileKey& parent) const;
  bool isLost(const TileKey& parent) const;
  void lose(const TileKey& parent, const Error& error);
  void takeResults();
  void trimRam();
  // What is wanted and not in RAM, from `begin` on; nothing while the GPU has no room for what is there already.
  void sendRequests(size_t begin);
  bool isBudgetSpent() const;  // this frame's, for uploads
  int takeInWithinBudget();
  int takeInAhead();
  int takeInAll();

  struct Wanted {
    TileKey parent;
    double neededAtS;  // on the look-ahead's clock
    bool inMemory;     // is to go to the GPU, not only to be decoded
  };

  const PagerOptions options;
  const DatabaseInfo info;
  RamCache ram;
  Residency residency;
  Schedule schedule;
  PaceMeter pace;
  Coarsening coarsening;
  PagingCounts counts;
  // Parents whose children could not be had, and when to try again: kNever if damaged, or too big for the RAM budget.
  std::unordered_map<TileKey, int64_t> lostUntilNs;
  bool isGpuFull = false;  // an upload failed, and nothing could be evicted for it
  uint32_t fullPlan = 0;   // the plan whose look-ahead found no room
  double fullFromS = 0;    // for what is needed then or later
  uint64_t blockedBytes = 0;
  double nowS = 0;
  int64_t beganNs = 0;         // of this exchange's uploads
  uint64_t uploadedBytes = 0;  // in this exchange

  // Kept from frame to frame so that they do not allocate.
  std::vector<Wanted> wanted;
  size_t missing = 0;  // the first of `wanted`: what the selection misses
  std::vector<TileKey> requests;
  std::vector<TileKey> asked;  // the last request list, sorted, to count what is new in it
  std::vector<LoadResult> results;

  PagingThread thread;  // last: it is joined before anything else goes
};

bool Pager::Impl::isOpen(const TileKey& parent) const {
  const std::optional<uint32_t> node = residency.cache().find(parent);
  return node && residency.cache().children(*node).empty() && !isLost(parent);
}

bool Pager::Impl::isLost(const TileKey& parent) const {
  const auto found = lostUntilNs.find(parent);
  return found != lostUntilNs.end() && monotonicNs() < found->second;
}

// Said once a group.
void Pager::Impl::lose(const TileKey& parent, const Error& error) {
  const bool mayReturn = error.kind == ErrorKind::io;
  const bool isNew = lostUntilNs.insert_or_assign(parent, mayReturn ? monotonicNs() + kRetryNs : kNever).second;
  if (!isNew) return;
  if (!mayReturn && error.kind != ErrorKind::noSpace) ++counts.damaged;
  spdlog::warn("Terrain stays coarse{}: {}", mayReturn ? " until it can be read" : "", error.message);
}

void Pager::Impl::listWanted(const Selection& selection) {
  wanted.clear();
  for (const WantedChunk& chunk : selection.wanted) {
    const std::optional<TileKey> parent = chunk.key.parent();
    if (parent && (wanted.empty() || wanted.back().parent != *parent) && isOpen(*parent))
      wanted.push_back({*parent, kSeen, true});
  }
  missing = wanted.size();
}

void Pager::Impl::listAhead() {
  for (const GroupAhead& group : schedule.wanted()) {
    // What is missed is a few groups at most, once terrain has come in.
    const auto isIt = [&](const Wanted& missed) { return missed.parent == group.parent; };
    if (isOpen(group.parent) && std::none_of(wanted.begin(), wanted.begin() + std::ptrdiff_t(missing), isIt))
      wanted.push_back({group.parent, schedule.plannedAtS() + group.neededInS, schedule.isInMemoryArea(group)});
  }
}

void Pager::Impl::takeResults() {
  results.clear();
  const PagingThread::Taken taken = thread.take(results);
  blockedBytes = taken.blockedBytes;
  counts.bytesRead = taken.bytesRead;
  for (LoadResult& result : results) {
    if (result.group) {
      pace.loaded(result.cost);
      // A parent that went while its children were on their way does not want them any more.
      if (residency.cache().find(result.parent)) ram.insert(std::move(*result.group));
      continue;
    }
    lose(result.parent, result.group.error());
  }
  results.clear();
}

void Pager::Impl::trimRam() {
  const uint64_t room = std::min(options.ramBudgetBytes, std::max(options.ramBudgetBytes / kRoomShare, blockedBytes));
  ram.trim(options.ramBudgetBytes - room);
}

void Pager::Impl::sendRequests(size_t begin) {
  requests.clear();
  uint64_t waitingBytes = 0;
  // What is decoded and waits for its upload takes RAM: beyond half of the budget more would only push out the first.
  for (size_t i = begin; i < wanted.size() && !isGpuFull && waitingBytes <= options.ramBudgetBytes / 2; ++i) {
    const TileKey& parent = wanted[i].parent;
    if (isLost(parent)) continue;
    const ChunkGroup* group = ram.use(parent);
    if (group != nullptr) {
      waitingBytes += group->bytes();
    } else {
      requests.push_back(parent);
    }
  }
  uint64_t newGroups = 0;
  for (const TileKey& parent : requests) {
    if (std::ranges::binary_search(asked, parent.code(), {}, &TileKey::code)) continue;
    ++newGroups;
    counts.requested += static_cast<uint64_t>(parent.children().count);
  }
  pace.asked(newGroups, nowS);
  if (!isGpuFull) {
    asked = requests;
    std::ranges::sort(asked, {}, &TileKey::code);
  }
  trimRam();
  thread.request(requests, options.ramBudgetBytes - ram.bytes());
}

bool Pager::Impl::isBudgetSpent() const {
  const double ms = static_cast<double>(monotonicNs() - beganNs) * 1e-6;
  return uploadedBytes >= options.uploadBytesPerFrame || ms >= options.uploadMsPerFrame;
}

// Of what is missed: at least one group, then while the budget lasts.
int Pager::Impl::takeInWithinBudget() {
  const TraceScope trace("upload");
  int taken = 0;
  for (size_t i = 0; i < missing; ++i) {
    if (!isOpen(wanted[i].parent)) continue;
    const ChunkGroup* group = ram.use(wanted[i].parent);
    if (group == nullptr) continue;
    isGpuFull = !residency.takeIn(*group, wanted[i].neededAtS);
    if (isGpuFull) break;
    taken += static_cast<int>(group->chunks.size());
    uploadedBytes += group->bytes();
    if (isBudgetSpent()) break;
  }
  return taken;
}

// Of what is ahead, with what is left of the budget: the interval's groups spread over its frames, but at once what is
// needed within a second.
int Pager::Impl::takeInAhead() {
  const TraceScope trace("upload ahead");
  const int due = schedule.uploadsDue();
  int taken = 0, groups = 0;
  for (size_t i = missing; i < wanted.size() && !isBudgetSpent(); ++i) {
    if (fullPlan == schedule.plan() && wanted[i].neededAtS >= fullFromS) break;
    if (!wanted[i].inMemory || !isOpen(wanted[i].parent)) continue;
    if (groups >= due && wanted[i].neededAtS > nowS + kSoonS) break;
    const ChunkGroup* group = ram.use(wanted[i].parent);
    if (group == nullptr) continue;
    if (!residency.takeIn(*group, wanted[i].neededAtS)) {
      fullPlan = schedule.plan();
      fullFromS = wanted[i].neededAtS;
      break;
    }
    taken += static_cast<int>(group->chunks.size());
    uploadedBytes += group->bytes();
    ++groups;
  }
  schedule.uploaded(groups);
  return taken;
}

// All of the list in its order, so that what becomes resident does not depend on time.
int Pager::Impl::takeInAll() {
  const TraceScope trace("wait for terrain");
  int taken = 0;
  for (size_t i = 0; i < wanted.size(); ++i) {
    const TileKey& parent = wanted[i].parent;
    while (!isLost(parent) && ram.use(parent) == nullptr) {
      sendRequests(i);
      thread.waitForResult();
      takeResults();
    }
    if (isLost(parent)) continue;
    const ChunkGroup* group = ram.use(parent);
    isGpuFull = !residency.takeIn(*group, kSeen);
    if (isGpuFull) break;
    taken += static_cast<int>(group->chunks.size());
  }
  return taken;
}

Pager::Pager(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Pager::~Pager() = default;
TerrainCache& Pager::cache() {
  return impl_->residency.cache();
}
const DatabaseInfo& Pager::info() const {
  return impl_->info;
}

Result<std::unique_ptr<Pager>> Pager::create(const std::string& databasePath, GpuStore& gpu,
                                             const PagerOptions& options) {
  const TraceScope trace("load roots");
  Result<DatabaseReader> reader = DatabaseReader::open(databasePath);
  if (!reader) return tl::unexpected(reader.error());
  std::vector<ResidentChunk> roots;
  const auto giveUp = [&](Error error) {
    for (const ResidentChunk& root : roots) gpu.release(root.gpu);
    return tl::unexpected(std::move(error));
  };
  for (int octant = 0; octant < kOctants; ++octant) {
    const TileKey key = TileKey::octantRoot(octant);
    const Result<LoadedChunk> chunk = loadChunk(*reader, key);
    if (!chunk) return giveUp(chunk.error());
    if (!chunk->meta.hasImagery)
      return giveUp(
          {ErrorKind::badData, fmt::format("{}: {} has no imagery; bake it again", databasePath, key.name())});
    const std::optional<GpuChunk> place = gpu.upload(*chunk);
    if (!place)
      return giveUp({ErrorKind::usage, fmt::format("the GPU budget has no room for the eight roots of {}; raise "
                                                   "--cache-gpu",
                                                   databasePath)});
    roots.push_back(residentFrom(*chunk, *place));
  }
  auto impl = std::make_unique<Impl>(std::move(*reader), gpu, options);
  impl->residency.cache().insertRoots(roots);
  return std::unique_ptr<Pager>(new Pager(std::move(impl)));
}

int Pager::exchange(const Selection& selection, const LookAhead* ahead) {
  const TraceScope trace("exchange");
  Impl& pager = *impl_;
  const TerrainCache& cache = pager.residency.cache();
  const bool looksAhead = ahead != nullptr && !pager.options.wait;
  const double rateHz = looksAhead ? ahead->frameRateHz : kUsualRateHz;
  const double stepS = looksAhead ? std::max(ahead->nowS - pager.nowS, 0.0) : 1 / kUsualRateHz;
  if (looksAhead) pager.nowS = ahead->nowS;

  pager.takeResults();
  if (looksAhead) {
    const uint64_t ramUsed = std::min(pager.options.ramBudgetBytes, pager.ram.bytes());
    pager.schedule.update(pager.residency.cache(), *ahead, pager.coarsening.factor(), pager.pace.rates(),
                          pager.options.ramBudgetBytes - ramUsed);
  }
  const auto idleFrames =
      pager.options.wait ? 0 : static_cast<uint64_t>(std::max(std::ceil(kIdleS * rateHz), kFewestIdleFrames));
  pager.residency.begin({cache.frame() - std::min(cache.frame(), idleFrames), pager.schedule.plan(),
                         looksAhead ? pager.schedule.interval().lengthS * rateHz : kIdleS * rateHz});
  pager.listWanted(selection);
  // What did not fit waits, and nothing is read, until something else has fallen out of use.
  if (pager.isGpuFull && pager.missing > 0) pager.isGpuFull = !pager.residency.canEvict(kSeen);
  if (pager.missing == 0) pager.isGpuFull = false;
  pager.beganNs = monotonicNs();
  pager.uploadedBytes = 0;
  int taken = 0;
  if (!pager.isGpuFull) taken = pager.options.wait ? pager.takeInAll() : pager.takeInWithinBudget();
  if (looksAhead) {
    pager.listAhead();
    if (!pager.isGpuFull) taken += pager.takeInAhead();
  }
  std::erase_if(pager.wanted, [&](const Impl::Wanted& group) { return !pager.isOpen(group.parent); });
  pager.sendRequests(0);
  constexpr double kMovingMS = 1;
  const bool isMoving = ahead != nullptr && ahead->speedMS > kMovingMS;
  if (!pager.options.wait) pager.coarsening.steer(stepS, pager.isGpuFull, isMoving, pager.residency);
  return taken;
}

double Pager::coarsening() const {
  return impl_->coarsening.factor();
}

double Pager::threadCpuMs() const {
  return impl_->thread.cpuMs();
}

PagingCounts Pager::counts() const {
  PagingCounts counts = impl_->counts;
  const Residency::Counts& residency = impl_->residency.counts();
  counts.loaded = residency.loaded;
  counts.evicted = residency.evicted;
  counts.refused = residency.refused;
  counts.resident = impl_->residency.cache().size();
  counts.cached = impl_->ram.chunksBeside(impl_->residency.cache());
  counts.ramBytes = impl_->ram.bytes() + impl_->thread.resultBytes();
  counts.gpuBytes = impl_->residency.gpu().bytesResident();
  return counts;
}

PagingPace Pager::pace() const {
  const Schedule& schedule = impl_->schedule;
  if (schedule.plan() == 0) return {};
  Interval interval = schedule.interval();
  interval.keepsUp = interval.keepsUp && !impl_->isGpuFull && impl_->coarsening.factor() == 1;
  return {interval, schedule.memoryS(), schedule.cacheS(), impl_->pace.rates()};
}

}  // namespace eye

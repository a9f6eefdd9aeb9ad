#include "link/ground_desk.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "telemetry/trace.h"

namespace eye::cigi {
namespace {

// As many as answers may wait for a frame (cigi_replies.h): some four thousand.
constexpr size_t kMaxWaiting = kMaxAnswers;

}  // namespace

GroundDesk::GroundDesk(Replies& replies, OpenProbe openProbe, std::string name)
    : replies_(replies), openProbe_(std::move(openProbe)), name_(std::move(name)) {}

GroundDesk::~GroundDesk() {
  thread_.request_stop();
  wake_.notify_all();
}

void GroundDesk::ask(std::vector<GroundQuestion> questions) {
  if (questions.empty()) return;
  if (!openProbe_) {
    for (const GroundQuestion& question : questions) replies_.answer(answerTo(question, nullptr));
    return;
  }
  size_t dropped = 0;
  {
    const std::lock_guard lock(mutex_);
    for (GroundQuestion& question : questions) {
      if (waiting_.size() < kMaxWaiting)
        waiting_.push_back(std::move(question));
      else
        ++dropped;
    }
  }
  if (dropped > 0 && !std::exchange(saidFull_, true))
    spdlog::warn("{}: {} questions about the ground wait: more than that are dropped until there is room", name_,
                 kMaxWaiting);
  wake_.notify_one();
  if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void GroundDesk::forget() {
  const std::lock_guard lock(mutex_);
  waiting_.clear();
  ++asker_;
  saidFull_ = false;
}

void GroundDesk::run(const std::stop_token& stop) {
  nameThread("ground");
  const auto probe = openProbe_();
  if (!probe) spdlog::warn("{}: questions about the ground have no answer: {}", name_, probe.error().message);
  std::deque<GroundQuestion> taken;
  while (true) {
    uint64_t asker = 0;
    {
      std::unique_lock lock(mutex_);
      // Of a stop it tells only where nothing waits.
      if (!wake_.wait(lock, stop, [this] { return !waiting_.empty(); }) || stop.stop_requested()) return;
      taken.swap(waiting_);
      asker = asker_;
    }
    const TraceScope scope("ground questions");
    for (; !taken.empty() && !stop.stop_requested(); taken.pop_front()) {
      const Packet answer = answerTo(taken.front(), probe ? probe->get() : nullptr);
      const std::lock_guard lock(mutex_);
      if (asker != asker_) break;
      replies_.answer(answer);
    }
    taken.clear();
  }
}

}  // namespace eye::cigi

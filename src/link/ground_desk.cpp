#include "link/ground_desk.h"

#include <spdlog/spdlog.h>

#include "telemetry/trace.h"

namespace eye::cigi {
namespace {

// A second's worth of a host that asks seventeen questions a frame.
constexpr size_t kMaxWaiting = 2 * cigi::kMaxPackets;

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
  {
    const std::lock_guard lock(mutex_);
    for (GroundQuestion& question : questions)
      if (waiting_.size() < kMaxWaiting) waiting_.push_back(std::move(question));
  }
  wake_.notify_one();
  if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void GroundDesk::run(const std::stop_token& stop) {
  nameThread("ground");
  const auto probe = openProbe_();
  if (!probe) spdlog::warn("{}: questions about the ground have no answer: {}", name_, probe.error().message);
  std::deque<GroundQuestion> taken;
  while (true) {
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [this] { return !waiting_.empty(); })) return;
      taken.swap(waiting_);
    }
    const TraceScope scope("ground questions");
    for (; !taken.empty() && !stop.stop_requested(); taken.pop_front())
      replies_.answer(answerTo(taken.front(), probe ? probe->get() : nullptr));
  }
}

}  // namespace eye::cigi

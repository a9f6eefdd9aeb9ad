#include "link/cigi_replies.h"

namespace eye::cigi {
namespace {

// A host that has gone is not written to for ever, nor is who never asked and whose address another has forged.
constexpr int64_t kRepliesEndNs = 5'000'000'000;
constexpr int8_t kNotAvailable = -128;

}  // namespace

void Replies::heard(const Peer& host, const Format& format, const IgControl& control, int64_t nowNs) {
  const std::lock_guard lock(mutex_);
  if (host_ != host) {  // what was another's
    answers_.clear();
    wantedDatabase_ = 0;
    loaded_ = false;
    firstHostFrame_ = control.hostFrame;
  }
  host_ = host;
  heardNs_ = nowNs;
  format_ = format;
  control_ = control;
  // A host asks for a database by its number, and then for 0 or again for the same.
  if (control.mode == IgMode::standby || control.databaseNumber <= 0) return;
  if (control.databaseNumber != wantedDatabase_) loaded_ = false;
  wantedDatabase_ = control.databaseNumber;
}

bool Replies::answer(const Packet& packet) {
  const std::lock_guard lock(mutex_);
  if (answers_.size() == kMaxAnswers) return false;
  answers_.push_back(packet);
  return true;
}

void Replies::forget() {
  const std::lock_guard lock(mutex_);
  host_.reset();
}

bool Replies::speaks(int64_t nowNs) const {
  return host_ && nowNs - heardNs_ <= kRepliesEndNs;
}

int8_t Replies::databaseStatus(const FrameReport& report) {
  if (wantedDatabase_ == 0) return databaseNumber_.value_or(0);
  if (databaseNumber_ && wantedDatabase_ != *databaseNumber_) return kNotAvailable;
  loaded_ = loaded_ || !report.pagingBehind;
  return static_cast<int8_t>(loaded_ ? wantedDatabase_ : -wantedDatabase_);
}

std::optional<Replies::Reply> Replies::frame(const FrameReport& report, std::optional<uint32_t> shownHostFrame,
                                             int64_t nowNs) {
  const std::lock_guard lock(mutex_);
  StartOfFrame start;
  start.igFrame = igFrame_++;
  start.databaseNumber = databaseStatus(report);
  start.mode = control_.mode;
  start.ticks = static_cast<uint32_t>(nowNs / 10'000);
  // What another host's frame shows is nothing to this one.
  const bool isThisHosts = shownHostFrame && *shownHostFrame - firstHostFrame_ <= control_.hostFrame - firstHostFrame_;
  start.hostFrame = isThisHosts ? *shownHostFrame : 0;
  start.overframing = report.overBudget;
  start.paging = report.pagingBehind;
  if (!fixedReceiver_ && !speaks(nowNs)) return std::nullopt;
  // Cut into fragments where a host asks for more than Ethernet carries at once: else a thousand answers, which a host
  // may want each frame, would wait for twenty frames.
  Builder builder(format_, start, kMaxLongMessageBytes);
  while (!answers_.empty() && builder.add(answers_.front())) answers_.pop_front();
  return Reply{fixedReceiver_ ? *fixedReceiver_ : *host_, builder.take()};
}

std::optional<Replies::Reply> Replies::farewell(int64_t nowNs) {
  const std::lock_guard lock(mutex_);
  if (!speaks(nowNs) || control_.mode == IgMode::standby) return std::nullopt;
  StartOfFrame start;
  start.igFrame = igFrame_++;
  start.mode = IgMode::standby;
  start.ticks = static_cast<uint32_t>(nowNs / 10'000);
  start.hostFrame = 0;
  return Reply{fixedReceiver_.value_or(*host_), Builder(format_, start).take()};
}

}  // namespace eye::cigi

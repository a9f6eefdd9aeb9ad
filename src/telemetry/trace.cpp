#include "telemetry/trace.h"

#include <pthread.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace eye {
namespace {

struct Event {
  const char* lane;  // null: the thread that recorded it
  const char* name;
  int64_t beginNs, endNs;
};

constexpr size_t kEventsPerBlock = 8192;
constexpr size_t kBlocks = 256;  // 2 M events, 64 MiB a thread: some hours of a frame loop; then events are dropped

// Written by one thread, read by writeTrace at any time: an event is complete before `count` says that it is there,
// and blocks never move.
struct ThreadBuffer {
  int id = 0;
  std::string name;  // under the registry's mutex
  std::array<std::unique_ptr<std::array<Event, kEventsPerBlock>>, kBlocks> blocks;
  std::atomic<size_t> count{0};
  std::atomic<uint64_t> dropped{0};

  void add(const Event& event) {
    const size_t index = count.load(std::memory_order_relaxed);
    if (index == kEventsPerBlock * kBlocks) {
      dropped.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    auto& block = blocks[index / kEventsPerBlock];
    if (!block) block = std::make_unique<std::array<Event, kEventsPerBlock>>();
    (*block)[index % kEventsPerBlock] = event;
    count.store(index + 1, std::memory_order_release);
  }
};

// Buffers outlive their threads, so that a thread that has ended is still in the trace.
struct Registry {
  std::mutex mutex;
  std::vector<std::unique_ptr<ThreadBuffer>> threads;
};

Registry& registry() {
  static Registry* const instance = new Registry;  // never destroyed: threads may end after main's statics
  return *instance;
}

std::atomic<bool> g_isRecording{false};
std::atomic<int64_t> g_startNs{0};

ThreadBuffer& thisThread() {
  thread_local ThreadBuffer* const buffer = [] {
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    all.threads.push_back(std::make_unique<ThreadBuffer>());
    all.threads.back()->id = static_cast<int>(all.threads.size());
    return all.threads.back().get();
  }();
  return *buffer;
}

std::string jsonEscaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      escaped += {'\\', c};
    } else if (static_cast<unsigned char>(c) < 0x20) {
      escaped += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      escaped += c;
    }
  }
  return escaped;
}

// Writes text piece by piece; remembers the first failure.
class TraceFile {
 public:
  explicit TraceFile(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "wb")) {
    if (!file_) error_ = errno;
  }
  ~TraceFile() {
    if (file_) std::fclose(file_);
  }
  TraceFile(const TraceFile&) = delete;
  TraceFile& operator=(const TraceFile&) = delete;

  void event(std::string_view json) {
    write(isFirst_ ? "\n" : ",\n");
    write(json);
    isFirst_ = false;
  }
  void write(std::string_view text) {
    if (error_ == 0 && std::fwrite(text.data(), 1, text.size(), file_) != text.size()) error_ = errno;
  }
  Result<void> close() {
    if (file_ && std::fclose(file_) != 0 && error_ == 0) error_ = errno;
    file_ = nullptr;
    if (error_ == 0) return {};
    return fail(
        error_ == ENOSPC ? ErrorKind::noSpace : ErrorKind::io,
        fmt::format("cannot write trace {}: {}; give a path that can be written", path_, std::strerror(error_)));
  }

 private:
  std::string path_;
  std::FILE* file_;
  int error_ = 0;
  bool isFirst_ = true;
};

constexpr int kFirstLaneId = 100'000;  // lanes sort below the threads and collide with none

// The number of a lane, which is named in the file when it is first met.
int laneId(std::vector<std::string_view>& lanes, std::string_view lane, TraceFile& file) {
  for (size_t i = 0; i < lanes.size(); ++i)
    if (lanes[i] == lane) return kFirstLaneId + static_cast<int>(i);
  lanes.push_back(lane);
  const int id = kFirstLaneId + static_cast<int>(lanes.size()) - 1;
  file.event(fmt::format(R"({{"ph":"M","pid":1,"tid":{},"name":"thread_name","args":{{"name":"{}"}}}})", id,
                         jsonEscaped(lane)));
  return id;
}

void writeThread(const ThreadBuffer& thread, std::vector<std::string_view>& lanes, TraceFile& file) {
  const std::string name = thread.name.empty() ? fmt::format("thread {}", thread.id) : thread.name;
  file.event(fmt::format(R"({{"ph":"M","pid":1,"tid":{},"name":"thread_name","args":{{"name":"{}"}}}})", thread.id,
                         jsonEscaped(name)));
  const int64_t startNs = g_startNs.load(std::memory_order_relaxed);
  const size_t count = thread.count.load(std::memory_order_acquire);
  for (size_t i = 0; i < count; ++i) {
    const Event& event = (*thread.blocks[i / kEventsPerBlock])[i % kEventsPerBlock];
    const int id = event.lane ? laneId(lanes, event.lane, file) : thread.id;
    // Microseconds, as the format wants; three decimals keep the nanoseconds.
    file.event(fmt::format(R"({{"ph":"X","pid":1,"tid":{},"name":"{}","ts":{:.3f},"dur":{:.3f}}})", id,
                           jsonEscaped(event.name), static_cast<double>(event.beginNs - startNs) / 1e3,
                           static_cast<double>(event.endNs - event.beginNs) / 1e3));
  }
}

}  // namespace

int64_t monotonicNs() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

void startTrace() {
  g_startNs.store(monotonicNs(), std::memory_order_relaxed);
  g_isRecording.store(true, std::memory_order_relaxed);
}

void nameThread(const std::string& name) {
  pthread_setname_np(pthread_self(), name.substr(0, 15).c_str());  // the kernel's limit
  ThreadBuffer& thread = thisThread();
  const std::lock_guard lock(registry().mutex);
  thread.name = name;
}

void traceSpan(const char* lane, const char* name, int64_t beginNs, int64_t endNs) {
  if (g_isRecording.load(std::memory_order_relaxed)) thisThread().add(Event{lane, name, beginNs, endNs});
}

Result<void> writeTrace(const std::string& path) {
  TraceFile file(path);
  uint64_t dropped = 0;
  {
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    std::vector<std::string_view> lanes;
    file.write(R"({"displayTimeUnit":"ms","traceEvents":[)");
    for (const auto& thread : all.threads) {
      writeThread(*thread, lanes, file);
      dropped += thread->dropped.load(std::memory_order_relaxed);
    }
  }
  file.write(fmt::format("\n],\"otherData\":{{\"droppedEvents\":{}}}}}\n", dropped));
  if (dropped > 0) spdlog::warn("trace {}: {} events came after its memory was full and are not in it", path, dropped);
  return file.close();
}

TraceScope::TraceScope(const char* name)
    : name_(g_isRecording.load(std::memory_order_relaxed) ? name : nullptr), beginNs_(name_ ? monotonicNs() : 0) {}

TraceScope::~TraceScope() {
  if (name_) thisThread().add(Event{nullptr, name_, beginNs_, monotonicNs()});
}

}  // namespace eye

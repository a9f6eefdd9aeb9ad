#include "telemetry/trace.h"

#include <pthread.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <thread>

#include <catch2/catch.hpp>

namespace eye {
namespace {

namespace fs = std::filesystem;

struct Span {
  std::string thread, name;
  double beginUs, durationUs;
};

// Recording lasts for the whole process, so each test looks for its own names.
std::vector<Span> spansOf(const std::string& json) {
  const std::regex threadPattern(
      R"re("ph":"M","pid":1,"tid":(\d+),"name":"thread_name","args":\{"name":"((?:[^"\\]|\\.)*)"\})re");
  const std::regex spanPattern(
      R"re("ph":"X","pid":1,"tid":(\d+),"name":"((?:[^"\\]|\\.)*)","ts":(-?[0-9.]+),"dur":([0-9.]+)\})re");
  std::map<std::string, std::string> threads;
  for (std::sregex_iterator it(json.begin(), json.end(), threadPattern), end; it != end; ++it)
    threads[(*it)[1]] = (*it)[2];
  std::vector<Span> spans;
  for (std::sregex_iterator it(json.begin(), json.end(), spanPattern), end; it != end; ++it)
    spans.push_back({threads[(*it)[1]], (*it)[2], std::stod((*it)[3]), std::stod((*it)[4])});
  return spans;
}

std::string writtenTrace() {
  const fs::path path = fs::temp_directory_path() / ("eyepoint_trace_" + std::to_string(getpid()) + ".json");
  REQUIRE(writeTrace(path.string()));
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  fs::remove(path);
  return text.str();
}

std::vector<Span> spansNamed(const std::string& name) {
  std::vector<Span> found;
  for (const Span& span : spansOf(writtenTrace()))
    if (span.name == name) found.push_back(span);
  return found;
}

TEST_CASE("nothing is recorded before a trace is asked for, everything after") {
  { TraceScope scope("before the start"); }
  startTrace();
  {
    TraceScope outer("outer");
    TraceScope inner("inner");
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  CHECK(spansNamed("before the start").empty());
  const auto outer = spansNamed("outer"), inner = spansNamed("inner");
  REQUIRE(outer.size() == 1);
  REQUIRE(inner.size() == 1);
  CHECK(inner[0].durationUs >= 2000);
  CHECK(inner[0].beginUs >= outer[0].beginUs);
  CHECK(inner[0].beginUs + inner[0].durationUs <= outer[0].beginUs + outer[0].durationUs + 1e-3);
  CHECK(outer[0].beginUs >= 0);
  CHECK(outer[0].beginUs < 60e6);  // from the start of the trace, not of the machine
}

TEST_CASE("spans carry their thread's name, which the system sees too, also after the thread has ended") {
  startTrace();
  std::array<char, 16> systemName{};
  std::thread([&] {
    nameThread("paging \"worker\" number one");
    pthread_getname_np(pthread_self(), systemName.data(), systemName.size());
    TraceScope scope("work of a named thread");
  }).join();
  CHECK(std::string(systemName.data()) == "paging \"worker\"");
  const auto spans = spansNamed("work of a named thread");
  REQUIRE(spans.size() == 1);
  CHECK(spans[0].thread == R"(paging \"worker\" number one)");
}

TEST_CASE("a span on a lane has the lane for its thread") {
  startTrace();
  const int64_t nowNs = monotonicNs();
  traceSpan("GPU", "terrain pass", nowNs, nowNs + 1'234'567);
  std::thread([&] { traceSpan("GPU", "terrain pass", nowNs + 2'000'000, nowNs + 3'000'000); }).join();
  const auto spans = spansNamed("terrain pass");
  REQUIRE(spans.size() == 2);
  for (const Span& span : spans) CHECK(span.thread == "GPU");
  CHECK(spans[0].durationUs == Approx(1234.567).margin(1e-6));
  const std::string json = writtenTrace();
  const std::string laneName = R"("args":{"name":"GPU"})";
  CHECK(json.find(laneName) != std::string::npos);
  CHECK(json.find(laneName) == json.rfind(laneName));  // one lane, whichever thread reports it
}

TEST_CASE("threads may record while the trace is written") {
  startTrace();
  constexpr int kThreads = 4, kScopes = 20'000;  // more than one block a thread
  std::atomic<int> running{kThreads};
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i)
    threads.emplace_back([&] {
      nameThread("recorder");
      for (int k = 0; k < kScopes; ++k) TraceScope scope("concurrent");
      --running;
    });
  const fs::path path = fs::temp_directory_path() / ("eyepoint_trace_busy_" + std::to_string(getpid()) + ".json");
  do {
    REQUIRE(writeTrace(path.string()));
  } while (running > 0);
  for (std::thread& thread : threads) thread.join();
  fs::remove(path);

  const std::string json = writtenTrace();
  size_t count = 0;
  for (size_t at = json.find("\"concurrent\""); at != std::string::npos; at = json.find("\"concurrent\"", at + 1))
    ++count;
  CHECK(count == size_t{kThreads} * kScopes);
}

TEST_CASE("a trace that cannot be written says where and why") {
  const auto missing = writeTrace("/nonexistent-folder/trace.json");
  REQUIRE_FALSE(missing);
  CHECK(missing.error().kind == ErrorKind::io);
  CHECK(missing.error().message.find("/nonexistent-folder/trace.json") != std::string::npos);
  const auto full = writeTrace("/dev/full");
  REQUIRE_FALSE(full);
  CHECK(full.error().kind == ErrorKind::noSpace);
}

TEST_CASE("the clock never runs backwards") {
  int64_t last = monotonicNs();
  for (int i = 0; i < 1000; ++i) {
    const int64_t now = monotonicNs();
    REQUIRE(now >= last);
    last = now;
  }
}

// Last: its events stay in memory and would slow every trace written after it.
TEST_CASE("a thread's memory is bounded and what does not fit is counted") {
  startTrace();
  constexpr int kBeyond = 5;
  std::thread([] {
    for (int i = 0; i < 256 * 8192 + kBeyond; ++i) traceSpan("flood", "x", 0, 1);
  }).join();
  const std::string json = writtenTrace();
  CHECK(json.find("\"droppedEvents\":5}") != std::string::npos);
}

}  // namespace
}  // namespace eye

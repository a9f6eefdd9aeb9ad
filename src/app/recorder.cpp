#include "app/recorder.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "raster/picture.h"
#include "telemetry/trace.h"

extern char** environ;

namespace eye {
namespace {

constexpr size_t kMaxQueuedFrames = 8;  // 8 frames of 1280x720 are 29 MB

// ffmpeg with its standard input as a pipe.
struct Ffmpeg {
  pid_t pid = -1;
  int pipe = -1;
};

Result<Ffmpeg> startFfmpeg(const RecorderOptions& options) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    return fail(ErrorKind::io, fmt::format("no pipe to ffmpeg: {}", std::strerror(errno)));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  const std::string size = fmt::format("{}x{}", options.widthPx, options.heightPx),
                    rate = fmt::format("{}", options.rateHz);
  std::vector<std::string> words{"ffmpeg",      "-y",         "-loglevel",  "error",
                                 "-f",          "rawvideo",   "-pix_fmt",   "rgba",
                                 "-video_size", size,         "-framerate", rate,
                                 "-i",          "-",          "-vf",        "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                 "-pix_fmt",    "yuv420p",    "-preset",    "veryfast",
                                 "-movflags",   "+faststart", options.film};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  // In a process group of its own: Ctrl-C ends the flight, and the film is then finished like any other.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  Ffmpeg ffmpeg;
  const int failed = posix_spawnp(&ffmpeg.pid, "ffmpeg", &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  if (failed != 0) {
    close(ends[1]);
    return fail(ErrorKind::unsupported,
                fmt::format("{}: recording needs ffmpeg ({}); install it (apt install ffmpeg) or use "
                            "--frames-dir",
                            options.film, std::strerror(failed)));
  }
  ffmpeg.pipe = ends[1];
  return ffmpeg;
}

bool writeAll(int descriptor, std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<size_t>(written));
  }
  return true;
}

struct Frame {
  std::vector<uint8_t> rgba;
  uint64_t times = 1;  // in the film
};

}  // namespace

struct Recorder::Impl {
  RecorderOptions options;
  Ffmpeg ffmpeg;
  uint64_t filmFrames = 0;  // handed over so far
  std::mutex mutex;         // guards what follows; the thread owns all else
  std::condition_variable changed;
  std::deque<Frame> queue;
  std::vector<std::vector<uint8_t>> spare;  // frames' memory, used again
  bool closing = false;
  std::optional<Error> error;
  std::thread thread;

  void run();
  Result<void> writeFrame(const Frame& frame, uint64_t number);
};

Result<void> Recorder::Impl::writeFrame(const Frame& frame, uint64_t number) {
  const TraceScope scope("record frame");
  for (uint64_t i = 0; ffmpeg.pipe >= 0 && i < frame.times; ++i)
    if (!writeAll(ffmpeg.pipe, frame.rgba))
      return fail(ErrorKind::io, fmt::format("{}: ffmpeg stopped taking frames at frame {} ({}); its message is above",
                                             options.film, number, std::strerror(errno)));
  if (options.folder.empty()) return {};
  const std::string path = fmt::format("{}/frame{:06}.png", options.folder, number);
  return writePng(path, frame.rgba, options.widthPx, options.heightPx);
}

void Recorder::Impl::run() {
  nameThread("recorder");
  for (uint64_t number = 0;; ++number) {
    Frame frame;
    {
      std::unique_lock lock(mutex);
      changed.wait(lock, [&] { return closing || !queue.empty(); });
      if (queue.empty()) return;
      frame = std::move(queue.front());
      queue.pop_front();
    }
    const Result<void> written = writeFrame(frame, number);
    const std::lock_guard lock(mutex);
    if (!written) error = written.error();
    spare.push_back(std::move(frame.rgba));
    changed.notify_all();
    if (error) return;
  }
}

Recorder::Recorder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Recorder::~Recorder() {
  (void)finish();
}

Result<std::unique_ptr<Recorder>> Recorder::create(const RecorderOptions& options) {
  auto impl = std::make_unique<Impl>();
  impl->options = options;
  if (!options.folder.empty()) {
    std::error_code failed;
    std::filesystem::create_directories(options.folder, failed);
    if (failed)
      return fail(ErrorKind::io, fmt::format("{}: cannot make the folder: {}", options.folder, failed.message()));
  }
  if (!options.film.empty()) {
    Result<Ffmpeg> started = startFfmpeg(options);
    if (!started) return tl::unexpected(started.error());
    impl->ffmpeg = *started;
  }
  Impl& running = *impl;
  impl->thread = std::thread([&running] { running.run(); });
  return std::unique_ptr<Recorder>(new Recorder(std::move(impl)));
}

Result<void> Recorder::add(std::span<const uint8_t> rgba, int widthPx, int heightPx, double timeS) {
  if (widthPx != impl_->options.widthPx || heightPx != impl_->options.heightPx)
    return fail(ErrorKind::unsupported,
                "the window changed its size while recording; record with --headless, or leave its size");
  std::unique_lock lock(impl_->mutex);
  impl_->changed.wait(lock, [&] { return impl_->error || impl_->queue.size() < kMaxQueuedFrames; });
  if (impl_->error) return tl::unexpected(*impl_->error);
  Frame frame;
  if (!impl_->spare.empty()) {
    frame.rgba = std::move(impl_->spare.back());
    impl_->spare.pop_back();
  }
  frame.rgba.assign(rgba.begin(), rgba.end());
  const auto due = static_cast<uint64_t>(std::max(0.0, timeS * impl_->options.rateHz)) + 1;  // film frames by now
  frame.times = due > impl_->filmFrames ? due - impl_->filmFrames : 1;
  impl_->filmFrames += frame.times;
  impl_->queue.push_back(std::move(frame));
  impl_->changed.notify_all();
  return {};
}

Result<void> Recorder::finish() {
  if (!impl_->thread.joinable()) return {};
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->closing = true;
    impl_->changed.notify_all();
  }
  impl_->thread.join();
  if (impl_->ffmpeg.pipe >= 0) {
    close(impl_->ffmpeg.pipe);
    int status = 0;
    while (waitpid(impl_->ffmpeg.pid, &status, 0) < 0 && errno == EINTR) {
    }
    if (!impl_->error && (!WIFEXITED(status) || WEXITSTATUS(status) != 0))
      impl_->error = Error{ErrorKind::io, fmt::format("{}: ffmpeg failed; its message is above", impl_->options.film)};
  }
  if (impl_->error) return tl::unexpected(*impl_->error);
  return {};
}

}  // namespace eye

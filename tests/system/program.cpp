#include "system/program.h"
#include "support/places.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace eye::truth {
namespace {

std::vector<std::string> environmentWith(const RunSettings& settings) {
  std::vector<std::string> all;
  auto changes = settings.environment;
  changes.emplace_back("XDG_CACHE_HOME", testFile("cache"));
  changes.emplace_back("XDG_DATA_HOME", testFile("data"));
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string text(*variable), name = text.substr(0, text.find('='));
    bool changed = false;
    for (const auto& [key, value] : changes) changed = changed || key == name;
    if (!changed) all.push_back(text);
  }
  for (const auto& [key, value] : changes) all.push_back(key + "=" + value);
  return all;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> result;
  for (std::string& word : words) result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

// Both pipes until the program closes them or its time is up.
void drain(int outPipe, int errPipe, double timeoutS, ProgramRun& run) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeoutS);
  pollfd pipes[2]{{outPipe, POLLIN, 0}, {errPipe, POLLIN, 0}};
  std::string* texts[2]{&run.out, &run.err};
  while (pipes[0].fd >= 0 || pipes[1].fd >= 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    if (left.count() <= 0) {
      run.timedOut = true;
      return;
    }
    poll(pipes, 2, static_cast<int>(left.count()));
    for (int i = 0; i < 2; ++i) {
      if ((pipes[i].revents & (POLLIN | POLLHUP)) == 0) continue;
      char bytes[4096];
      const ssize_t count = read(pipes[i].fd, bytes, sizeof bytes);
      if (count > 0)
        texts[i]->append(bytes, static_cast<size_t>(count));
      else
        pipes[i].fd = -1;
    }
  }
}

}  // namespace

std::vector<std::string> ProgramRun::errorLines() const {
  std::vector<std::string> lines;
  std::stringstream stream(err);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

ProgramRun runProgram(const std::string& program, const std::vector<std::string>& arguments,
                      const RunSettings& settings) {
  ProgramRun run;
  int out[2], err[2];
  if (pipe2(out, O_CLOEXEC) != 0 || pipe2(err, O_CLOEXEC) != 0) return run;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
  std::vector<std::string> words{eye::test::kBinDir + "/" + program}, variables = environmentWith(settings);
  words.insert(words.end(), arguments.begin(), arguments.end());
  pid_t pid = -1;
  const int failed =
      posix_spawn(&pid, words[0].c_str(), &actions, nullptr, pointers(words).data(), pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  close(out[1]);
  close(err[1]);
  if (failed == 0) {
    drain(out[0], err[0], settings.timeoutS, run);
    if (run.timedOut) kill(pid, SIGKILL);
    int status = 0;
    waitpid(pid, &status, 0);
    if (WIFEXITED(status)) run.exitCode = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) run.signal = WTERMSIG(status);
  }
  close(out[0]);
  close(err[0]);
  return run;
}

std::string testFile(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(eye::test::kTestFiles) / name;
  std::filesystem::create_directories(path.parent_path());
  return path.string();
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::string readText(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void writeText(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string carpathiaDatabase() {
  const std::string path = testFile("carpathia.eyt");
  if (std::filesystem::exists(path)) return path;
  WARN("no " << path << ": the elevation of the Tatra is not on this machine, so this test checks nothing");
  return {};
}

}  // namespace eye::truth

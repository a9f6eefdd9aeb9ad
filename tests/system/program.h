// Runs the built programs as their users do, and keeps what they said.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace eye::truth {

struct ProgramRun {
  int exitCode = -1;  // -1: ended by a signal or never started
  int signal = 0;
  bool timedOut = false;
  std::string out, err;
  std::vector<std::string> errorLines() const;
};

struct RunSettings {
  std::vector<std::pair<std::string, std::string>> environment;  // on top of this process's own
  double timeoutS = 120;                                         // then it is killed, and timedOut is set
};

// `program`: eyepoint, eyepoint-bake or eyepoint-host, from the build's own folder. Its caches go to the tests' folder.
// Thread: any number at once.
ProgramRun runProgram(const std::string& program, const std::vector<std::string>& arguments,
                      const RunSettings& settings = {});

// kTestFiles/name, its folder made where it is missing.
std::string testFile(const std::string& name);
std::string joined(const std::vector<std::string>& words);
std::string readText(const std::string& path);
void writeText(const std::string& path, const std::string& text);

// The database of real mountains; empty, with a warning, where the data are not here.
std::string carpathiaDatabase();

}  // namespace eye::truth

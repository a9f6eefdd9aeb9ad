// What the programs do alike before their own work begins.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "base/error.h"

namespace eye {

// One line on stderr; the exit status that belongs to it.
int complain(const std::string& program, const Error& error);
// The status to leave with at once: --help and --version have been printed, or the error has.
std::optional<int> parseArguments(CLI::App& app, int argc, const char* const* argv);
// The log, with the time, to stderr. `level`: one of spdlog's names.
void logToStderr(const std::string& program, const std::string& level);

}  // namespace eye

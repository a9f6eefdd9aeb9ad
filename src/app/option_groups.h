// Every option of eyepoint, group by group, as --help shows them.
#pragma once

#include <CLI/CLI.hpp>

#include "app/options.h"

namespace eye {

// The options must live as long as the app.
void addOptions(CLI::App& app, Options& options);

}  // namespace eye

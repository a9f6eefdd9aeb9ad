// What options' words mean: sizes, angles, rates, dates. A word that means nothing is a CLI::ValidationError that says
// what would.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "app/options.h"

namespace eye {

inline constexpr const char* kNumber = "number";  // the name of validators of numbers

// Numbers and nothing else, finite; wholeWithin: without a fraction.
CLI::Validator within(double least, double most);
CLI::Validator wholeWithin(uint64_t least, uint64_t most);

void setSize(Options& options, const std::string& text);
void setDepthMap(Options& options, const std::string& text);
void setDebugView(Options& options, const std::string& text);
void setFrustum(Options& options, const std::string& text);
void setMirror(Options& options, const std::string& text);
void setViewOffset(Options& options, const std::string& text);
void setRate(Options& options, const std::string& text);
void setHostDelay(Options& options, const std::string& text);
void setBackground(Options& options, const std::string& text);
void setDate(Options& options, const std::string& text);
CullingMode cullingOf(const std::string& text);
std::string nameOf(CullingMode culling);
TextureFilter filterOf(const std::string& text);
std::string nameOf(TextureFilter filter);  // auto, nearest ...
bool onOff(const std::string& name, const std::string& text);

}  // namespace eye

// What a mode loses over a flight against knowing beforehand. Pure. Times are of the same frames, by index.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace eye {

using FrameTimes = std::vector<double>;

// For each frame the fixed choice with the least time in hindsight. A single frame's time is noisy, so a choice is
// judged by its median over the frame and `reach` frames before and behind.
std::vector<size_t> bestChoices(std::span<const FrameTimes> fixed, size_t reach);

// Time over the flight against each frame's best choice: 0.03 is 3 % more. The best is charged its own frames' times,
// not the medians, so that outliers count alike on both sides.
double regret(const FrameTimes& mode, std::span<const FrameTimes> fixed, std::span<const size_t> best);

// The greatest loss against `other` over any so many frames behind one another (all where there are fewer).
double worstLoss(const FrameTimes& mode, const FrameTimes& other, size_t frames);

// Running medians, for plots.
FrameTimes runningMedian(const FrameTimes& times, size_t reach);

}  // namespace eye

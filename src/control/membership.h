// Fuzzy membership: a piecewise-linear function of one input.
#pragma once

#include <vector>

namespace eye {

// Through the points (at[i], value[i]), level beyond the first and the last. `at` increases strictly; both lists are of
// one length and not empty (selector_rules.h checks what files give).
struct Membership {
  std::vector<double> at, value;
  bool operator==(const Membership&) const = default;
};

// NaN for NaN.
double membershipAt(const Membership& membership, double x);

}  // namespace eye

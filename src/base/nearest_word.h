// What was meant by a mistyped key or option.
#pragma once

#include <string>
#include <vector>

namespace eye {

// The known word nearest to `word` by edit distance, for "did you mean"; empty where none is near.
std::string nearestWord(const std::string& word, const std::vector<std::string>& known);

}  // namespace eye

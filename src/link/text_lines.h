// Lines of a text one after another, with their numbers: without copies, with either line ending.
#pragma once

#include <optional>
#include <string_view>

namespace eye {

class TextLines {
 public:
  explicit TextLines(std::string_view text) : rest_(text) {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);  // a byte order mark, as spreadsheets write it
  }

  std::optional<std::string_view> next() {
    if (rest_.empty()) return std::nullopt;
    ++number_;
    const size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  size_t number() const { return number_; }  // of the line that came last, from 1

 private:
  std::string_view rest_;
  size_t number_ = 0;
};

}  // namespace eye

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "link/text_lines.h"
#include "pano/summit_fields.h"

namespace eye {
namespace {

constexpr size_t kMaxCells = 256;  // of a row; the rest is not looked at

// Cells of a row; quotes around a cell are taken off, "" in it is one quote.
std::vector<std::string> cellsOf(std::string_view row, char separator) {
  std::vector<std::string> cells;
  while (cells.size() < kMaxCells) {
    std::string cell;
    size_t i = std::min(row.find_first_not_of(' '), row.size());
    const bool quoted = i < row.size() && row[i] == '"';
    if (quoted) {
      for (++i; i < row.size(); ++i) {
        if (row[i] != '"') {
          cell += row[i];
        } else if (i + 1 < row.size() && row[i + 1] == '"') {
          cell += row[i++];
        } else {
          break;
        }
      }
    }
    const size_t end = std::min(row.find(separator, i), row.size());
    if (!quoted) cell = row.substr(i, end - i);
    while (cell.ends_with(' ') || cell.ends_with('\t')) cell.pop_back();
    cells.push_back(std::move(cell));
    if (end == row.size()) break;
    row.remove_prefix(end + 1);
  }
  return cells;
}

enum Column : size_t { columnName, columnLat, columnLon, columnHeight, columnCount };
constexpr std::array<std::array<std::string_view, 5>, columnCount> kNames{
    {{"name", "peak", "summit", "", ""},
     {"lat", "latitude", "lat_deg", "", ""},
     {"lon", "longitude", "lng", "long", "lon_deg"},
     {"height_m", "height", "ele", "elevation", "alt"}}};
using Layout = std::array<size_t, columnCount>;  // kMaxCells: not there

std::string lowerCase(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

Result<Layout> layoutOf(const std::vector<std::string>& header) {
  Layout layout;
  layout.fill(kMaxCells);
  for (size_t column = 0; column < columnCount; ++column) {
    for (size_t cell = header.size(); cell-- > 0;)
      if (!header[cell].empty() && std::ranges::count(kNames[column], lowerCase(header[cell])) > 0)
        layout[column] = cell;
    if (layout[column] == kMaxCells && column != columnHeight)
      return fail(ErrorKind::badData, fmt::format("no column '{}'; the first line must name the columns name, lat, lon "
                                                  "and perhaps height (degrees, metres)",
                                                  kNames[column][0]));
  }
  return layout;
}

}  // namespace

Result<std::vector<Summit>> parseCsvGazetteer(std::string_view text) {
  TextLines lines(text);
  std::optional<Layout> layout;
  char separator = ',';
  std::vector<Summit> summits;
  while (const auto row = lines.next()) {
    if (row->find_first_not_of(" \t") == std::string_view::npos || row->starts_with('#')) continue;
    if (!layout) {
      if (std::ranges::count(*row, ';') > std::ranges::count(*row, ',')) separator = ';';
      const Result<Layout> header = layoutOf(cellsOf(*row, separator));
      if (!header) return failAtLine(lines.number(), header.error().message);
      layout = *header;
      continue;
    }
    const std::vector<std::string> cells = cellsOf(*row, separator);
    const auto cell = [&](Column column) {
      return (*layout)[column] < cells.size() ? std::string_view(cells[(*layout)[column]]) : std::string_view();
    };
    Result<Summit> summit = summitFrom(cell(columnName), cell(columnLat), cell(columnLon), cell(columnHeight));
    if (!summit) return failAtLine(lines.number(), summit.error().message);
    if (!summit->name.empty()) summits.push_back(std::move(*summit));
  }
  if (!layout) return fail(ErrorKind::badData, "it is empty");
  return summits;
}

}  // namespace eye

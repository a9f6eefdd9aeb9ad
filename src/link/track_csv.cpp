#include <fmt/format.h>

#include <array>
#include <cmath>

#include "link/pose_limits.h"
#include "link/text_lines.h"
#include "link/track_file.h"

namespace eye {
namespace {

enum Column : size_t {
  columnTime,
  columnLat,
  columnLon,
  columnAlt,
  columnHeading,
  columnPitch,
  columnRoll,
  columnCount
};
constexpr std::array<std::string_view, columnCount> kColumnNames = {"time",    "lat",   "lon", "alt",
                                                                    "heading", "pitch", "roll"};
constexpr size_t kRequiredColumns = columnAlt + 1;

// A row has at most this many cells, so that a line of a million commas costs nothing.
constexpr size_t kMaxCells = 256;
// Seconds since 1970 and what anyone may count from, with microseconds left in a double.
constexpr double kMaxTimeS = 1e10;
constexpr double kMaxAngleDeg = 3600;  // a heading that counts turns is fine, garbage is not

std::string_view strippedCell(std::string_view cell) {
  constexpr std::string_view kAround = " \t\"";
  const size_t first = cell.find_first_not_of(kAround);
  if (first == std::string_view::npos) return {};
  return cell.substr(first, cell.find_last_not_of(kAround) - first + 1);
}

// Splits at commas into `cells` and returns how many there are; cells past kMaxCells are left out.
size_t splitRow(std::string_view row, std::array<std::string_view, kMaxCells>& cells) {
  size_t count = 0;
  while (count < kMaxCells) {
    const size_t comma = row.find(',');
    cells[count++] = strippedCell(row.substr(0, comma));
    if (comma == std::string_view::npos) break;
    row.remove_prefix(comma + 1);
  }
  return count;
}

// Where each column lies in a row; kMaxCells for one that is missing.
using Layout = std::array<size_t, columnCount>;

tl::unexpected<Error> failAt(size_t line, const std::string& what) {
  return fail(ErrorKind::badData, fmt::format("line {}: {}", line, what));
}

Result<Layout> readHeader(std::string_view row, size_t line) {
  std::array<std::string_view, kMaxCells> cells;
  const size_t count = splitRow(row, cells);
  Layout layout;
  for (size_t column = 0; column < columnCount; ++column) {
    layout[column] = kMaxCells;
    for (size_t cell = 0; cell < count; ++cell) {
      if (cells[cell] != kColumnNames[column]) continue;
      if (layout[column] != kMaxCells)
        return failAt(line, fmt::format("column '{}' is there twice", kColumnNames[column]));
      layout[column] = cell;
    }
    if (column < kRequiredColumns && layout[column] == kMaxCells)
      return failAt(line, fmt::format("no column '{}'; the first line must name the columns "
                                      "time,lat,lon,alt[,heading,pitch,roll] (seconds, degrees, metres)",
                                      kColumnNames[column]));
  }
  return layout;
}

Result<TrackFix> readRow(std::string_view row, const Layout& layout, size_t line) {
  std::array<std::string_view, kMaxCells> cells;
  const size_t count = splitRow(row, cells);
  std::array<std::optional<double>, columnCount> values;
  for (size_t column = 0; column < columnCount; ++column) {
    const std::string_view cell = layout[column] < count ? cells[layout[column]] : std::string_view();
    if (cell.empty() && column >= kRequiredColumns) continue;  // attitude that is missing comes from the path
    values[column] = parseNumber(cell);
    if (!values[column])
      return failAt(line, fmt::format("{} '{}' is not a number", kColumnNames[column], cell.substr(0, 40)));
    const double limit = column == columnTime ? kMaxTimeS : column >= columnHeading ? kMaxAngleDeg : HUGE_VAL;
    if (std::abs(*values[column]) > limit)
      return failAt(line,
                    fmt::format("{} {} is outside -{} to {}", kColumnNames[column], *values[column], limit, limit));
  }
  const auto position = checkedPosition({*values[columnLat], *values[columnLon], *values[columnAlt]});
  if (!position) return failAt(line, position.error().message);
  return TrackFix{*values[columnTime], *position, values[columnHeading], values[columnPitch], values[columnRoll]};
}

}  // namespace

Result<Track> parseCsvTrack(std::string_view text) {
  TextLines lines(text);
  std::optional<Layout> layout;
  std::vector<TrackFix> fixes;
  while (const auto row = lines.next()) {
    if (strippedCell(*row).empty() || row->starts_with('#')) continue;
    if (!layout) {
      const auto header = readHeader(*row, lines.number());
      if (!header) return tl::unexpected(header.error());
      layout = *header;
      continue;
    }
    const auto fix = readRow(*row, *layout, lines.number());
    if (!fix) return tl::unexpected(fix.error());
    if (!fixes.empty() && fix->timeS < fixes.back().timeS)
      return failAt(lines.number(),
                    fmt::format("time goes back from {} to {}; sort the rows by time", fixes.back().timeS, fix->timeS));
    if (!fixes.empty() && fix->timeS == fixes.back().timeS) continue;  // the first of two for one moment counts
    if (fixes.size() == kMaxTrackSamples)
      return failAt(lines.number(), fmt::format("more than {} rows; cut the track into parts", kMaxTrackSamples));
    fixes.push_back(*fix);
  }
  if (fixes.empty()) return fail(ErrorKind::badData, "there are no samples in it; expected a CSV header and rows");
  return Track(withAttitude(fixes));
}

}  // namespace eye

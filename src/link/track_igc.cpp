#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "link/pose_limits.h"
#include "link/text_lines.h"
#include "link/track_file.h"

// FAI "Technical Specification for IGC-approved GNSS flight recorders", appendix A: the B record has fixed columns,
// B HHMMSS DDMMmmmN DDDMMmmmE V PPPPP GGGGG: UTC, latitude and longitude in minutes and thousandths, validity (A: 3D,
// V: 2D), pressure altitude, GNSS altitude (metres, possibly negative).

namespace eye {
namespace {

constexpr size_t kFixChars = 35;
constexpr double kDayS = 86400;

struct IgcFix {
  double dayS = 0;  // the day's beginning, from the last date record; 0 before the first
  double secondOfDay = 0;
  double latDeg = 0, lonDeg = 0;
  bool threeD = false;
  double pressureAltM = 0, gnssAltM = 0;
};

// Digits only, `count` of them at `at`; nothing when another character is among them.
std::optional<int> digits(std::string_view line, size_t at, size_t count) {
  int value = 0;
  for (const char c : line.substr(at, count)) {
    if (c < '0' || c > '9') return std::nullopt;
    value = value * 10 + (c - '0');
  }
  return value;
}

std::optional<int> altitude(std::string_view line, size_t at) {
  if (line[at] != '-') return digits(line, at, 5);
  const auto below = digits(line, at + 1, 4);
  return below ? std::optional(-*below) : std::nullopt;
}

// "HFDTE280614" or "HFDTEDATE:280614,01": the day's beginning in seconds since 1970. Nothing where there is no such
// day; recorders write 000000 before they know.
std::optional<double> readDate(std::string_view line) {
  line.remove_prefix(std::string_view("HFDTE").size());
  if (line.starts_with("DATE:")) line.remove_prefix(5);
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  if (line.size() < 6) return std::nullopt;
  const auto day = digits(line, 0, 2), month = digits(line, 2, 2), year = digits(line, 4, 2);
  if (!day || !month || !year) return std::nullopt;
  // Flight recorders are younger than 1990.
  const std::chrono::year_month_day date(std::chrono::year(*year + (*year >= 90 ? 1900 : 2000)),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day)));
  if (!date.ok()) return std::nullopt;
  return static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count()) * kDayS;
}

Result<IgcFix> readFix(std::string_view line, size_t number) {
  const auto bad = [&](const char* what) {
    return fail(ErrorKind::badData, fmt::format("line {}: B record {}", number, what));
  };
  if (line.size() < kFixChars) return bad("is cut short");
  const auto hours = digits(line, 1, 2), minutes = digits(line, 3, 2), seconds = digits(line, 5, 2);
  if (!hours || !minutes || !seconds || *hours > 23 || *minutes > 59 || *seconds > 60) return bad("has no time HHMMSS");
  const auto latDeg = digits(line, 7, 2), latMilliMin = digits(line, 9, 5);
  const auto lonDeg = digits(line, 15, 3), lonMilliMin = digits(line, 18, 5);
  const char northSouth = line[14], eastWest = line[23], validity = line[24];
  if (!latDeg || !latMilliMin || *latMilliMin > 60000 || (northSouth != 'N' && northSouth != 'S'))
    return bad("has no latitude DDMMmmmN");
  if (!lonDeg || !lonMilliMin || *lonMilliMin > 60000 || (eastWest != 'E' && eastWest != 'W'))
    return bad("has no longitude DDDMMmmmE");
  if (validity != 'A' && validity != 'V') return bad("is neither A (3D) nor V (2D)");
  const auto pressureAlt = altitude(line, 25), gnssAlt = altitude(line, 30);
  if (!pressureAlt || !gnssAlt) return bad("has no altitudes PPPPPGGGGG");

  IgcFix fix;
  fix.secondOfDay = *hours * 3600.0 + *minutes * 60.0 + *seconds;
  fix.latDeg = (*latDeg + *latMilliMin / 60000.0) * (northSouth == 'S' ? -1 : 1);
  fix.lonDeg = (*lonDeg + *lonMilliMin / 60000.0) * (eastWest == 'W' ? -1 : 1);
  fix.threeD = validity == 'A';
  fix.pressureAltM = *pressureAlt;
  fix.gnssAltM = *gnssAlt;
  const auto position = checkedPosition({fix.latDeg, fix.lonDeg, 0});
  if (!position) return fail(ErrorKind::badData, fmt::format("line {}: {}", number, position.error().message));
  fix.lonDeg = position->lonDeg;
  return fix;
}

// Recorders without GNSS altitude write 0 there; those that lose it mark the fix as 2D. Then only pressure is left.
bool hasGnssAltitude(const std::vector<IgcFix>& fixes) {
  for (const IgcFix& fix : fixes)
    if (fix.threeD && fix.gnssAltM != 0) return true;
  return false;
}

}  // namespace

Result<Track> parseIgcTrack(std::string_view text) {
  TextLines lines(text);
  std::vector<IgcFix> records;
  double dateS = 0;
  while (const auto line = lines.next()) {
    if (line->starts_with("HFDTE")) {
      const bool first = dateS == 0;
      dateS = readDate(*line).value_or(dateS);
      if (first)  // what came before it knew its date is of the same day
        for (IgcFix& record : records) record.dayS = dateS;
    }
    if (!line->starts_with('B')) continue;
    auto fix = readFix(*line, lines.number());
    if (!fix) return tl::unexpected(fix.error());
    if (records.size() == kMaxTrackSamples)
      return fail(ErrorKind::badData, fmt::format("line {}: more than {} fixes; cut the track into parts",
                                                  lines.number(), kMaxTrackSamples));
    fix->dayS = dateS;
    records.push_back(*fix);
  }

  // Files of several flights need not have them in order.
  std::stable_sort(records.begin(), records.end(), [](const IgcFix& a, const IgcFix& b) { return a.dayS < b.dayS; });
  const bool gnss = hasGnssAltitude(records);
  std::vector<TrackFix> fixes;
  double dayS = 0, midnightsS = 0;
  for (const IgcFix& record : records) {
    if (gnss && !record.threeD) continue;
    if (record.dayS != dayS) dayS = record.dayS, midnightsS = 0;
    double timeS = dayS + midnightsS + record.secondOfDay;
    if (!fixes.empty() && fixes.back().timeS - timeS > kDayS / 2) {  // past midnight: the date is not written again
      midnightsS += kDayS;
      timeS += kDayS;
    }
    // A clock set back a little by the first good fix, or two fixes in one second: the earlier one counts.
    if (!fixes.empty() && timeS <= fixes.back().timeS) continue;
    const double altM = gnss ? record.gnssAltM : record.pressureAltM;
    if (altM < kMinAltitudeM)
      continue;  // pressure altitudes can be off by much; five digits cannot exceed the upper limit
    fixes.push_back({timeS, {record.latDeg, record.lonDeg, altM}, {}, {}, {}});
  }
  if (fixes.empty()) return fail(ErrorKind::badData, "there are no fixes (B records) in it");
  return Track(withAttitude(fixes));
}

}  // namespace eye

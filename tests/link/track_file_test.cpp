#include "link/track_file.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "geo/frames.h"
#include "packets.h"
#include "support/places.h"

namespace eye {
namespace {

using namespace eye::test;

std::string messageOf(const Result<Track>& track) {
  return track ? "no error" : track.error().message;
}

bool contains(const std::string& text, const std::string& part) {
  INFO(text);
  return text.find(part) != std::string::npos;
}

bool plausible(const Track& track) {
  for (int i = 0; i <= 50; ++i) {
    const Pose p = track.at(track.durationS() * i / 50);
    if (!(std::abs(p.position.latDeg) <= 90 && std::abs(p.position.lonDeg) <= 180 && std::isfinite(p.position.altM) &&
          p.headingDeg >= 0 && p.headingDeg < 360 && std::abs(p.pitchDeg) <= 90 && std::abs(p.rollDeg) <= 180))
      return false;
  }
  return true;
}

TEST_CASE("CSV: columns by name in any order, others ignored, comments and both line endings") {
  const auto track = parseCsvTrack(
      "\xef\xbb\xbfroll,alt,extra,lat,time,lon,\"pitch\",heading\r\n"
      "# a comment\r\n"
      "1,100,x,47,10,11,2,3\r\n"
      "\r\n"
      "-1, 110 ,y,47.001,+11.5,-348.999,-2,359\n");
  REQUIRE(track);
  REQUIRE(track->samples().size() == 2);
  CHECK(track->samples()[0].pose == Pose{{47, 11, 100}, 3, 2, 1});
  CHECK(track->samples()[1].timeS == 1.5);
  CHECK(track->samples()[1].pose.position.lonDeg == Approx(11.001));
  CHECK(track->samples()[1].pose.headingDeg == 359);
}

TEST_CASE("CSV: attitude may be missing as columns or as cells") {
  const auto columns = parseCsvTrack("time,lat,lon,alt\n0,47,11,100\n1,47,11.001,100\n2,47,11.002,100\n");
  REQUIRE(columns);
  CHECK(columns->at(1).headingDeg == Approx(90).margin(0.1));
  const auto cells = parseCsvTrack("time,lat,lon,alt,heading,pitch,roll\n0,47,11,100,,5,\n1,47,11.001,100\n");
  REQUIRE(cells);
  CHECK(cells->at(0).headingDeg == Approx(90).margin(0.1));
  CHECK(cells->at(0).pitchDeg == 5);
}

TEST_CASE("CSV: errors name the line and the column") {
  CHECK(contains(messageOf(parseCsvTrack("time,lat,lon\n")), "line 1: no column 'alt'"));
  CHECK(contains(messageOf(parseCsvTrack("time,lat,lon,alt,lat\n")), "line 1: column 'lat' is there twice"));
  CHECK(contains(messageOf(parseCsvTrack("time,lat,lon,alt\n0,1,2,3\n1,x,2,3\n")), "line 3: lat 'x' is not a number"));
  CHECK(contains(messageOf(parseCsvTrack("time,lat,lon,alt\n0,1,2\n")), "line 2: alt '' is not a number"));
  CHECK(contains(messageOf(parseCsvTrack("time,lat,lon,alt\n0,nan,2,3\n")), "line 2: lat 'nan'"));
  CHECK(contains(messageOf(parseCsvTrack("time,lat,lon,alt\n0,91,2,3\n")), "line 2: latitude 91"));
  CHECK(contains(messageOf(parseCsvTrack("time,lat,lon,alt,roll\n0,9,2,3,1e9\n")), "line 2: roll"));
  CHECK(
      contains(messageOf(parseCsvTrack("time,lat,lon,alt\n5,1,2,3\n4,1,2,3\n")), "line 3: time goes back from 5 to 4"));
  CHECK(contains(messageOf(parseCsvTrack("time,lat,lon,alt\n")), "no samples"));
  CHECK(contains(messageOf(parseCsvTrack("")), "no samples"));
  CHECK(contains(messageOf(parseCsvTrack(std::string(1000, ','))), "no column 'time'"));
}

constexpr const char* kIgc =
    "AXXX001\r\n"
    "B2359583712345N00812345WA0010000120\r\n"
    "B2359593712360N00812345WV0010100000\r\n"
    "B2359593712375N00812345WA0010200124garbage\r\n"
    "B0000013712405N00812345WA-001000126\r\n"
    "LXXX comment\r\n"
    "B0000003712405N00812345WA0010400126\r\n";

TEST_CASE("IGC: fixes, hemispheres, midnight, GNSS altitude where it is") {
  const auto track = parseIgcTrack(kIgc);
  REQUIRE(track);
  REQUIRE(track->samples().size() == 3);  // the 2D fix and the one that goes back in time are left out
  const auto& first = track->samples()[0].pose.position;
  CHECK(first.latDeg == Approx(37 + 12.345 / 60).epsilon(1e-14));
  CHECK(first.lonDeg == Approx(-(8 + 12.345 / 60)).epsilon(1e-14));
  CHECK(first.altM == 120);
  CHECK(track->durationS() == 3);
  CHECK(track->at(1).headingDeg == Approx(0).margin(1e-6));
}

TEST_CASE("IGC: several days in one file follow their dates") {
  const std::string day = "B1000003712345N00812345EA0010000100\nB1000013712345N00812345EA0010000100\n";
  const auto track = parseIgcTrack(fmt::format("HFDTEDATE:010314,02\n{0}HFDTE280214\n{0}HFDTE000000\n{0}", day));
  REQUIRE(track);
  CHECK(track->samples().size() == 4);
  CHECK(track->durationS() == 86401);
}

TEST_CASE("IGC: two midnights under one date") {
  std::string text = "HFDTE280214\n";
  for (const char* time : {"235900", "000100", "120000", "235900", "000100"})
    text += fmt::format("B{}3712345N00812345EA0010000100\n", time);
  const auto track = parseIgcTrack(text);
  REQUIRE(track);
  CHECK(track->samples().size() == 5);
  CHECK(track->durationS() == 86400 + 120);
}

TEST_CASE("IGC: pressure altitude where there is no other") {
  const auto track = parseIgcTrack("B1000003712345S00812345EV0010000000\nB1000013712345S00812345EV-012000000\n");
  REQUIRE(track);
  CHECK(track->at(0).position.latDeg < -37);
  CHECK(track->at(0).position.altM == 100);
  CHECK(track->at(1).position.altM == -120);
}

TEST_CASE("IGC: errors name the line") {
  CHECK(contains(messageOf(parseIgcTrack("A\nB100000\n")), "line 2: B record is cut short"));
  CHECK(contains(messageOf(parseIgcTrack("B2500003712345N00812345EA0010000000\n")), "line 1: B record has no time"));
  CHECK(contains(messageOf(parseIgcTrack("B1000003799345N00812345EA0010000000\n")), "no latitude"));
  CHECK(contains(messageOf(parseIgcTrack("B1000009912345N00812345EA0010000000\n")), "latitude 99"));
  CHECK(contains(messageOf(parseIgcTrack("B1000003712345N00812345QA0010000000\n")), "no longitude"));
  CHECK(contains(messageOf(parseIgcTrack("B1000003712345N00812345EA00100x0000\n")), "no altitudes"));
  CHECK(contains(messageOf(parseIgcTrack("HFDTE\n")), "no fixes"));
}

TEST_CASE("damaged CSV and IGC never crash nor give nonsense") {
  std::string csv = "time,lat,lon,alt,heading,pitch,roll\n";
  for (int i = 0; i < 8; ++i)
    csv += fmt::format("{},{},{},{},{},{},{}\n", i * 0.5, 47 + i * 1e-4, 11.0, 500 + i, 10 * i, i, -i);
  std::mt19937_64 random(13);
  const char alphabet[] = "0123456789.,-+eE\nnaif ";
  size_t read = 0;
  for (int i = 0; i < 30'000; ++i) {
    std::string text = i % 2 == 0 ? csv : kIgc;
    if (i % 3 == 0) damage(text, random);
    for (int k = 0; k < 3 && !text.empty(); ++k)
      text[random() % text.size()] = alphabet[random() % (sizeof(alphabet) - 1)];
    const auto track = i % 2 == 0 ? parseCsvTrack(text) : parseIgcTrack(text);
    if (!track) {
      REQUIRE_FALSE(track.error().message.empty());
      continue;
    }
    ++read;
    REQUIRE(plausible(*track));
  }
  CHECK(read > 1'000);
}

TEST_CASE("real IGC flights are read and fly plausibly") {
  const std::pair<const char*, size_t> files[] = {{"glider_australia_1s.igc", 7000},
                                                  {"glider_nimbus4_frenchalps_1hz.igc", 27000},
                                                  {"helicopter_germany_4s.igc", 900}};
  for (const auto& [name, atLeast] : files) {
    const std::string path = fmt::format("{}/tracks/igc/{}", eye::test::kTestData, name);
    const auto track = loadTrack(path);
    if (!track && track.error().kind == ErrorKind::notFound) {
      WARN("not tested: " << track.error().message);
      return;
    }
    INFO(name << ": " << messageOf(track));
    REQUIRE(track);
    CHECK(track->samples().size() >= atLeast);
    CHECK(plausible(*track));
    // No jump at 60 Hz: 150 m/s and 90 degrees/s are beyond what these aircraft do.
    for (double t = 0; t + 1.0 / 60 < std::min(track->durationS(), 1800.0); t += 1.0 / 60) {
      const Pose a = track->at(t), b = track->at(t + 1.0 / 60);
      REQUIRE(glm::length(ecefFromGeodetic(a.position) - ecefFromGeodetic(b.position)) < 150.0 / 60);
      REQUIRE(std::abs(a.rollDeg - b.rollDeg) < 1.5);
      REQUIRE(std::abs(a.pitchDeg - b.pitchDeg) < 1.5);
    }
  }
}

TEST_CASE("files: what is missing, a folder or too long is said with its path") {
  CHECK(contains(messageOf(loadTrack("/no/such.csv")), "'/no/such.csv' does not exist"));
  CHECK(contains(messageOf(loadTrack("/")), "'/' is not a file"));
  const auto path = std::filesystem::temp_directory_path() / "eyepoint_long_track.csv";
  std::ofstream(path) << "time,lat,lon,alt\n0,1,2,x\n";
  CHECK(contains(messageOf(loadTrack(path)), path.string() + "': line 2: alt 'x'"));
  std::filesystem::resize_file(path, kMaxTrackFileBytes + 1);  // sparse: takes no room
  CHECK(contains(messageOf(loadTrack(path)), "longer than 64 MiB"));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace eye

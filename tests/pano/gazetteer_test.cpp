// Lists of summits: what is read of each format, and that nothing else than an error with its line comes of garbage.
#include <random>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "pano/summit_fields.h"

namespace eye {
namespace {

constexpr const char* kCsv =
    "\xef\xbb\xbfHeight_m;Name;Country;Latitude;Longitude\r\n"
    "2655;\"Gerlachovsk\xc3\xbd \xc5\xa1t\xc3\xadt\";SK;49.1642;20.1339\r\n"
    "# a remark\r\n\r\n"
    ";\"The \"\"Nose\"\"; east\";SK;49.1;200\r\n";
constexpr const char* kGeoJson = R"({"type":"FeatureCollection","features":[
 {"type":"Feature","properties":{"name":"Rainier","ele":"4392 m"},"geometry":{"type":"Point","coordinates":[-121.76,46.85]}},
 {"type":"Feature","properties":{"name":"Nameless height","ele":"0"},"geometry":{"type":"Point","coordinates":[-121,46]}},
 {"type":"Feature","properties":{"name":"On the point"},"geometry":{"type":"Point","coordinates":[8,46,1234.5]}},
 {"type":"Feature","properties":{"ele":"12"},"geometry":{"type":"Point","coordinates":[8,46]}},
 {"type":"Feature","properties":{"name":"Beyond the pole"},"geometry":{"type":"Point","coordinates":[8,96]}},
 {"type":"Feature","properties":null,"geometry":null}, 7, []]})";
constexpr const char* kGeoNames =
    "2657891\tZermatt\tZermatt\t\t46.02126\t7.74912\tP\tPPL\tCH\t\tVS\t\t\t\t5643\t1608\t1621\tEurope/Zurich\t2013\n"
    "2659730\tMatterhorn\tMatterhorn\tCervino\t45.9763\t7.6586\tT\tPK\tCH\tIT\tVS\t\t\t\t0\t4478\t4395\tEurope/"
    "Zurich\t2"
    "013\n";
constexpr const char* kAlpano =
    "  7:25:12 45:08:25  1325  R0 E07 BA MONTE CURT\n"
    " 11:23:43 46:44:05  2405  I  F11 C7 HURLER\n";

Result<std::vector<Summit>> read(std::string_view text) {
  GazetteerDoubts doubts;
  return parseGazetteer(text, doubts);
}

std::string messageOf(const Result<std::vector<Summit>>& result) {
  REQUIRE_FALSE(result);
  CHECK(result.error().message.find('\n') == std::string::npos);
  return result.error().message;
}

}  // namespace

TEST_CASE("Gazetteer: each format by its looks") {
  const auto csv = read(kCsv);
  REQUIRE(csv);
  REQUIRE(csv->size() == 2);
  CHECK((*csv)[0].name == "Gerlachovsk\xc3\xbd \xc5\xa1t\xc3\xadt");
  CHECK((*csv)[0].heightM == 2655.0);
  CHECK((*csv)[0].lonDeg == 20.1339);
  CHECK((*csv)[1].name == "The \"Nose\"; east");
  CHECK_FALSE((*csv)[1].heightM);
  CHECK((*csv)[1].lonDeg == -160);

  const auto json = read(kGeoJson);
  REQUIRE(json);
  REQUIRE(json->size() == 3);
  CHECK((*json)[0].heightM == 4392.0);
  CHECK((*json)[0].latDeg == 46.85);
  CHECK_FALSE((*json)[1].heightM);
  CHECK((*json)[2].heightM == 1234.5);

  const auto names = read(kGeoNames);
  REQUIRE(names);
  REQUIRE(names->size() == 1);  // a town is no summit
  CHECK((*names)[0].name == "Matterhorn");
  CHECK((*names)[0].heightM == 4478.0);

  const auto alpano = read(kAlpano);
  REQUIRE(alpano);
  REQUIRE(alpano->size() == 2);
  CHECK((*alpano)[0].name == "MONTE CURT");
  CHECK((*alpano)[0].lonDeg == Approx(7.42));
  CHECK((*alpano)[0].latDeg == Approx(45.1402778));
  CHECK((*alpano)[1].name == "HURLER");
  CHECK((*alpano)[1].heightM == 2405.0);
}

TEST_CASE("Gazetteer: heights in metres and in feet, and none that is guessed") {
  for (const char* text : {"2655", " 2655 ", "2655 m", "2655m", "+2655.0", "2,655", "2,655 metres", "8710.63 ft",
                           "8,710.63'", "8710.63 Feet"}) {
    INFO(text);
    CHECK(heightFrom(text).value() == Approx(2655).margin(0.01));
  }
  for (const char* text : {"", "m", "~2655", "2655-2660", "2655;2660", "2655,5", "2655 yd", "nan", "1e3", "2 655"}) {
    INFO(text);
    CHECK_FALSE(heightFrom(text));
  }
  GazetteerDoubts doubts;
  const auto summits = parseGazetteer(
      R"({"features":[
 {"properties":{"name":"A","ele":"442 meters"},"geometry":{"coordinates":[8,46]}},
 {"properties":{"name":"B","ele":"8710 ft"},"geometry":{"coordinates":[8,46]}},
 {"properties":{"name":"C","ele":2655},"geometry":{"coordinates":[8,46]}},
 {"properties":{"name":"D","ele":"ca. 900"},"geometry":{"coordinates":[8,46]}},
 {"properties":{"name":"E","ele":"14411"},"geometry":{"coordinates":[8,46,0]}},
 {"properties":{"name":"F","ele":"","height":"12"},"geometry":{"coordinates":[8,46]}}]})",
      doubts);
  REQUIRE(summits);
  REQUIRE(summits->size() == 6);  // a summit with a height that cannot be read is still one
  CHECK((*summits)[0].heightM == 442.0);
  CHECK((*summits)[1].heightM.value() == Approx(2654.8).margin(0.1));
  CHECK((*summits)[2].heightM == 2655.0);
  CHECK_FALSE((*summits)[3].heightM);
  CHECK_FALSE((*summits)[4].heightM);
  CHECK((*summits)[5].heightM == 12.0);
  CHECK(doubts.heights == 2);
  CHECK(doubts.firstHeight == "ca. 900");
}

TEST_CASE("Gazetteer: of GeoNames' class T only what is a summit") {
  const auto row = [](const char* name, const char* code, const char* heightM) {
    return fmt::format("1\t{}\t{}\t\t46\t8\tT\t{}\tCH\t\t\t\t\t\t0\t{}\t900\tEurope/Zurich\t2013\n", name, name, code,
                       heightM);
  };
  std::string text;
  for (const char* code : {"VAL", "PASS", "PLN", "CAPE", "RDGE", "GRGE", "SLP", "CLF"}) text += row("no", code, "1200");
  for (const char* code : {"PK", "MT", "HLL", "VLC"}) text += row(code, code, "");
  for (const char* code : {"PKS", "MTS", "HLLS"}) text += row("range", code, "") + row(code, code, "1200");
  const auto summits = read(text);
  REQUIRE(summits);
  std::string names;
  for (const Summit& s : *summits) names += s.name + " ";
  CHECK(names == "PK MT HLL VLC PKS MTS HLLS ");
}

TEST_CASE("Gazetteer: what is wrong is said with its line") {
  CHECK(messageOf(read("")) == "it is empty");
  CHECK(messageOf(read("name,lat\nx,1\n")).find("line 1: no column 'lon'") == 0);
  CHECK(messageOf(read("name,lat,lon\nx,1,2\ny,north,2\n")).find("line 3: latitude 'north'") == 0);
  CHECK(messageOf(read("name,lat,lon\nx,nan,2\n")).find("line 2: ") == 0);
  CHECK(messageOf(read("name,lat,lon\nx,91,2\n")).find("line 2: latitude 91") == 0);
  CHECK(messageOf(read("name,lat,lon,ele\nx,46,8,12000\n")).find("line 2: height 12000") == 0);
  CHECK(messageOf(read("name,lat,lon\n")) == "there is not one named summit in it");
  CHECK(messageOf(read("{\"features\": [")).find("not valid JSON") != std::string::npos);
  CHECK(messageOf(read("{\"features\": 3}")).find("features") != std::string::npos);
  CHECK(messageOf(parseAlpanoGazetteer("  7:25:12 45:61:25  1325  R0 E07 BA X\n")).find("line 1: ") == 0);
  CHECK(messageOf(parseGeoNamesGazetteer("a\tb\n")).find("line 1: 2 columns") == 0);
  CHECK(messageOf(loadGazetteer("/nowhere/peaks.csv")).find("/nowhere/peaks.csv") != std::string::npos);
  CHECK(messageOf(loadGazetteer("/")).find("'/'") != std::string::npos);
}

TEST_CASE("Gazetteer: names are text that can be drawn") {
  CHECK(cleanName("  Piz\t\x01 Bernina \x7f") == "Piz Bernina");
  CHECK(cleanName("\xff\xc0\x80 \xed\xa0\x80 \xf0\x9f\x8f\x94") == "??? ??? \xf0\x9f\x8f\x94");
  CHECK(cleanName("\xc3") == "?");
  CHECK(cleanName(std::string(1000, 'x')).size() == kMaxNameBytes);
  CHECK(cleanName(fmt::format("{}\xc3\xa9", std::string(kMaxNameBytes - 1, 'x'))).size() ==
        kMaxNameBytes - 1);  // none is cut in two
}

TEST_CASE("Gazetteer: broken files of every format end in an error or in summits that are sound") {
  std::mt19937 chance(7);
  size_t read = 0, refused = 0;
  for (const char* seed : {kCsv, kGeoJson, kGeoNames, kAlpano}) {
    for (int i = 0; i < 3000; ++i) {
      std::string text = seed;
      for (int n = std::uniform_int_distribution(1, 8)(chance); n > 0; --n) {
        const std::string_view all = text;
        const auto at = [&] { return chance() % all.size(); };
        const std::string_view head = all.substr(0, at()), tail = all.substr(at()),
                               piece = all.substr(at(), chance() % 40);
        const char noise = static_cast<char>(chance());
        text = fmt::format("{}{}{}", head, chance() % 2 == 0 ? piece : std::string_view(&noise, 1), tail);
        if (text.empty()) text.assign(1, 'x');
      }
      const auto summits = eye::read(text);
      ++(summits ? read : refused);
      if (!summits) continue;
      for (const Summit& s : *summits) {
        REQUIRE(std::abs(s.latDeg) <= 90);
        REQUIRE(std::abs(s.lonDeg) <= 180);
        REQUIRE(s.heightM.value_or(0) <= 9000);
        REQUIRE(s.name == cleanName(s.name));
      }
    }
  }
  CHECK(read > 500);
  CHECK(refused > 1000);
}

}  // namespace eye

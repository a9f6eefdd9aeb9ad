#include "link/state_source.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "link/endpoint.h"
#include "link/scenario.h"
#include "support/places.h"

namespace eye {
namespace {

bool fails(const std::string& url, const std::string& part) {
  const auto source = openStateSource(url);
  if (source) return false;
  INFO(source.error().message);
  CHECK(exitStatus(source.error()) == 2);
  CHECK(source.error().message.find(part) != std::string::npos);
  return true;
}

TEST_CASE("a pose is six numbers in their ranges") {
  CHECK(*parsePose("49.25,20.1,2600,180,-5,10") == Pose{{49.25, 20.1, 2600}, 180, -5, 10});
  CHECK(*parsePose(" 1, -190 ,3,-90,90,180") == Pose{{1, 170, 3}, 270, 90, -180});
  const std::pair<const char*, const char*> bad[] = {{"", "six numbers"},
                                                     {"1,2,3,4,5", "six numbers"},
                                                     {"1,2,3,4,5,6,7", "six numbers"},
                                                     {"1,2,3,4,5,", "roll ''"},
                                                     {"x,2,3,4,5,6", "latitude 'x'"},
                                                     {"1,2,3,4m,5,6", "heading '4m'"},
                                                     {"90.1,2,3,4,5,6", "latitude 90.1"},
                                                     {"1,361,3,4,5,6", "longitude 361"},
                                                     {"1,2,-2000,4,5,6", "altitude -2000"},
                                                     {"1,2,3,400,5,6", "heading 400"},
                                                     {"1,2,3,4,91,6", "pitch 91"},
                                                     {"1,2,3,4,5,-361", "roll -361"},
                                                     {"nan,2,3,4,5,6", "latitude 'nan'"},
                                                     {"1,2,inf,4,5,6", "altitude 'inf'"},
                                                     {"1,2,1e9,4,5,6", "altitude"}};
  for (const auto& [text, part] : bad) {
    const auto pose = parsePose(text);
    INFO(text);
    REQUIRE_FALSE(pose);
    INFO(pose.error().message);
    CHECK(pose.error().kind == ErrorKind::usage);
    CHECK(pose.error().message.find(part) != std::string::npos);
  }
}

TEST_CASE("URLs that are none are said so") {
  CHECK(fails("", "none of native-fdm://"));
  CHECK(fails("demo", "none of"));
  CHECK(fails("gopher://x", "none of"));
  CHECK(fails("native-fdm://", "port"));
  CHECK(fails("native-fdm://1.2.3.4", "port"));
  CHECK(fails("native-fdm://:0", "port"));
  CHECK(fails("native-fdm://:70000", "port"));
  CHECK(fails("native-fdm://::1:5550", "IPv4"));
  CHECK(fails("native-fdm://300.1.1.1:5550", "300.1.1.1"));
  CHECK(fails("demo://nothing", "there are: takeoff"));
  CHECK(fails("pose://1,2,3", "six numbers"));
  CHECK_FALSE(openStateSource("file:///no/such/track.csv"));
}

TEST_CASE("an address without a host name is the loopback") {
  CHECK(*parseEndpoint("5550", kLoopbackAddress, "x") == Endpoint{"127.0.0.1", 5550});
  CHECK(*parseEndpoint(":5550", kLoopbackAddress, "x") == Endpoint{"127.0.0.1", 5550});
  CHECK(*parseEndpoint("0.0.0.0:1", kLoopbackAddress, "x") == Endpoint{"0.0.0.0", 1});
}

TEST_CASE("a fixed pose never ends, a scenario does") {
  const auto fixed = openStateSource("pose://1,2,3,4,5,6");
  REQUIRE(fixed);
  CHECK((*fixed)->isFixed());
  const SourceSample still = (*fixed)->sample(1e6);
  CHECK((still.valid && !still.live && !still.finished && still.arrivedNs == 0));
  CHECK(still.pose == Pose{{1, 2, 3}, 4, 5, 6});

  const auto demo = openStateSource("demo://");
  REQUIRE(demo);
  CHECK_FALSE((*demo)->isFixed());
  CHECK_FALSE((*demo)->isLive());
  CHECK_FALSE((*demo)->sample(89).finished);
  CHECK((*demo)->sample(90).finished);
  CHECK((*demo)->sample(10).pose == findScenario(kDefaultScenario)->poseAt(10));
  CHECK((*openStateSource("demo://orbit"))->sample(5).pose == findScenario("orbit")->poseAt(5));
}

TEST_CASE("a recording is flown at its own time") {
  const auto source = openStateSource("file://" + eye::test::kTestData + "/captures/jsbsim_c1723_takeoff.pcap");
  if (!source) {
    WARN("not tested: " << source.error().message);
    return;
  }
  CHECK_FALSE((*source)->sample(109).finished);
  CHECK((*source)->sample(111).finished);
  // Packet 3000 of the capture, 49.9823 s in.
  const Pose pose = (*source)->sample(1795338868.4765368 - 1795338818.4762886).pose;
  CHECK(pose.position.latDeg == Approx(29.752247481937736).margin(1e-8));
  CHECK(pose.position.altM == Approx(85.04736599297226).margin(1e-3));
  CHECK(pose.headingDeg == Approx(199.80).margin(0.02));
}

}  // namespace
}  // namespace eye

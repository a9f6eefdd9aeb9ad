// eyepoint-host: a host that flies an image generator with a recording, a scenario or a fixed pose.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>

#include "base/command_line.h"
#include "base/version.h"
#include "link/cigi_host.h"
#include "link/host_lockstep.h"
#include "link/reply_text.h"
#include "link/scenario.h"
#include "link/sender.h"
#include "link/state_source.h"
#include "link/udp_group.h"
#include "ticker.h"

namespace {

using namespace eye;

struct Arguments {
  std::string protocol, to, interface, track, scenario, pose, cigiVersion, logLevel = "info";
  bool synchronous = false, printReplies = false;
  std::optional<int> channels;
  std::vector<std::string> ask;
  std::optional<int> askEvery;
  cigi::AskPlan plan;            // what `ask` says, and how often
  std::optional<double> rateHz;  // unset: 60, and no limit with --synchronous
  SendOptions send;
};

std::atomic<bool> stopAsked = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set in a signal handler");

void onSignal(int) {
  stopAsked = true;
}

std::string scenarioNames() {
  std::string names;
  for (const Scenario& scenario : scenarios()) names += (names.empty() ? "" : ", ") + scenario.name;
  return names;
}

void declareOptions(CLI::App& app, Arguments& args) {
  app.add_option("--protocol", args.protocol, "What to speak: native-fdm or cigi")->type_name("NAME")->required();
  app.add_option("--cigi-version", args.cigiVersion, "Of CIGI: 3.3 (default) or 4.0")->type_name("V");
  app.add_flag("--synchronous", args.synchronous, "CIGI: one message for each Start of Frame, --rate a second at most");
  app.add_option(
         "--channels", args.channels,
         "CIGI, synchronous: the next message when so many channels have shown the last one (a group's, 1 to 64)")
      ->type_name("N");
  app.add_option("--to", args.to, "Where to send")->type_name("ADDR:PORT")->required();
  app.add_option("--interface", args.interface, "By which network interface a multicast group is sent to: its address")
      ->type_name("ADDR");
  auto* what = app.add_option_group("What to fly (one of)");
  what->add_option("--track", args.track, "Recording: CSV, IGC, or a pcap, which is sent packet by packet as recorded")
      ->type_name("FILE");
  what->add_option("--scenario", args.scenario, "Built-in flight: " + scenarioNames())->type_name("NAME");
  what->add_option("--pose", args.pose, "Stand still at lat,lon,alt,heading,pitch,roll")->type_name("P");
  what->require_option(1);
  app.add_option("--rate", args.rateHz, "Packets a second; default 60")->type_name("HZ");
  app.add_option("--duration", args.send.durationS, "Stop after this many seconds")->type_name("S");
  app.add_flag("--loop", args.send.loop, "Begin again at the end");
  auto* ground = app.add_option_group("Questions to the image generator (CIGI)");
  ground
      ->add_option("--ask", args.ask,
                   "What is asked about the aircraft, repeatable: hat (its height above terrain), hot (the terrain's "
                   "height), hat-hot (both, and the slope), los (what is ahead within 20 km), los-extended (and where)")
      ->type_name("hat/hot/hat-hot/los/los-extended");
  ground
      ->add_option("--ask-every", args.askEvery,
                   "Update period of these requests, host frames: 1 asks in each, 255 at most; default 60")
      ->type_name("FRAMES");
  ground->add_flag("--print-replies", args.printReplies, "A line for each Start of Frame and each answer");
  auto* bad = app.add_option_group("A bad link");
  bad->add_option("--jitter", args.send.badLink.jitterMs, "Delay each packet by 0 to MS")->type_name("MS");
  bad->add_option("--loss", args.send.badLink.loss, "Share of packets not sent, 0 to 1")->type_name("P");
  bad->add_option("--duplicate", args.send.badLink.duplicate, "Share sent twice")->type_name("P");
  bad->add_option("--reorder", args.send.badLink.reorder, "Share sent after its successor")->type_name("P");
  bad->add_option("--seed", args.send.badLink.seed, "Of the bad link's chance")->capture_default_str();
  app.add_option("--log-level", args.logLevel, "What is printed")
      ->check(CLI::IsMember({"trace", "debug", "info", "warn", "error", "off"}))
      ->capture_default_str();
  app.set_version_flag("--version", versionLine("eyepoint-host"));
  app.footer(
      "Examples:\n"
      "  eyepoint-host --protocol native-fdm --to 127.0.0.1:5550 --scenario low-level --loop\n"
      "  eyepoint-host --protocol native-fdm --to 127.0.0.1:5550 --track flight.pcap\n"
      "  eyepoint-host --protocol cigi --cigi-version 4.0 --to 127.0.0.1:8000 --scenario orbit --synchronous\n"
      "  eyepoint-host --protocol cigi --to 127.0.0.1:8000 --scenario low-level --ask hat-hot,los --print-replies\n"
      "  eyepoint-host --protocol cigi --to 239.255.69.89:8000 --scenario low-level --loop --synchronous --channels 3\n"
      "  eyepoint-host --protocol native-fdm --to 10.0.0.2:5550 --track glider.igc --jitter 20 --loss 0.01");
}

bool speaksCigi(const Arguments& args) {
  return args.protocol == "cigi";
}

cigi::Version versionOf(const Arguments& args) {
  return args.cigiVersion == "4.0" ? cigi::Version{4, 0} : cigi::Version{3, 3};
}

Result<void> check(const Arguments& args) {
  if (args.protocol != "native-fdm" && !speaksCigi(args))
    return fail(ErrorKind::usage,
                fmt::format("--protocol '{}' is not spoken; there are: native-fdm, cigi", args.protocol));
  if (!args.cigiVersion.empty() && !speaksCigi(args))
    return fail(ErrorKind::usage, "--cigi-version needs --protocol cigi");
  if (!args.cigiVersion.empty() && args.cigiVersion != "3.3" && args.cigiVersion != "4.0")
    return fail(ErrorKind::usage, fmt::format("--cigi-version '{}' is neither 3.3 nor 4.0", args.cigiVersion));
  if (args.synchronous && !speaksCigi(args))
    return fail(ErrorKind::usage, "--synchronous needs --protocol cigi: native-fdm has no answers to wait for");
  if (args.rateHz && !(*args.rateHz >= 0.1 && *args.rateHz <= 10'000))
    return fail(ErrorKind::usage, fmt::format("--rate {} is outside 0.1 to 10000 Hz", *args.rateHz));
  if (args.send.durationS && !(*args.send.durationS > 0 && *args.send.durationS <= 1e7))
    return fail(ErrorKind::usage, fmt::format("--duration {} is outside 0 to 10000000 s", *args.send.durationS));
  const bool asks = !args.ask.empty() || args.printReplies;
  if (asks && !speaksCigi(args))
    return fail(ErrorKind::usage, "--ask and --print-replies need --protocol cigi: native-fdm has no answers");
  if (args.askEvery && args.ask.empty())
    return fail(ErrorKind::usage, "--ask-every needs --ask: it says how often that is asked");
  if (args.askEvery && (*args.askEvery < 1 || *args.askEvery > 255))
    return fail(ErrorKind::usage, fmt::format("--ask-every {} is outside 1 to 255 host frames", *args.askEvery));
  if (args.channels && !args.synchronous)
    return fail(ErrorKind::usage, "--channels needs --synchronous: without it no answer is waited for");
  constexpr int kMostChannels = 64;
  if (args.channels && (*args.channels < 1 || *args.channels > kMostChannels))
    return fail(ErrorKind::usage, fmt::format("--channels {} is outside 1 to {}", *args.channels, kMostChannels));
  return checkBadLink(args.send.badLink);
}

// One address is one channel: several hear a group.
Result<void> checkChannels(const Arguments& args, const Endpoint& to) {
  const auto place = resolvePeer(to);
  if (!place || args.channels.value_or(1) == 1 || reachOf(place->address) != Reach::one) return {};
  return fail(ErrorKind::usage, fmt::format("--channels {} needs --to a multicast group or broadcast address, such as "
                                            "239.255.69.89:8000; {} is one channel",
                                            *args.channels, args.to));
}

// What is flown: a function of time, or a capture of the protocol itself, whose packets go out as they were recorded.
struct Flight {
  std::function<Pose(double timeS)> poseAt;
  double durationS = 0;
  std::vector<RecordedPacket> packets;
};

Result<Flight> recordedFlight(const Arguments& args) {
  const auto bytes = readTrackFile(args.track);
  if (!bytes) return tl::unexpected(bytes.error());
  if (isCapture(*bytes)) {
    const auto spoken = speaksCigi(args) ? RecordedProtocol::cigi : RecordedProtocol::nativeFdm;
    const auto protocol = protocolOf(*bytes);
    if (!protocol)
      return fail(protocol.error().kind, fmt::format("track '{}': {}", args.track, protocol.error().message));
    if (*protocol == spoken && !args.synchronous) {
      if (!args.ask.empty())
        return fail(ErrorKind::usage,
                    fmt::format("--ask: the packets of '{}' go out as they were recorded; --synchronous flies their "
                                "path instead and asks",
                                args.track));
      auto packets = parsePcapPackets(*bytes, spoken);
      if (!packets)
        return fail(packets.error().kind, fmt::format("track '{}': {}", args.track, packets.error().message));
      return Flight{{}, 0, std::move(*packets)};
    }
  }
  auto track = loadTrack(args.track);
  if (!track) return tl::unexpected(track.error());
  const double durationS = track->durationS();
  return Flight{[track = std::move(*track)](double t) { return track.at(t); }, durationS, {}};
}

Result<Flight> flightOf(const Arguments& args) {
  if (!args.scenario.empty()) {
    const auto scenario = findScenario(args.scenario);
    if (!scenario) return tl::unexpected(scenario.error());
    return Flight{scenario->poseAt, scenario->durationS, {}};
  }
  if (args.pose.empty()) return recordedFlight(args);
  const auto pose = parsePose(args.pose);
  if (!pose) return tl::unexpected(pose.error());
  return Flight{[pose = *pose](double) { return pose; }, 0, {}};
}

SendReport send(const Arguments& args, Flight flight, const UdpSocket& socket, cigi::ReplyListener* replies) {
  Ticker ticker(args.to, replies);
  const double rateHz = args.rateHz.value_or(60);
  if (!flight.packets.empty())
    return sendPackets(packetsFromRecording(std::move(flight.packets)), socket, args.send, stopAsked, ticker);
  if (!speaksCigi(args))
    return sendPackets(packetsFromPoses(flight.poseAt, flight.durationS, rateHz), socket, args.send, stopAsked, ticker);
  const auto igFrame = [replies] { return replies->igFrame(); };
  if (!args.synchronous)
    return sendPackets(
        cigiPacketsFromPoses(flight.poseAt, flight.durationS, rateHz, versionOf(args), igFrame, args.plan), socket,
        args.send, stopAsked, ticker);
  const auto messageOf = [&](uint32_t frame, double timeS) -> std::optional<std::vector<std::byte>> {
    if (timeS > flight.durationS && !args.send.loop) return std::nullopt;
    const double atS = flight.durationS > 0 ? std::fmod(timeS, flight.durationS) : 0;
    return cigi::hostMessage(versionOf(args),
                             {frame, igFrame(), timeS, flight.poseAt(atS), cigi::requestsAt(args.plan, frame)});
  };
  const double leastS = args.rateHz ? 1 / *args.rateHz : 0;
  if (args.channels) {
    cigi::Lockstep lockstep(*replies, static_cast<size_t>(*args.channels), messageOf);
    const auto next = [&](double timeS, bool demanded) { return lockstep.packetAt(timeS, demanded); };
    const auto await = [&](int timeoutMs) { return lockstep.await(timeoutMs); };
    return sendOnDemand({next, await, leastS, cigi::kResendS}, socket, args.send, stopAsked, ticker);
  }
  uint32_t number = 0;
  const auto next = [&](double timeS, bool) { return messageOf(++number, timeS); };
  const auto await = [replies](int timeoutMs) { return replies->awaitStart(timeoutMs); };
  return sendOnDemand({next, await, leastS}, socket, args.send, stopAsked, ticker);
}

// A line each; with several channels, by the channel. The listener's thread.
void printReplies(const Peer& sender, const cigi::Message& message) {
  for (const cigi::Packet& packet : message.packets)
    if (const std::string line = cigi::textOf(packet); !line.empty()) spdlog::info("{}: {}", toText(sender), line);
}

int fly(Arguments args) {
  if (const auto ok = check(args); !ok) return complain("eyepoint-host", ok.error());
  const auto asks = cigi::parseAsks(args.ask);
  if (!asks) return complain("eyepoint-host", asks.error());
  args.plan.asks = *asks;
  args.plan.everyFrames = args.askEvery.value_or(args.plan.everyFrames);
  args.plan.firstFrame = args.synchronous ? 1 : 0;
  const auto endpoint = parseEndpoint(args.to, kLoopbackAddress, "--to");
  if (!endpoint) return complain("eyepoint-host", endpoint.error());
  if (const auto ok = checkChannels(args, *endpoint); !ok) return complain("eyepoint-host", ok.error());
  auto flight = flightOf(args);
  if (!flight) return complain("eyepoint-host", flight.error());
  const auto socket = UdpSocket::connectTo(*endpoint, args.interface);
  if (!socket) return complain("eyepoint-host", socket.error());
  std::optional<cigi::ReplyListener> replies;
  const auto channels = static_cast<size_t>(args.channels.value_or(1));
  if (speaksCigi(args))
    replies.emplace(*socket, channels, args.printReplies ? printReplies : cigi::ReplyListener::OnMessage());

  if (!args.pose.empty()) args.send.loop = true;  // one pose is a round of one packet
  spdlog::info("sending {} to {}:{}", args.protocol, endpoint->address, endpoint->port);
  const SendReport report = send(args, std::move(*flight), *socket, replies ? &*replies : nullptr);
  spdlog::info("{} packets in {:.2f} s: {} datagrams sent, {} lost on purpose, {} duplicated, {} failed",
               report.packets, report.elapsedS, report.datagrams, report.lost, report.duplicated, report.failed);
  if (replies) {
    const cigi::HeardReplies heard = replies->heard();
    spdlog::info(
        "{} Starts of Frame, {} overframing, {} paging; {} answers of height, {} of line of sight; {} datagrams not "
        "understood",
        heard.starts, heard.overframings, heard.pagings, heard.heights, heard.sights, heard.notUnderstood);
  }
  if (report.failed == 0) return 0;
  return complain("eyepoint-host",
                  {ErrorKind::io, fmt::format("{} datagrams could not be sent to {}; check the network and the address",
                                              report.failed, args.to)});
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Flies an image generator over UDP: recordings, built-in scenarios or a fixed pose.", "eyepoint-host");
  Arguments args;
  declareOptions(app, args);
  if (const std::optional<int> status = parseArguments(app, argc, argv)) return *status;
  spdlog::set_level(spdlog::level::from_str(args.logLevel));
  spdlog::set_pattern("%v");
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
  return fly(std::move(args));
}

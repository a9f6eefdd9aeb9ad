// What Wireshark says of a packet, and running it: the judge of what is sent.
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "link/text_lines.h"
#include "packets.h"

namespace eye::test {

struct Dissected {
  std::string name;
  std::map<std::string, double> fields;  // by Wireshark's labels; flags and enumerations as numbers
  size_t frame = 0;                      // in the capture, from 1
};

// "Operate (1)" is 1, "16000" is 16000, "0x0080" is 128, "Little-Endian (0x0080)" is 128.
inline std::optional<double> numberIn(const std::string& text) {
  const size_t bracket = text.rfind('(');
  const std::string number =
      bracket == std::string::npos || bracket + 1 == text.size() ? text : text.substr(bracket + 1);
  char* end = nullptr;
  const double value = std::strtod(number.c_str(), &end);
  if (end == number.c_str()) return std::nullopt;
  return value;
}

// The packets in a text of tshark -V, between lines of four blanks ("    NAME (24 bytes)") with fields of eight.
inline std::vector<Dissected> dissectedPackets(std::string_view text) {
  std::vector<Dissected> packets;
  bool inPacket = false;
  size_t frame = 0;
  TextLines lines(text);
  while (const auto next = lines.next()) {
    const std::string line(*next);
    if (!line.starts_with("        ")) {
      if (line.starts_with("Frame ")) frame = std::stoul(line.substr(6));
      inPacket = line.starts_with("    ") && line.ends_with(" bytes)") && !line.starts_with("    UDP payload");
      if (inPacket) packets.push_back({line.substr(4, line.rfind(" (") - 4), {}, frame});
      continue;
    }
    if (!inPacket) continue;
    const std::string field = line.substr(8);
    const size_t colon = field.find(": ");
    if (colon == std::string::npos) continue;
    const size_t equals = field.find(" = ");
    if (equals != std::string::npos && equals < colon) {  // ".... .1.. = Label: word"
      double value = 0;
      for (const char c : field.substr(0, equals))
        if (c == '0' || c == '1') value = value * 2 + (c - '0');
      packets.back().fields[field.substr(equals + 3, colon - equals - 3)] = value;
    } else if (const auto value = numberIn(field.substr(colon + 2))) {
      packets.back().fields[field.substr(0, colon)] = *value;
    }
  }
  return packets;
}

// The frames of a capture, each as its UDP payload's dissection. Nothing where there is no tshark.
inline std::optional<std::string> tsharkVerbose(const Bytes& capture, const std::string& decodeAs,
                                                const std::string& protocol) {
  const auto path =
      std::filesystem::temp_directory_path() / ("eyepoint_dissect_" + std::to_string(::getpid()) + ".pcap");
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(capture.data()), static_cast<std::streamsize>(capture.size()));
  const std::string command = "tshark -r " + path.string() + " -d " + decodeAs + " -V -O " + protocol + " 2>/dev/null";
  FILE* const pipe = ::popen(command.c_str(), "r");
  std::string text;
  char buffer[4096];
  while (pipe != nullptr) {
    const size_t count = std::fread(buffer, 1, sizeof buffer, pipe);
    if (count == 0) break;
    text.append(buffer, count);
  }
  const int status = pipe == nullptr ? -1 : ::pclose(pipe);
  std::filesystem::remove(path);
  if (status != 0) return std::nullopt;
  return text;
}

// A capture of these payloads, each sent to the port.
inline Bytes captureOf(const std::vector<Bytes>& payloads, uint16_t port) {
  PcapWriter writer(101);
  int64_t timeNs = 0;
  for (const Bytes& payload : payloads) writer.add(timeNs += 1'000'000, ipPacket(payload, port));
  return writer.bytes;
}

}  // namespace eye::test

#include "ticker.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "link/reply_text.h"

namespace eye {

void Ticker::operator()(const SendReport& report) {
  const double sinceS = report.elapsedS - elapsedS_;
  const double rateHz = static_cast<double>(report.datagrams - datagrams_) / sinceS;
  datagrams_ = report.datagrams, elapsedS_ = report.elapsedS;
  std::string position = "nothing sent yet";
  if (const auto& pose = report.pose)
    position = fmt::format("{:.6f} {:.6f} {:.1f} m, heading {:.1f} pitch {:.1f} roll {:.1f}", pose->position.latDeg,
                           pose->position.lonDeg, pose->position.altM, pose->headingDeg, pose->pitchDeg, pose->rollDeg);
  spdlog::info("{:6.1f} s, {} packets, {:.1f} Hz, {}{}{}", report.elapsedS, report.datagrams, rateHz, position,
               report.nobodyListens ? fmt::format(" (nobody listens at {} yet)", to_) : "", answers(sinceS));
}

std::string Ticker::answers(double sinceS) {
  if (replies_ == nullptr) return "";
  const cigi::HeardReplies heard = replies_->heard();
  const double rateHz = static_cast<double>(heard.starts - starts_) / sinceS;
  starts_ = heard.starts;
  if (heard.starts == 0) return "; no Start of Frame yet";
  const cigi::StartOfFrame& start = heard.newest;
  const size_t channels = replies_->channels().known();
  return fmt::format("; Start of Frame {:.1f} Hz{}, frame {}, mode {}, database {}{}{}; {} heights, {} sights", rateHz,
                     channels > 1 ? fmt::format(" of {} channels", channels) : "", start.igFrame,
                     cigi::textOf(start.mode), start.databaseNumber, start.overframing ? ", overframing" : "",
                     start.paging ? ", paging" : "", heard.heights, heard.sights);
}

}  // namespace eye

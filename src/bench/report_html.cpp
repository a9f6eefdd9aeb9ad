#include <algorithm>

#include <fmt/format.h>

#include "bench/report.h"

namespace eye {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --ink: #1c2733; --soft: #5b6b7b; --line: #d8dfe6; --page: #fbfcfd; --card: #fff;
  --good: #1f7a4d; --bad: #b4442a; --link: #0b62a8; --theirs: #f3f0e6; --shade: #1c273340; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e9ee; --soft: #9aa8b5; --line: #33404c; --page: #151b21;
  --card: #1c242c; --good: #58c48d; --bad: #ef8a6d; --link: #7cbcf0; --theirs: #2a2a22; --shade: #000a; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--page); margin: 0; }
main { max-width: 1240px; margin: 0 auto; padding: 2rem 1.2rem 4rem; }
h1 { font-size: 1.7rem; margin: 0 0 .2rem; } h2 { margin: 3rem 0 .3rem; font-size: 1.35rem; }
p { max-width: 75ch; } .soft { color: var(--soft); }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .1rem 1rem; margin: 1rem 0; }
dt { color: var(--soft); } dd { margin: 0; }
figure { margin: 1.4rem 0; padding: .9rem 1rem; background: var(--card); border: 1px solid var(--line);
  border-radius: 8px; overflow-x: auto; }
/* A table that is wider than the page keeps its first column in view, and has a shadow where it goes on. */
figure:has(table) { background: linear-gradient(to left, var(--card) 60%, transparent) right / 48px 100% no-repeat local,
  linear-gradient(to left, var(--shade), transparent) right / 16px 100% no-repeat scroll, var(--card); }
figure th:first-child:not(.group), figure td:first-child { position: sticky; left: -1rem; padding-left: 1rem; background: var(--card); }
figcaption { font-weight: 600; margin-bottom: .5rem; }
table { font-size: .88em; border-collapse: collapse; font-variant-numeric: tabular-nums; width: 100%; }
th, td { padding: .22rem .38rem; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--line); }
th:first-child, td:first-child { text-align: left; }
th { font-weight: 600; color: var(--soft); } th.group { text-align: center; border-left: 1px solid var(--line); }
ul.targets { list-style: none; padding: 0; } ul.targets li::before { display: inline-block; width: 1.4em; }
li.reached::before { content: "\2713"; color: var(--good); } li.missed::before { content: "\2717"; color: var(--bad); }
svg { width: 100%; height: auto; display: block; } svg text { fill: var(--soft); font: 12px system-ui, sans-serif; }
@media (prefers-color-scheme: dark) { svg :is(polyline, circle, rect) { filter: brightness(1.35); } }
svg .axis { stroke: var(--line); } svg .legend { fill: var(--ink); }
li { margin: .25rem 0; } a { color: var(--link); } section { scroll-margin-top: 1rem; }
th.theirs, td.theirs, tr.theirs td { background: var(--theirs); color: var(--soft); font-style: italic; }
nav { margin: 1.6rem 0; } nav h2 { margin: 0 0 .4rem; } nav table { width: auto; }
nav td:last-child { text-align: left; } span.reached { color: var(--good); } span.missed { color: var(--bad); }
)";

// Which of a table's columns are published figures: their group's name says so, or their own.
std::vector<bool> publishedColumns(const ReportTable& table) {
  std::vector<bool> published(table.columns.size(), false);
  size_t at = 0;
  for (const ReportTable::Group& group : table.groups)
    for (size_t i = 0; i < group.columns && at < published.size(); ++i, ++at)
      published[at] = group.name.find("published") != std::string::npos;
  for (size_t i = 0; i < published.size(); ++i)
    if (table.columns[i].find("published") != std::string::npos) published[i] = true;
  return published;
}

std::string cells(const std::vector<std::string>& texts, const char* tag, const std::vector<bool>& published) {
  std::string html;
  for (size_t i = 0; i < texts.size(); ++i)
    html += fmt::format("<{0}{2}>{1}</{0}>", tag, escapeHtml(texts[i]),
                        i < published.size() && published[i] ? " class=\"theirs\"" : "");
  return html;
}

std::string tableHtml(const ReportTable& table) {
  const std::vector<bool> published = publishedColumns(table);
  std::string html = fmt::format("<figure><figcaption>{}</figcaption><table><thead>", escapeHtml(table.caption));
  if (!table.groups.empty()) {
    html += "<tr>";
    for (const ReportTable::Group& group : table.groups)
      html += fmt::format("<th class=\"group\" colspan=\"{}\">{}</th>", group.columns, escapeHtml(group.name));
    html += "</tr>";
  }
  html += "<tr>" + cells(table.columns, "th", published) + "</tr></thead><tbody>\n";
  for (const std::vector<std::string>& row : table.rows) {
    const bool isPublished = !row.empty() && row.front().starts_with("published");
    html += fmt::format("<tr{}>{}</tr>\n", isPublished ? " class=\"theirs\"" : "", cells(row, "td", published));
  }
  return html + "</tbody></table></figure>\n";
}

std::string suiteHtml(const SuiteReport& suite) {
  std::string html = fmt::format("<section id=\"{}\"><h2>{}</h2>\n<p>{}</p>\n", escapeHtml(suite.name),
                                 escapeHtml(suite.title), escapeHtml(suite.introduction));
  if (!suite.targets.empty()) {
    html += "<ul class=\"targets\">\n";
    for (const ReportTarget& target : suite.targets)
      html += fmt::format("<li class=\"{}\">{}: <strong>{}</strong></li>\n", target.isReached ? "reached" : "missed",
                          escapeHtml(target.what), escapeHtml(target.measured));
    html += "</ul>\n";
  }
  for (const ReportPlot& plot : suite.plots)
    html += fmt::format("<figure><figcaption>{}</figcaption>{}</figure>\n", escapeHtml(plot.title), plotSvg(plot));
  for (const ReportTable& table : suite.tables) html += tableHtml(table);
  if (!suite.notes.empty()) {
    html += "<ul class=\"soft\">\n";
    for (const std::string& note : suite.notes) html += "<li>" + escapeHtml(note) + "</li>\n";
    html += "</ul>\n";
  }
  return html + "<p><a href=\"#contents\">Contents</a></p></section>\n";
}

// "3 of 4" with the sign that the list of targets has.
std::string reachedHtml(const SuiteReport& suite) {
  if (suite.targets.empty()) return "";
  const auto reached = std::ranges::count_if(suite.targets, &ReportTarget::isReached);
  const bool all = static_cast<size_t>(reached) == suite.targets.size();
  return fmt::format("<span class=\"{}\">{} of {} aims reached</span>", all ? "reached" : "missed", reached,
                     suite.targets.size());
}

std::string contentsHtml(const Report& report) {
  std::string html = "<nav id=\"contents\"><h2>Contents</h2>\n<table><tbody>\n";
  for (const SuiteReport& suite : report.suites)
    html += fmt::format("<tr><td><a href=\"#{}\">{}</a></td><td>{}</td></tr>\n", escapeHtml(suite.name),
                        escapeHtml(suite.title), reachedHtml(suite));
  return html + "</tbody></table></nav>\n";
}

std::string speedText(const MachineSpeed& speed) {
  return fmt::format("loop {:.1f} ms", speed.loopMs) +
         (speed.drawMs ? fmt::format(", frame {:.2f} ms", *speed.drawMs) : "");
}

}  // namespace

std::string escapeHtml(const std::string& text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string reportHtml(const Report& report) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>Eyepoint benchmark</title>\n"
      "<style>{}</style></head>\n<body><main><h1>Eyepoint benchmark</h1>\n<dl>",
      kStyle);
  const auto line = [&](const char* name, const std::string& value) {
    html += fmt::format("<dt>{}</dt><dd>{}</dd>", name, escapeHtml(value));
  };
  line("Machine", report.machine);
  line("Device", report.device);
  line("Commit", report.commit);
  line("Settings", report.settings);
  if (!report.suites.empty()) line("Speed reference", speedText(report.suites.front().speed));
  html +=
      "</dl>\n<p class=\"soft\">Marked columns and rows are published figures, of other machines and other data: "
      "compare ratios within a report, not figures between them. The speed reference is CPU time of fixed work; it "
      "tells a slow machine from slow code.</p>\n";
  html += contentsHtml(report);
  for (const SuiteReport& suite : report.suites) html += suiteHtml(suite);
  return html + "</main></body></html>\n";
}

}  // namespace eye

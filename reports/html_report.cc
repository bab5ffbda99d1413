#include "reports/html_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "algorithms/ports/assert.h"
#include "recording/version.h"
#include "reports/html_comparison.h"
#include "reports/html_figures.h"
#include "reports/html_tables.h"
#include "reports/html_text.h"
#include "reports/web_files.h"

namespace simbench::reports {
namespace {

using Json = nlohmann::ordered_json;

// As a POSIX shell takes it.
std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-+=:,./@%") == std::string::npos;
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c;
    }
  }
  return quoted + "'";
}

// Whatever the program's path was, its user calls it simbench.
std::string shell_line(const std::vector<std::string>& command) {
  std::string line = "simbench";
  for (std::size_t i = 1; i < command.size(); ++i) {
    line += fmt::format(" {}", shell_word(command[i]));
  }
  return line;
}

std::string seeds_text(const evaluation::Results& results) {
  if (results.seed_count == 1) return fmt::format("1 seed ({})", results.first_seed);
  return fmt::format("{} seeds ({} to {})", results.seed_count, results.first_seed,
                     results.first_seed + results.seed_count - 1);
}

// A member of the resolved scenario; `otherwise` where the archive holds none.
std::string scenario_text(const Archive& archive, const char* pointer) {
  if (archive.scenario_json.empty()) return "";
  return Json::parse(archive.scenario_json).value(Json::json_pointer(pointer), std::string());
}

std::string paragraph(const std::string& style, const std::string& text) {
  if (text.empty()) return "";
  return fmt::format("<p class=\"{}\">{}</p>\n", style, html_escaped(text));
}

std::string provenance_line(const Archive& archive) {
  std::string line = fmt::format("{} of simbench {} ({})", seeds_text(archive.results),
                                 archive.version, archive.commit);
  if (!archive.started.empty()) {
    line += fmt::format(", run from {} to {}", archive.started, archive.finished);
  }
  return line;
}

std::string notes_list(const std::vector<std::string>& notes) {
  if (notes.empty()) return "";
  std::string items;
  for (const std::string& note : notes) {
    items += fmt::format("<li>{}</li>\n", html_escaped(note));
  }
  return fmt::format("<ul class=\"notes\" aria-label=\"notes\">\n{}</ul>\n", items);
}

std::string commands_of(const ReportedArchive& reported, const ReportInput& input) {
  const Archive& archive = reported.archive;
  std::string lines;
  const auto add = [&lines](std::string_view what, const std::string& command) {
    lines += fmt::format("<dt>{}</dt><dd><pre class=\"scroll\" tabindex=\"0\">{}</pre></dd>\n",
                         what, html_escaped(command));
  };
  if (!archive.command.empty()) add("The results", shell_line(archive.command));
  add("This report", shell_line(input.command));
  if (!reported.figures.empty()) {
    add("One figure alone, for a paper",
        fmt::format("simbench figure {} {} -o {}.svg", reported.figures.front().id,
                    shell_word(archive.path), reported.figures.front().id));
  }
  return fmt::format("<dl>\n{}</dl>\n", lines);
}

std::string scenario_details(const Archive& archive) {
  if (archive.scenario_json.empty()) {
    return "<p>A results.json alone holds neither the scenario nor the command that ran it.</p>\n";
  }
  return fmt::format(
      "<details><summary>The resolved scenario</summary>\n<p>Saved to a file, it repeats the run: "
      "<code>simbench run --scenario FILE --seeds {} --first-seed {}</code></p>\n"
      "<pre class=\"scroll\" tabindex=\"0\">{}</pre>\n</details>\n",
      archive.results.seed_count, archive.results.first_seed,
      html_escaped(Json::parse(archive.scenario_json).dump(2)));
}

// The part of the page that changes with the archive: `number` is its place among them.
std::string archive_part(const ReportedArchive& reported, std::size_t number,
                         const ReportInput& input) {
  const Archive& archive = reported.archive;
  const bool leaderboard = scenario_text(archive, "/evaluation/table") == "leaderboard";
  return fmt::format(
      "<article class=\"archive\" data-archive=\"{}\" data-name=\"{}\">\n<h2>{}</h2>\n{}{}{}{}"
      "<h3>Figures</h3>\n{}<div class=\"figures\"></div>\n"
      "<section class=\"reproduce\"><h3>How to reproduce it</h3>\n{}{}</section>\n</article>\n",
      number, html_escaped(archive.path), html_escaped(archive.results.scenario),
      paragraph("summary", scenario_text(archive, "/summary")),
      paragraph("provenance", provenance_line(archive)),
      input.archives.size() > 1 ? paragraph("provenance", "Archive: " + archive.path) : "",
      html_tables(archive.results, leaderboard), notes_list(reported.notes),
      commands_of(reported, input), scenario_details(archive));
}

std::string title_of(const ReportInput& input) {
  std::string title = "simbench";
  for (const ReportedArchive& reported : input.archives) {
    const std::string& scenario = reported.archive.results.scenario;
    if (title.find(scenario) == std::string::npos) title += fmt::format(" {}", scenario);
  }
  return title;
}

}  // namespace

std::string html_report(const ReportInput& input) {
  SIMBENCH_ASSERT(!input.archives.empty(), "a report is of at least one archive");
  std::vector<const Archive*> archives;
  std::string parts;
  std::string data;
  for (std::size_t i = 0; i < input.archives.size(); ++i) {
    archives.push_back(&input.archives[i].archive);
    parts += archive_part(input.archives[i], i, input);
    data += fmt::format("<script type=\"application/json\" class=\"data\">{}</script>\n",
                        script_safe(figures_json(input.archives[i].figures)));
  }
  return filled(web::page(), {{"title", html_escaped(title_of(input))},
                              {"uplot_licence", std::string(web::uplot_licence())},
                              {"uplot_style", std::string(web::uplot_style())},
                              {"style", std::string(web::style())},
                              {"comparison", html_comparison(archives)},
                              {"archives", parts},
                              {"version", fmt::format("simbench {} ({})", html_escaped(version()),
                                                      html_escaped(commit()))},
                              {"data", data},
                              {"uplot_script", std::string(web::uplot_script())},
                              {"script", std::string(web::script())}});
}

}  // namespace simbench::reports

#include "reports/page/html_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "algorithms/ports/assert.h"
#include "reports/comparison/gate_commands.h"
#include "reports/page/html_comparison.h"
#include "reports/page/html_figures.h"
#include "reports/page/html_page.h"
#include "reports/page/html_tables.h"
#include "reports/text/html_text.h"

namespace simbench::reports {
namespace {

using Json = nlohmann::ordered_json;

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

std::string provenance_line(const Archive& archive) {
  std::string line = fmt::format("{} of simbench {} ({})", seeds_text(archive.results),
                                 archive.version, archive.commit);
  if (!archive.started.empty()) {
    line += fmt::format(", run from {} to {}", archive.started, archive.finished);
  }
  return line;
}

std::string commands_of(const ReportedArchive& reported, const ReportInput& input) {
  const Archive& archive = reported.archive;
  std::string lines;
  if (!archive.command.empty())
    lines += html_command("The results", simbench_line(archive.command));
  lines += html_command("This report", simbench_line(input.command));
  if (!reported.figures.empty()) {
    lines +=
        html_command("One figure alone, for a paper",
                     fmt::format("simbench figure {} {} -o {}.svg", reported.figures.front().id,
                                 shell_line({archive.path}), reported.figures.front().id));
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
      html_paragraph("summary", scenario_text(archive, "/summary")),
      html_paragraph("provenance", provenance_line(archive)),
      input.archives.size() > 1 ? html_paragraph("provenance", "Archive: " + archive.path) : "",
      html_tables(archive.results, leaderboard), html_notes(reported.notes),
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
  std::vector<std::string> data;
  for (std::size_t i = 0; i < input.archives.size(); ++i) {
    archives.push_back(&input.archives[i].archive);
    parts += archive_part(input.archives[i], i, input);
    data.push_back(figures_json(input.archives[i].figures));
  }
  return html_page({.title = title_of(input),
                    .subtitle = "how well are these cameras synchronised, and what limits it",
                    .main = html_comparison(archives) + parts,
                    .data = data});
}

}  // namespace simbench::reports

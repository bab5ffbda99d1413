#include "reports/page/html_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "evaluation/run/leaderboard.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/leaderboard_report.h"
#include "reports/text/html_text.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Board;
using evaluation::Claim;
using evaluation::PublishedComparison;
using evaluation::Rank;
using evaluation::Results;
using evaluation::Row;
using Align = HtmlTable::Align;
using Column = HtmlTable::Column;
using Cells = std::vector<std::string>;

std::string section(std::string_view heading, const std::string& content,
                    std::string_view explanation) {
  return fmt::format("<section>\n<h3>{}</h3>\n{}<p class=\"legend\">{}</p>\n</section>\n",
                     html_escaped(heading), content, html_escaped(explanation));
}

const char* inside_text(bool inside) { return inside ? "inside" : "outside"; }

Cells published_cells(const PublishedComparison& known) {
  return {number_text(known.amd_ms),
          inside_text(known.amd_inside),
          percentile_text(known.amd_percentile),
          number_text(known.rmdv_ms),
          known.rmdv_attainable ? inside_text(known.rmdv_inside) : "not attainable",
          percentile_text(known.rmdv_percentile)};
}

std::string paper_section(const Results& results) {
  const bool published = std::any_of(results.rows.begin(), results.rows.end(),
                                     [](const Row& row) { return row.published.has_value(); });
  std::vector<Column> columns = {{"pipeline", Align::kLeft},
                                 {"AMD, median ms"},
                                 {"AMD, 5-95 %"},
                                 {"RMDV, median ms"},
                                 {"RMDV, 5-95 %"}};
  if (published) {
    columns.insert(columns.end(), {{"published AMD, ms"},
                                   {"published AMD is", Align::kLeft},
                                   {"at percentile [95 % interval]"},
                                   {"published RMDV, ms"},
                                   {"published RMDV is", Align::kLeft},
                                   {"at percentile [95 % interval]"}});
  }
  const bool real = has_real_rows(results);
  if (real) columns.push_back({"ground truth", Align::kLeft});
  HtmlTable table("The paper's metrics", columns);
  for (const Row& row : results.rows) {
    Cells cells = {row.pipeline, number_text(row.amd_ms.median), band_text(row.amd_ms),
                   number_text(row.rmdv_ms.median), band_text(row.rmdv_ms)};
    if (published) {
      const Cells more = row.published ? published_cells(*row.published) : Cells(6, "-");
      cells.insert(cells.end(), more.begin(), more.end());
    }
    if (real) cells.push_back(ground_truth_label(row));
    table.add(cells);
  }
  const std::string unverified = unverified_legend(results);
  return section(
      "The paper's metrics", table.html(),
      fmt::format(
          "AMD: mean range of the global stamps of a pulse over all cameras; RMDV: mean RMS "
          "deviation of these from their median. Every pipeline meets the same worlds, one "
          "per seed; a value is the median over the seeds, [a, b] their band from 5 to 95 %. "
          "Published: the paper's one recording. Inside: within the band. Not attainable: "
          "under eq. (4) no data have that RMDV with that AMD.{}{}",
          unverified.empty() ? "" : " ", unverified));
}

std::string truth_section(const Results& results) {
  HtmlTable table("What only known true time can tell", {{"pipeline", Align::kLeft},
                                                         {"absolute error, median ms"},
                                                         {"absolute error, 5-95 %"},
                                                         {"bias, ms"},
                                                         {"host clock error, median ms"},
                                                         {"host clock error, 5-95 %"},
                                                         {"exposure spread, ms"},
                                                         {"sets: precision"},
                                                         {"sets: recall"},
                                                         {"margin, ms"},
                                                         {"frames dropped"},
                                                         {"pulses scored"}});
  for (const Row& row : results.rows) {
    table.add({row.pipeline, number_text(row.absolute_error_ms.median),
               band_text(row.absolute_error_ms), number_text(row.bias_ms.median),
               number_text(row.host_error_ms.median), band_text(row.host_error_ms),
               number_text(row.exposure_spread_ms.median), share_text(row.precision),
               share_text(row.recall), number_text(row.margin_ms), count_text(row.frames.dropped),
               count_text(row.evaluated_pulses)});
  }
  const std::string floor = asymmetry_line(results);
  return section("What only known true time can tell", table.html(),
                 fmt::format("Absolute error: mean |global stamp - true mid-exposure on the "
                             "master's clock|; bias: with its sign. AMD is blind to what all "
                             "share. Host clock error: mean |slave - master|. Exposure spread: how "
                             "far apart the exposures really were, a limit for AMD. Precision: "
                             "gathered sets that hold one pulse only; recall: complete pulses "
                             "found whole; margin: from the range to the limit of a set.{}{}",
                             floor.empty() ? "" : " ", floor));
}

std::string gathering_section(const Results& results) {
  HtmlTable table("What gathering made of the stamps", {{"pipeline", Align::kLeft},
                                                        {"gathering", Align::kLeft},
                                                        {"complete sets"},
                                                        {"index errors"},
                                                        {"partial sets"},
                                                        {"frames discarded"},
                                                        {"AMD of sets, ms"},
                                                        {"absolute error of sets, ms"},
                                                        {"emitted after, mean ms"},
                                                        {"emitted after, largest ms"}});
  for (const Row& row : results.rows) {
    table.add({row.pipeline, row.gathering, count_text(row.sets.emitted),
               count_text(row.sets.index_errors), count_text(row.sets.partial),
               count_text(row.sets.discarded_frames), number_text(row.set_amd_ms.median),
               number_text(row.set_absolute_error_ms.median),
               number_text(row.emission_latency_ms.median),
               number_text(row.emission_latency_max_ms)});
  }
  return section("What gathering made of the stamps, over all seeds", table.html(),
                 "Index errors: frames of complete sets that are not of the pulse of most others "
                 "there. Emitted after: from the last member's arrival. AMD of sets is small where "
                 "sets were given up: see recall.");
}

void add_ranks(const std::vector<Rank>& ranks, HtmlTable& table) {
  for (const Rank& rank : ranks) {
    const Row& row = *rank.row;
    table.add({row.pipeline, row.offline ? "offline" : "online",
               number_text(row.absolute_error_ms.median), band_text(row.absolute_error_ms),
               number_text(rank.to_oracle.error.median), number_text(rank.to_paper.error.median),
               number_text(row.amd_ms.median), number_text(rank.to_oracle.amd.median),
               number_text(rank.to_paper.amd.median)});
  }
}

std::string boards_section(const Results& results) {
  std::string tables;
  for (const Board& board : evaluation::leaderboard(results)) {
    HtmlTable table(board.name.empty() ? "References" : fmt::format("Board: {}", board.name),
                    {{"pipeline", Align::kLeft},
                     {"stamps", Align::kLeft},
                     {"absolute error, median ms"},
                     {"absolute error, 5-95 %"},
                     {"error / oracle's"},
                     {"error / paper's Both"},
                     {"AMD, median ms"},
                     {"AMD / oracle's"},
                     {"AMD / paper's Both"}});
    add_ranks(board.online, table);
    add_ranks(board.offline, table);
    tables += table.html();
  }
  return section("Leaderboard", tables,
                 "Sorted by absolute error; of gathering boards by recall. Ratios are medians over "
                 "the seeds, each seed against the same seed: to the row of the board with the "
                 "oracle in its place, and to the paper's proposal. Online stamps a frame when it "
                 "arrives; offline has seen the whole recording.");
}

std::string claims_section(const Results& results) {
  HtmlTable table("The paper's claims",
                  {{"claim", Align::kLeft}, {"holds in"}, {"of the paper", Align::kLeft}});
  for (const Claim& claim : results.claims) {
    const std::string needs = claim.needs.empty() ? "" : fmt::format(" (needs {})", claim.needs);
    table.add({claim.id, claim.holds_fraction ? share_text(*claim.holds_fraction) : "-",
               claim.text + needs});
  }
  return section("The paper's claims, and the fraction of seeds in which each holds", table.html(),
                 "-: not decided by this scenario or these pipelines.");
}

std::string stages_section(const Results& results) {
  HtmlTable table("Pipelines", {{"pipeline", Align::kLeft},
                                {"host_sync", Align::kLeft},
                                {"device_time", Align::kLeft},
                                {"gathering", Align::kLeft},
                                {"times host synchronisation failed"}});
  for (const Row& row : results.rows) {
    table.add({row.pipeline, row.host_sync, row.device_time, row.gathering,
               count_text(row.unsynchronised_hosts)});
  }
  return section("Pipelines", table.html(),
                 "host_sync: what time is it on the other host? device_time: when, on the host's "
                 "clock, was a frame exposed? gathering: which frames belong together?");
}

std::string warnings_section(const Results& results) {
  std::string items;
  for (const std::string& warning : results.warnings) {
    items += fmt::format("<li>{}</li>\n", html_escaped(warning));
  }
  for (const std::string& note : note_lines(results)) {
    items += fmt::format("<li>{}</li>\n", html_escaped(note));
  }
  if (items.empty()) return "";
  return fmt::format("<section class=\"warnings\">\n<h3>Warnings</h3>\n<ul>\n{}</ul>\n</section>\n",
                     items);
}

std::string performance_line(const Results& results) {
  const evaluation::Performance& cost = results.performance;
  return fmt::format(
      "<p class=\"legend\">Cost of the run: {} events in {:.2f} s ({:.2f} s of CPU): {} events/s, "
      "{} simulated seconds per second.</p>\n",
      short_text(static_cast<double>(cost.events)), cost.wall_seconds, cost.cpu_seconds,
      short_text(cost.events_per_second), short_text(cost.simulated_seconds_per_second));
}

bool gatherings_differ(const Results& results) {
  return std::any_of(results.rows.begin(), results.rows.end(), [&](const Row& row) {
    return row.gathering != results.rows.front().gathering;
  });
}

}  // namespace

std::string html_tables(const Results& results, bool leaderboard) {
  std::string out = warnings_section(results);
  if (leaderboard) out += boards_section(results);
  out += paper_section(results) + truth_section(results);
  if (gatherings_differ(results)) out += gathering_section(results);
  if (!results.claims.empty()) out += claims_section(results);
  return out + stages_section(results) + performance_line(results);
}

}  // namespace simbench::reports

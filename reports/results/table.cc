#include "reports/results/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "reports/results/ground_truth_text.h"
#include "reports/results/leaderboard_report.h"
#include "reports/results/sets_block.h"
#include "reports/text/number_text.h"
#include "reports/text/text_table.h"

namespace simbench::reports {
namespace {

using evaluation::Claim;
using evaluation::PublishedComparison;
using evaluation::Results;
using evaluation::Row;
using evaluation::SeedScore;

bool any_published(const Results& results) {
  return std::any_of(results.rows.begin(), results.rows.end(),
                     [](const Row& row) { return row.published.has_value(); });
}

std::string seeds_text(const Results& results) {
  if (results.seed_count == 1) return fmt::format("1 seed ({})", results.first_seed);
  return fmt::format("{} seeds ({}-{})", results.seed_count, results.first_seed,
                     results.first_seed + results.seed_count - 1);
}

std::string amd_verdict(const PublishedComparison& published) {
  return published.amd_inside ? "inside" : "outside";
}

std::string rmdv_verdict(const PublishedComparison& published) {
  if (!published.rmdv_attainable) return "not attainable";
  return published.rmdv_inside ? "inside" : "outside";
}

// The paper's two metrics, beside what the paper says.
TextTable paper_block(const Results& results) {
  const bool published = any_published(results);
  const bool real = has_real_rows(results);
  std::vector<Column> columns = {{"pipeline", Align::kLeft}};
  if (real) columns.push_back({"ground\ntruth", Align::kLeft});
  columns.insert(columns.end(), {{"AMD\nmedian ms"}, {"AMD\n5-95 %"}});
  const std::vector<Column> amd_published = {{"published\nAMD ms"},
                                             {"published\nAMD is", Align::kLeft},
                                             {"at percentile\n[95 % interval]"}};
  const std::vector<Column> rmdv_published = {{"published\nRMDV ms"},
                                              {"published\nRMDV is", Align::kLeft}};
  if (published) columns.insert(columns.end(), amd_published.begin(), amd_published.end());
  columns.insert(columns.end(), {{"RMDV\nmedian ms"}, {"RMDV\n5-95 %"}});
  if (published) columns.insert(columns.end(), rmdv_published.begin(), rmdv_published.end());

  TextTable block(columns);
  for (const Row& row : results.rows) {
    std::vector<std::string> cells = {row.pipeline};
    if (real) cells.push_back(ground_truth_label(row));
    cells.insert(cells.end(), {number_text(row.amd_ms.median), band_text(row.amd_ms)});
    std::vector<std::string> amd_cells = {"-", "-", "-"};
    std::vector<std::string> rmdv_cells = {"-", "-"};
    if (const auto& known = row.published) {
      amd_cells = {number_text(known->amd_ms), amd_verdict(*known),
                   percentile_text(known->amd_percentile)};
      rmdv_cells = {number_text(known->rmdv_ms), rmdv_verdict(*known)};
    }
    if (published) cells.insert(cells.end(), amd_cells.begin(), amd_cells.end());
    cells.insert(cells.end(), {number_text(row.rmdv_ms.median), band_text(row.rmdv_ms)});
    if (published) cells.insert(cells.end(), rmdv_cells.begin(), rmdv_cells.end());
    block.add(cells);
  }
  return block;
}

// What a real rig cannot measure about itself.
TextTable truth_block(const Results& results) {
  TextTable block({{"pipeline", Align::kLeft},
                   {"absolute error\nmedian ms"},
                   {"absolute error\n5-95 %"},
                   {"bias\nms"},
                   {"host clock error\nmedian ms"},
                   {"host clock error\n5-95 %"},
                   {"exposure\nspread ms"},
                   {"sets:\nprecision"},
                   {"sets:\nrecall"},
                   {"margin\nms"},
                   {"frames\ndropped"},
                   {"pulses\nscored"}});
  for (const Row& row : results.rows) {
    block.add({row.pipeline, number_text(row.absolute_error_ms.median),
               band_text(row.absolute_error_ms), number_text(row.bias_ms.median),
               number_text(row.host_error_ms.median), band_text(row.host_error_ms),
               number_text(row.exposure_spread_ms.median), share_text(row.precision),
               share_text(row.recall), number_text(row.margin_ms), count_text(row.frames.dropped),
               count_text(row.evaluated_pulses)});
  }
  return block;
}

std::vector<const Row*> pointers_to(const std::vector<Row>& rows) {
  std::vector<const Row*> pointers;
  pointers.reserve(rows.size());
  for (const Row& row : rows) pointers.push_back(&row);
  return pointers;
}

bool gatherings_differ(const Results& results) {
  return std::any_of(results.rows.begin(), results.rows.end(), [&](const Row& row) {
    return row.gathering != results.rows.front().gathering;
  });
}

std::string stages_text(const Row& row) {
  return fmt::format("{} = {} + {} + {}", row.pipeline, row.host_sync, row.device_time,
                     row.gathering);
}

// A line each: what the columns mean.
std::vector<std::string> legend(const Results& results) {
  std::vector<std::string> lines = {
      has_real_rows(results)
          ? "Every repetition of a pipeline is a capture of its own. A value is the median over "
            "the "
            "repetitions, [a, b] their band from 5 to 95 %."
          : "Every pipeline meets the same worlds, one per seed. A value is the median over the "
            "seeds, [a, b] their band from 5 to 95 %.",
      "AMD: mean range of the global stamps of a pulse over all cameras; RMDV: mean RMS deviation "
      "of these from their median.",
      "absolute error: mean |global stamp - true mid-exposure on the master's clock|; bias: with "
      "its sign. AMD is blind to what all share.",
      "host clock error: mean |slave - master|. exposure spread: how far apart the exposures "
      "really were, a limit for AMD.",
      "precision: gathered sets that hold one pulse only; recall: complete pulses found whole; "
      "margin: from the range to the limit of a set."};
  if (const std::string unverified = unverified_legend(results); !unverified.empty()) {
    lines.push_back(unverified);
  }
  if (any_published(results)) {
    lines.emplace_back(
        "published: the paper's one recording. inside: within the band. not attainable: under eq. "
        "(4) no data have that RMDV with that AMD.");
  }
  return lines;
}

std::string claim_share(const Claim& claim) {
  return claim.holds_fraction ? share_text(*claim.holds_fraction) : "-";
}

TextTable claims_block(const Results& results) {
  TextTable block({{"claim", Align::kLeft}, {"holds in"}, {"of the paper", Align::kLeft}});
  for (const Claim& claim : results.claims) {
    const std::string needs = claim.needs.empty() ? "" : fmt::format(" (needs {})", claim.needs);
    block.add({claim.id, claim_share(claim), claim.text + needs});
  }
  return block;
}

std::string cost_line(const Results& results) {
  const evaluation::Performance& cost = results.performance;
  if (cost.simulated_seconds == 0) {
    return fmt::format("Cost: {:.2f} s ({:.2f} s of CPU).", cost.wall_seconds, cost.cpu_seconds);
  }
  return fmt::format(
      "Cost: {} events in {:.2f} s ({:.2f} s of CPU): {} events/s, {} simulated seconds per "
      "second.",
      short_text(static_cast<double>(cost.events)), cost.wall_seconds, cost.cpu_seconds,
      short_text(cost.events_per_second), short_text(cost.simulated_seconds_per_second));
}

// With the first reason, which is mostly the reason of all.
std::string unsynchronised_line(const Row& row) {
  const std::string times =
      row.unsynchronised_hosts == 1 ? "once" : count_text(row.unsynchronised_hosts) + " times";
  std::string line =
      fmt::format("{}: host synchronisation failed {} over all seeds.", row.pipeline, times);
  for (const SeedScore& seed : row.seeds) {
    if (seed.failures.empty()) continue;
    return line + fmt::format(" Seed {}: {}.", seed.seed, seed.failures.front().message);
  }
  return line;
}

struct Layout {
  bool markdown;
  std::string block(const TextTable& text) const {
    return fmt::format("{}{}", markdown ? "" : "\n", markdown ? text.markdown() : text.plain());
  }
  std::string heading(std::string_view text) const {
    return fmt::format("\n{}{}\n{}", markdown ? "### " : "", text, markdown ? "\n" : "");
  }
  std::string line(std::string_view text) const {
    return markdown ? fmt::format("- {}\n", text) : wrapped(text, 2);
  }
  std::string prose(std::string_view text) const {
    return markdown ? fmt::format("\n{}\n", text) : wrapped(text);
  }
};

std::string report(const Results& results, std::string_view summary, const Layout& layout) {
  std::string out = fmt::format("{}{}: {}\n", layout.markdown ? "## " : "", results.scenario,
                                seeds_text(results));
  if (!summary.empty()) out += layout.prose(summary);
  out += layout.heading("The paper's metrics");
  out += layout.block(paper_block(results));
  out += layout.heading("What only known true time can tell");
  out += layout.block(truth_block(results));
  if (gatherings_differ(results)) {
    out += layout.heading("What gathering made of the stamps, over all seeds");
    out += layout.block(sets_block(pointers_to(results.rows)));
  }
  for (const Row& row : results.rows) {
    if (row.unsynchronised_hosts > 0) out += fmt::format("\n{}\n", unsynchronised_line(row));
  }
  if (const std::vector<std::string> notes = note_lines(results); !notes.empty()) {
    out += layout.heading("What went wrong");
    for (const std::string& note : notes) out += layout.line(note);
  }
  out += layout.heading("How to read it");
  for (const std::string& text : legend(results)) out += layout.line(text);
  if (gatherings_differ(results)) {
    out += layout.line(kSetsLegend);
    if (has_real_rows(results)) out += layout.line(kRealArrivalsLegend);
  }
  const std::string asymmetry = asymmetry_line(results);
  if (!asymmetry.empty()) out += layout.line(asymmetry);
  out += layout.heading("Pipelines = host_sync + device_time + gathering");
  for (const Row& row : results.rows) out += layout.line(stages_text(row));
  if (!results.claims.empty()) {
    out += layout.heading("The paper's claims, and the fraction of seeds in which each holds");
    out += layout.block(claims_block(results));
  }
  return out + fmt::format("\n{}\n", cost_line(results));
}

}  // namespace

std::string table(const Results& results, std::string_view summary) {
  return fitted(report(results, summary, Layout{.markdown = false}));
}

std::string markdown(const Results& results, std::string_view summary) {
  return report(results, summary, Layout{.markdown = true});
}

}  // namespace simbench::reports

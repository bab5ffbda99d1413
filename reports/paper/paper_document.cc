#include "reports/paper/paper_document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "evaluation/run/leaderboard.h"
#include "evaluation/scoring/claims.h"
#include "evaluation/scoring/published_figures.h"
#include "evaluation/scoring/pulse_spread.h"
#include "evaluation/scoring/rows.h"
#include "recording/counted.h"
#include "reports/reconstruction/reconstruction_document.h"
#include "reports/results/results_document.h"
#include "reports/text/metric_text.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::Claim;
using evaluation::ClaimedRun;
using evaluation::Metric;
using evaluation::Percentile;
using evaluation::Placement;
using evaluation::Row;

const Metric& printed_metric(const PrintedValue& value) { return evaluation::metric(value.metric); }

const evaluation::Series& values_of(const PrintedValue& value) {
  return printed_metric(value).series(*value.row);
}

std::string placed_text(const PrintedValue& value) {
  return value.is_attainable() ? placement_text(value.percentile) : "not attainable";
}

std::string rate_text(const PaperRun& run) {
  return fmt::format("{:g} fps", run.scenario.trigger.rate_hz);
}

Block printed_block(const PaperRun& run) {
  const std::vector<Field<PrintedValue>> fields = {
      {{"pipeline", Align::kLeft}, [](const auto& value) { return value.row->pipeline; }},
      {{"metric", Align::kLeft},
       [](const auto& value) { return std::string(printed_metric(value).title); }},
      {{"printed"},
       [](const auto& value) { return metric_text(printed_metric(value), value.printed); }},
      {{"simulated\nmedian"},
       [](const auto& value) {
         return metric_text(printed_metric(value), values_of(value).median);
       }},
      {{"simulated\n5-95 %"},
       [](const auto& value) {
         return interval_text(printed_metric(value), values_of(value).p05, values_of(value).p95);
       }},
      {{"printed at percentile\n[95 % interval]"},
       [](const auto& value) { return percentile_text(value.percentile); }},
      {{.header = "printed is", .align = Align::kLeft, .is_verdict = true}, placed_text}};
  return {.heading = fmt::format("{}: {}, {}", run.table, rate_text(run), run.results.scenario),
          .table = table_of(fields, printed_values(run), 2)};
}

ClaimedRun claimed(const PaperRun& run) { return {run.results.rows, run.scenario.trigger.rate_hz}; }

// The claim of that name; one without a share where there is none.
Claim named_claim(const std::vector<Claim>& claims, const std::string& id) {
  const auto found = std::ranges::find(claims, id, &Claim::id);
  return found == claims.end() ? Claim{} : *found;
}

// Whether all of these that say anything hold.
std::optional<bool> all_hold(const std::vector<Claim>& claims) {
  std::optional<bool> hold;
  for (const Claim& claim : claims) {
    if (claim.holds_fraction) hold = hold.value_or(true) && *claim.holds_fraction == 1;
  }
  return hold;
}

// The share that decides the verdict: that across the rates, else the smaller one.
Percentile deciding(const PaperClaim& claim) {
  if (std::isfinite(claim.at_both.percent)) return claim.at_both;
  if (!std::isfinite(claim.at_15_fps.percent)) return claim.at_45_fps;
  if (!std::isfinite(claim.at_45_fps.percent)) return claim.at_15_fps;
  return claim.at_15_fps.percent < claim.at_45_fps.percent ? claim.at_15_fps : claim.at_45_fps;
}

std::string claim_verdict(const PaperClaim& claim) {
  const Percentile share = deciding(claim);
  if (!std::isfinite(share.percent)) return "-";
  const std::string_view word = evaluation::verdict_word(evaluation::verdict_of_bound(share));
  return std::string(word.empty() ? "too few seeds" : word);
}

Block claims_block(const std::vector<PaperClaim>& claims) {
  const std::vector<Field<PaperClaim>> fields = {
      {{"claim", Align::kLeft}, &PaperClaim::id},
      {{"in\nprint", Align::kLeft},
       [](const auto& claim) {
         return std::string(!claim.printed ? "-" : *claim.printed ? "yes" : "no");
       }},
      {{"holds at\n15 fps in"}, [](const auto& claim) { return percentile_text(claim.at_15_fps); }},
      {{"holds at\n45 fps in"}, [](const auto& claim) { return percentile_text(claim.at_45_fps); }},
      {{"across both\nrates in"}, [](const auto& claim) { return percentile_text(claim.at_both); }},
      {{.header = "verdict", .align = Align::kLeft, .is_verdict = true}, claim_verdict},
      {{"of the paper", Align::kLeft}, [](const auto& claim) {
         return claim.text + (claim.needs.empty() ? "" : fmt::format(" (needs {})", claim.needs));
       }}};
  return {.heading = "The paper's claims",
          .table = table_of(fields, claims),
          .prose = {"in print: what the printed numbers say; - where no table says it. holds in: "
                    "the share of the seeds [95 % interval]. verdict: holds in nearly all seeds "
                    "(95 % and more), inside (5 to 95 %: one recording shows it or not by chance) "
                    "or fails, by the whole interval; of two rates the smaller share decides."}};
}

Block table_4_block(const PaperResults& results) {
  if (!results.table_4) {
    return {.heading = "Table 4: the reconstruction", .prose = {results.no_table_4}};
  }
  Block block = reconstruction_document(*results.table_4).blocks.front();
  block.heading = fmt::format("Table 4: the reconstruction, {}",
                              counted_seeds(results.table_4->first_seed, results.table_4->seeds));
  return block;
}

Block figures_block(const PaperResults& results) {
  Block block{.heading = "The paper's figures"};
  if (results.figures.empty()) {
    block.prose = {"Not drawn: -o DIR draws them on its page."};
    return block;
  }
  for (const Figure& figure : results.figures) {
    block.items.push_back(fmt::format(
        "{}, {} ({}): {}", figure.paper, figure.title, figure.source.scenario,
        figure.absent.empty() ? figure.caption : "cannot be drawn here: " + figure.absent));
  }
  for (const PictureOfThePaper& picture : pictures_of_the_paper()) {
    block.items.push_back(fmt::format("{}, {}: not drawn, since no stamps make it; {}.",
                                      picture.paper, picture.content, picture.place));
  }
  return block;
}

Block fit_block(const PaperResults& results) {
  Block block{.heading = "What is a fit"};
  for (const PaperRun* run : {&results.at_15_fps, &results.at_45_fps}) {
    block.items.push_back(fmt::format("{}: {}", run->results.scenario, run->scenario.summary));
  }
  return block;
}

Block not_reached_block(const PaperResults& results) {
  Block block{.heading = "What is not reached, and why"};
  for (const PaperRun* run : {&results.at_15_fps, &results.at_45_fps}) {
    const std::vector<std::string> lines = not_reached(*run);
    block.items.insert(block.items.end(), lines.begin(), lines.end());
  }
  if (block.items.empty()) block.prose = {"Every printed value lies inside the seeds."};
  return block;
}

// Why the seeds have no such RMDV, as far as numbers say it.
std::string printed_ratio_text(const PrintedValue& value) {
  std::vector<double> ratios;
  const std::vector<double>& amd = value.row->amd_ms.values;
  for (std::size_t i = 0; i < amd.size(); ++i) {
    ratios.push_back(value.row->rmdv_ms.values.at(i) / amd[i]);
  }
  const double printed = value.printed / value.row->published->amd_ms;
  const evaluation::Series series = evaluation::make_series(std::move(ratios));
  std::string text =
      fmt::format("printed RMDV/AMD is {}, that of the seeds {} [{}, {}]", number_text(printed),
                  number_text(series.median), number_text(series.p05), number_text(series.p95));
  if (!(printed > series.p95)) return text;
  return text +
         ": hosts with offsets of their own do not have it (docs/reference/paper.md section 7)";
}

std::string reason_text(const PrintedValue& value) {
  if (!value.is_attainable()) {
    return fmt::format("no data have it: with an AMD of {} eq. (4) allows at most {}",
                       time_text(value.row->published->amd_ms), time_text(value.most));
  }
  if (evaluation::placement_of(value.percentile) == Placement::kTooFewSeeds) {
    return "the interval of its percentile contains a limit, so more seeds are needed to place it";
  }
  if (value.metric == "rmdv_ms") {
    return printed_ratio_text(value);
  }
  return "one set of parameters serves both rates (docs/results.md: leave one rate out)";
}

}  // namespace

std::vector<PrintedValue> printed_values(const PaperRun& run) {
  const evaluation::RowSetting setting = evaluation::row_setting(run.scenario);
  const double bound = evaluation::rmdv_bound(setting.sources, setting.median);
  std::vector<PrintedValue> values;
  for (const Row& row : run.results.rows) {
    if (!row.published) continue;
    values.push_back({.row = &row,
                      .metric = "amd_ms",
                      .printed = row.published->amd_ms,
                      .percentile = row.published->amd_percentile});
    values.push_back({.row = &row,
                      .metric = "rmdv_ms",
                      .printed = row.published->rmdv_ms,
                      .percentile = row.published->rmdv_percentile,
                      .most = bound * row.published->amd_ms});
  }
  return values;
}

std::vector<PaperClaim> paper_claims(const PaperResults& results) {
  const ClaimedRun slow = claimed(results.at_15_fps);
  const ClaimedRun fast = claimed(results.at_45_fps);
  const std::vector<Claim> at_slow = evaluation::check_claims(slow.rows, slow.trigger_rate_hz);
  const std::vector<Claim> at_fast = evaluation::check_claims(fast.rows, fast.trigger_rate_hz);
  const std::vector<Claim> across = evaluation::check_claims_across(slow, fast);
  const std::vector<Claim> slow_print = evaluation::check_printed_claims(slow);
  const std::vector<Claim> fast_print = evaluation::check_printed_claims(fast);
  const std::vector<Claim> across_print = evaluation::check_printed_claims_across(slow, fast);
  std::vector<Claim> all = at_slow;
  for (const Claim& claim : across) {
    if (std::ranges::find(all, claim.id, &Claim::id) == all.end()) all.push_back(claim);
  }
  std::vector<PaperClaim> claims;
  for (const Claim& claim : all) {
    const auto [id, text] = std::pair(claim.id, claim.text);
    PaperClaim& added = claims.emplace_back();
    added.id = id;
    added.text = text;
    added.printed = all_hold(
        {named_claim(slow_print, id), named_claim(fast_print, id), named_claim(across_print, id)});
    added.at_15_fps = held_percent(named_claim(at_slow, id));
    added.at_45_fps = held_percent(named_claim(at_fast, id));
    added.at_both = held_percent(named_claim(across, id));
    if (!std::isfinite(deciding(added).percent)) added.needs = named_claim(at_fast, id).needs;
  }
  return claims;
}

std::vector<std::string> not_reached(const PaperRun& run) {
  std::vector<std::string> lines;
  for (const PrintedValue& value : printed_values(run)) {
    const bool is_inside = evaluation::placement_of(value.percentile) == Placement::kInside;
    if (is_inside && value.is_attainable()) continue;
    lines.push_back(fmt::format(
        "{}, {} of {}, {}: {}, at percentile {}; {}.", run.table, printed_metric(value).title,
        value.row->pipeline, metric_text(printed_metric(value), value.printed), placed_text(value),
        percentile_text(value.percentile), reason_text(value)));
  }
  return lines;
}

AnswerText paper_answer(const PaperResults& results) {
  const PublishedAmdCount slow = published_amd_count(results.at_15_fps.results);
  const PublishedAmdCount fast = published_amd_count(results.at_45_fps.results);
  const std::size_t all = slow.all + fast.all;
  const std::size_t inside = slow.inside + fast.inside;
  const std::size_t outside = slow.outside + fast.outside;
  AnswerText answer{
      .lead = fmt::format("Of the paper's {} AMD values {} are plausible draws of the fitted "
                          "worlds, {} not{}.",
                          all, inside, outside == 1 ? "one is" : fmt::format("{} are", outside),
                          all == inside + outside ? ""
                                                  : fmt::format("; these seeds cannot place {}",
                                                                all - inside - outside))};
  for (const PaperRun* run : {&results.at_15_fps, &results.at_45_fps}) {
    answer.add(rate_text(*run), published_amd_text(run->results));
  }
  std::vector<std::string> by_chance;
  for (const PaperClaim& claim : paper_claims(results)) {
    if (claim_verdict(claim) == "inside" || claim_verdict(claim) == "fails") {
      by_chance.push_back(fmt::format("{} ({})", claim.id, percentile_text(deciding(claim))));
    }
  }
  if (!by_chance.empty()) {
    answer.add("Claims", fmt::format("One recording cannot show these claims, which hold in so "
                                     "many of the seeds: {}.",
                                     fmt::join(by_chance, ", ")));
  }
  return answer;
}

Document paper_document(const PaperResults& results) {
  const evaluation::Results& seeds = results.at_15_fps.results;
  Document document{.title = fmt::format("Yoon et al. 2021, beside {} of each rate",
                                         counted_seeds(seeds.first_seed, seeds.seed_count)),
                    .head = paragraphs(paper_answer(results))};
  document.blocks = {printed_block(results.at_15_fps),
                     printed_block(results.at_45_fps),
                     {.prose = {fmt::format("printed: the paper's one recording. {} not "
                                            "attainable: under eq. (4) no data have that RMDV with "
                                            "that AMD.",
                                            placement_legend())}},
                     claims_block(paper_claims(results)),
                     table_4_block(results),
                     figures_block(results),
                     fit_block(results),
                     not_reached_block(results)};
  return document;
}

}  // namespace simbench::reports

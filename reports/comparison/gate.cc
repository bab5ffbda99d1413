#include "reports/comparison/gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "evaluation/answer/standing.h"
#include "evaluation/statistics/paired.h"
#include "recording/collected.h"
#include "recording/counted.h"
#include "reports/comparison/comparison_scenarios.h"
#include "reports/text/program_name.h"
#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

using evaluation::Metric;
using evaluation::Row;
using scenarios::InputError;

constexpr const char* kAnew =
    "If the new values are intended, write a new baseline with `simbench gate RESULT "
    "--save-baseline FILE`";

void check_world(const Archive& result, const Baseline& baseline, GateReport& report) {
  if (result.results.kind != baseline.kind ||
      result.results.clock_period != baseline.clock_period) {
    throw InputError(fmt::format(
        "{} and the baseline {}: allowed: both of `simbench clocks` with the same --from-s and "
        "--duration-s, or neither",
        result.path, baseline.path));
  }
  if (result.scenario_json.empty()) {
    if (result.results.scenario != baseline.scenario) {
      throw InputError(fmt::format("{} is of the scenario {}, the baseline {} of {}", result.path,
                                   result.results.scenario, baseline.path, baseline.scenario));
    }
    report.notes.emplace_back(
        "a results.json alone does not hold its scenario, so whether it is the baseline's was not "
        "checked");
    return;
  }
  const ScenarioDifferences found = compare_scenarios(baseline.scenario_json, result.scenario_json);
  if (!found.world.empty()) {
    throw InputError(fmt::format(
        "{} is of another world than the baseline {} (the baseline's value first): {}. {}",
        result.path, baseline.path, first_few(found.world), kAnew));
  }
  if (!found.algorithms.empty()) {
    report.notes.push_back(fmt::format("the algorithms differ (the baseline's value first): {}",
                                       first_few(found.algorithms)));
  }
}

SeedPairing exact_pairing(const SeedRange& expected, const SeedRange& found,
                          const GateReport& report) {
  if (expected.first == found.first && expected.count == found.count) {
    return pair_by_seed(expected, found);
  }
  throw InputError(fmt::format(
      "{} has the seeds {}, the baseline {} has {}: run with --first-seed {} --seeds {}, or use "
      "--mode statistical, which takes any {} seeds",
      report.result_path, seeds_text(found), report.baseline_path, seeds_text(expected),
      expected.first, expected.count, kFewestGateSeeds));
}

SeedPairing statistical_pairing(const SeedRange& expected, const SeedRange& found,
                                GateReport& report) {
  SeedPairing pairing = pair_by_seed(expected, found);
  if (pairing.count < kFewestGateSeeds) {
    pairing = pair_by_index(expected, found);
    report.by_index = true;
  }
  if (pairing.count >= kFewestGateSeeds) return pairing;
  throw InputError(fmt::format(
      "{} has {} and the baseline {} has {}, allowed with --mode statistical: at least {} in "
      "each; run with --seeds {}",
      report.result_path, counted(found.count, "seed"), report.baseline_path, expected.count,
      kFewestGateSeeds, kFewestGateSeeds));
}

// Whether two values are the same except for rounding; NaN is the same as NaN.
bool same(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::abs(a - b) <= kRounding * std::max(std::abs(a), std::abs(b));
}

double margin_of(const evaluation::GateMargin& margin, double baseline) {
  if (std::isnan(baseline)) return margin.absolute;
  return std::max(margin.relative * std::abs(baseline), margin.absolute);
}

// By how much the value is worse; negative: better.
double worse_by(const Metric& metric, double difference) {
  return metric.higher_is_better() ? -difference : difference;
}

// Whether fewer than half as many seeds have a value now, seeds that are not those of the baseline.
bool are_mostly_lost(const std::vector<double>& before, const std::vector<double>& now) {
  return 2 * evaluation::count_of_existing(now) < evaluation::count_of_existing(before);
}

void count_changes(const std::vector<double>& before, const std::vector<double>& now,
                   GateCheck& check) {
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!same(before[i], now[i])) ++check.changed_seeds;
    if (!std::isnan(before[i]) && std::isnan(now[i])) ++check.lost_seeds;
  }
}

void decide_exactly(const std::vector<double>& before, const std::vector<double>& now,
                    GateCheck& check) {
  check.baseline = check.metric->table_value(before);
  check.value = check.metric->table_value(now);
  const double worse = worse_by(*check.metric, check.value - check.baseline);
  if (check.lost_seeds > 0 || (worse > check.margin && !same(check.value, check.baseline))) {
    check.outcome = GateOutcome::kFailed;
  } else if (check.changed_seeds == 0) {
    check.outcome = GateOutcome::kSame;
  } else {
    check.outcome = -worse > check.margin ? GateOutcome::kBetter : GateOutcome::kChanged;
  }
}

// The state of a check until all p-values are known.
struct OpenCheck {
  evaluation::PairedT t;
  bool vanished = false;
};

OpenCheck begin_statistically(const std::vector<double>& before, const std::vector<double>& now,
                              bool by_index, GateCheck& check) {
  const OpenCheck open{.t = evaluation::paired_t(evaluation::pair_up(before, now)),
                       .vanished = by_index ? are_mostly_lost(before, now) : check.lost_seeds > 0};
  if (open.t.pairs > 0) {
    check.baseline = open.t.mean_a;
    check.value = open.t.mean_a + open.t.mean;
  }
  return open;
}

void end_statistically(const OpenCheck& open, const evaluation::HolmDecision& decision,
                       GateCheck& check) {
  check.difference = open.t.interval(decision.error);
  check.confidence = 1 - decision.error;
  check.adjusted_p = decision.adjusted_p;
  const bool is_sure = decision.adjusted_p <= evaluation::kFamilyError;
  const double worse = worse_by(*check.metric, open.t.mean);
  if (open.vanished || (is_sure && worse > check.margin)) {
    check.outcome = GateOutcome::kFailed;
  } else if (worse > check.margin) {
    check.outcome = GateOutcome::kPossible;
  } else if (is_sure && -worse > check.margin) {
    check.outcome = GateOutcome::kBetter;
  } else {
    check.outcome = check.changed_seeds == 0 ? GateOutcome::kSame : GateOutcome::kChanged;
  }
}

void make_checks(const Archive& result, const Baseline& baseline, const SeedPairing& pairing,
                 GateReport& report) {
  std::vector<OpenCheck> open;
  std::vector<double> p;
  for (const BaselinePipeline& pipeline : baseline.pipelines) {
    const Row* row = evaluation::find_row(result.results.rows, pipeline.name);
    if (row == nullptr) {
      report.vanished_pipelines.push_back(pipeline.name);
      continue;
    }
    for (std::size_t i = 0; i < pipeline.values.size(); ++i) {
      GateCheck check;
      check.pipeline = pipeline.name;
      check.metric = baseline.judged[i];
      const std::vector<double> before = pairing.of_a(pipeline.values[i]);
      const std::vector<double> now = pairing.of_b(check.metric->series(*row).values);
      count_changes(before, now, check);
      if (report.mode == GateMode::kStatistical) {
        open.push_back(begin_statistically(before, now, report.by_index, check));
        p.push_back(open.back().t.p);
        check.margin = margin_of(baseline.margins[i], check.baseline);
      } else {
        check.margin = margin_of(baseline.margins[i], check.metric->table_value(before));
        decide_exactly(before, now, check);
      }
      report.checks.push_back(std::move(check));
    }
  }
  const std::vector<evaluation::HolmDecision> decisions = evaluation::holm(p);
  for (std::size_t i = 0; i < open.size(); ++i) {
    end_statistically(open[i], decisions[i], report.checks[i]);
  }
}

void note_more(const Archive& result, const Baseline& baseline, GateReport& report) {
  std::vector<std::string> more;
  for (const Row& row : result.results.rows) {
    const bool is_known =
        std::any_of(baseline.pipelines.begin(), baseline.pipelines.end(),
                    [&](const BaselinePipeline& known) { return known.name == row.pipeline; });
    if (!is_known) more.push_back(row.pipeline);
  }
  if (!more.empty()) {
    report.notes.push_back(
        fmt::format("not in the baseline, so not checked: {}", fmt::join(more, ", ")));
  }
  const evaluation::RankedBy ranked_by = evaluation::ranking_of(result.results);
  for (const Row& row : result.results.rows) {
    const evaluation::ReasonedStanding standing = evaluation::standing_of(row, ranked_by);
    if (standing.is != evaluation::RowStanding::kFailed) continue;
    report.notes.push_back(
        fmt::format("{} failed, so its values say little: {}", row.pipeline, standing.reason));
  }
  const auto without_values = std::count_if(
      report.checks.begin(), report.checks.end(),
      [](const GateCheck& check) { return std::isnan(check.baseline) && std::isnan(check.value); });
  if (without_values > 0) {
    report.notes.push_back(
        fmt::format("{} of {} show nothing: neither the baseline nor the result has a value",
                    without_values, counted(report.checks.size(), "check")));
  }
  if (report.passed() && report.count(GateOutcome::kSame) < report.checks.size() &&
      report.mode == GateMode::kExact) {
    report.notes.push_back(in_this_program(kAnew));
  }
}

// The commands that repeat what the gate saw: the run (as in its manifest; for a results.json alone
// as far as known), then the gate.
std::string run_command(const Archive& result) {
  if (!result.command.empty()) return simbench_line(result.command);
  const std::vector<std::string> names = collected(result.results.rows, &evaluation::Row::pipeline);
  const bool is_of_clocks = result.results.kind == evaluation::ResultKind::kClockRuns;
  return shell_line({program_name(), is_of_clocks ? "clocks" : "run", "--scenario",
                     result.results.scenario, "--first-seed",
                     fmt::format("{}", result.results.first_seed), "--seeds",
                     fmt::format("{}", result.results.seed_count), "--pipelines",
                     fmt::format("{}", fmt::join(names, ",")), "--output", "results"});
}

std::vector<std::string> gate_commands(const Archive& result, const Baseline& baseline,
                                       GateMode mode) {
  const std::string archive = result.command.empty() ? "results" : result.path;
  std::vector<std::string> judge = {program_name(), "gate", archive, "--baseline", baseline.path};
  if (mode == GateMode::kStatistical) judge.insert(judge.end(), {"--mode", "statistical"});
  return {run_command(result), shell_line(judge)};
}

}  // namespace

bool GateReport::passed() const {
  return vanished_pipelines.empty() && count(GateOutcome::kFailed) == 0;
}

std::size_t GateReport::count(GateOutcome outcome) const {
  return static_cast<std::size_t>(
      std::count_if(checks.begin(), checks.end(),
                    [&](const GateCheck& check) { return check.outcome == outcome; }));
}

GateReport gate(const Archive& result, const Baseline& baseline, GateMode mode) {
  GateReport report;
  report.mode = mode;
  report.scenario = baseline.scenario;
  report.derivation = result.results.derivation;
  report.result_path = result.path;
  report.baseline_path = baseline.path;
  report.baseline_version = baseline.version;
  report.baseline_commit = baseline.commit;
  check_world(result, baseline, report);
  const SeedRange found = seeds_of(result.results);
  const SeedPairing pairing = mode == GateMode::kExact
                                  ? exact_pairing(baseline.seeds, found, report)
                                  : statistical_pairing(baseline.seeds, found, report);
  report.seeds = {found.first + pairing.skip_b, pairing.count};
  report.baseline_seeds = {baseline.seeds.first + pairing.skip_a, pairing.count};
  make_checks(result, baseline, pairing, report);
  note_more(result, baseline, report);
  report.reproduce = gate_commands(result, baseline, mode);
  return report;
}

}  // namespace simbench::reports

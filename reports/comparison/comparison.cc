#include "reports/comparison/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "evaluation/scoring/program_failures.h"
#include "recording/collected.h"
#include "recording/text_fields.h"
#include "reports/comparison/comparison_scenarios.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/json.h"
#include "reports/text/answer_json.h"
#include "reports/text/json_node.h"
#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

using evaluation::Row;
using scenarios::InputError;

std::vector<std::string> names_of(const Archive& archive) {
  return collected(archive.results.rows, &Row::pipeline);
}

const Row& row_of(const Archive& archive, const std::string& name, const char* option) {
  if (const Row* row = evaluation::find_row(archive.results.rows, name)) return *row;
  throw InputError(fmt::format("{}: found '{}', which {} does not have; it has {}", option, name,
                               archive.path, fmt::join(names_of(archive), ", ")));
}

struct RowPair {
  const Row* a = nullptr;
  const Row* b = nullptr;
};

// What seeds of a row have in which no program ended is no value of it: it has failed.
std::vector<double> compared_values(const evaluation::Metric& metric, const Row& row) {
  std::vector<double> values = metric.series(row).values;
  if (!row.program_failures.empty()) std::ranges::fill(values, evaluation::kNan);
  return values;
}

// Says which rows are not compared, each once.
void note_failed(const std::vector<RowPair>& rows, Comparison& comparison) {
  for (const RowPair& pair : rows) {
    for (const Row* row : {pair.a, pair.b}) {
      const std::string failure = evaluation::program_failure_text(*row);
      if (failure.empty()) continue;
      std::string note =
          fmt::format("{} failed, so nothing of it is compared: {}", row->pipeline, failure);
      if (std::ranges::find(comparison.notes, note) != comparison.notes.end()) continue;
      comparison.notes.push_back(std::move(note));
    }
  }
}

// Judges every metric of every pair, all together.
void compare(const std::vector<RowPair>& rows, const SeedPairing& pairing,
             const ComparisonOptions& options, evaluation::ResultKind kind,
             Comparison& comparison) {
  std::vector<const Row*> all_rows;
  all_rows.reserve(2 * rows.size());
  for (const RowPair& row : rows) all_rows.insert(all_rows.end(), {row.a, row.b});
  const auto judged = evaluation::judged_metrics(kind, all_rows);
  std::vector<evaluation::ComparisonTask> tasks;
  tasks.reserve(rows.size() * judged.size());
  comparison.pipelines.reserve(rows.size());
  for (const RowPair& row : rows) {
    std::vector<ComparedValues> values;
    values.reserve(judged.size());
    for (const evaluation::Metric* metric : judged) {
      values.push_back({pairing.of_a(compared_values(*metric, *row.a)),
                        pairing.of_b(compared_values(*metric, *row.b))});
      tasks.push_back({.values = evaluation::pair_up(values.back().a, values.back().b),
                       .rule = {.smallest_effect = options.smallest_effect,
                                .smallest_step = metric->judged->smallest_step,
                                .higher_is_better = metric->higher_is_better()}});
    }
    comparison.pipelines.push_back({.pipeline_a = row.a->pipeline,
                                    .pipeline_b = row.b->pipeline,
                                    .values = std::move(values)});
  }
  note_failed(rows, comparison);
  const std::vector<evaluation::PairedComparison> all = evaluation::compare_together(tasks);
  comparison.judged = judged;
  auto first = all.begin();
  for (ComparedPipeline& pipeline : comparison.pipelines) {
    const auto end = first + static_cast<std::ptrdiff_t>(judged.size());
    pipeline.metrics = {first, end};
    first = end;
  }
}

Comparison prepared(const Archive& a, const Archive& b, const SeedPairing& pairing,
                    const ComparisonOptions& options) {
  Comparison comparison;
  comparison.scenario = a.results.scenario;
  comparison.derivation = a.results.derivation;
  comparison.archive_a = a.path;
  comparison.archive_b = b.path;
  comparison.by_index = options.by_index;
  comparison.first_seed_a = a.results.first_seed + pairing.skip_a;
  comparison.first_seed_b = b.results.first_seed + pairing.skip_b;
  comparison.seed_count = pairing.count;
  comparison.smallest_effect = options.smallest_effect;
  return comparison;
}

std::string described(const Archive& archive) {
  return fmt::format("{} (simbench {}, commit {})", archive.path, archive.version, archive.commit);
}

[[noreturn]] void refuse_worlds(const Archive& a, const Archive& b, const std::string& what) {
  throw InputError(
      fmt::format("{} and {} are of different scenarios, so a difference does not come from the "
                  "pipelines alone: "
                  "{}. Compare pipelines within one of them (--pipelines or --with-baseline), or "
                  "the same pipelines "
                  "in both worlds with --different-scenarios",
                  a.path, b.path, what));
}

// Only rows of one pipeline in scenarios of one name have the same load in a seed.
void note_own_load(const evaluation::Results& a, const evaluation::Results& b,
                   std::vector<std::string>& notes) {
  if (!a.draws_load && !b.draws_load) return;
  notes.push_back(
      fmt::format("{}; intervals and verdicts take that for chance, as it is", kOwnLoad));
}

// Refuses other worlds, or adds the differences to `notes`.
void check_scenarios(const Archive& a, const Archive& b, const ComparisonOptions& options,
                     std::vector<std::string>& notes) {
  if (a.results.kind != b.results.kind) {
    throw InputError(
        fmt::format("{} and {}: one is of `simbench clocks` and the other is not; they have no "
                    "metric in common",
                    a.path, b.path));
  }
  if (a.results.clock_period != b.results.clock_period) {
    throw InputError(fmt::format(
        "{} and {}: measured from {} to {} s and from {} to {} s; allowed: "
        "the same --from-s and --duration-s",
        a.path, b.path, a.results.clock_period.from_s, a.results.clock_period.duration_s,
        b.results.clock_period.from_s, b.results.clock_period.duration_s));
  }
  const std::string& name_a = a.results.scenario;
  const std::string& name_b = b.results.scenario;
  const std::string names = fmt::format("scenario {} against {}", name_a, name_b);
  if (a.scenario_json.empty() || b.scenario_json.empty()) {
    if (name_a != name_b && !options.different_scenarios) refuse_worlds(a, b, names);
    if (name_a != name_b) notes.push_back(names);
    notes.emplace_back(
        "a results.json alone does not hold its scenario, so whether both are of the same world "
        "was not checked");
    return;
  }
  const ScenarioDifferences found = compare_scenarios(a.scenario_json, b.scenario_json);
  if (!found.world.empty()) {
    const std::string world = first_few(found.world);
    if (!options.different_scenarios) refuse_worlds(a, b, world);
    notes.push_back(fmt::format(
        "different worlds (--different-scenarios), which cause the differences: {}", world));
  }
  if (name_a != name_b) {
    notes.push_back(names);
    note_own_load(a.results, b.results, notes);
  }
  if (!found.algorithms.empty()) {
    notes.push_back(fmt::format("the algorithms differ: {}", first_few(found.algorithms)));
  }
}

SeedPairing paired_seeds(const Archive& a, const Archive& b, const ComparisonOptions& options,
                         std::vector<std::string>& notes) {
  const SeedRange of_a = seeds_of(a.results);
  const SeedRange of_b = seeds_of(b.results);
  const SeedPairing pairing =
      options.by_index ? pair_by_index(of_a, of_b) : pair_by_seed(of_a, of_b);
  if (pairing.count == 0) {
    throw InputError(fmt::format(
        "{} has the seeds {} and {} has {}, none in common. Run one of them with the seeds of the "
        "other (--first-seed, --seeds), or compare them as independent runs with --by-index, which "
        "needs many more seeds",
        a.path, seeds_text(of_a), b.path, seeds_text(of_b)));
  }
  if (of_a.first != of_b.first || of_a.count != of_b.count) {
    const SeedRange used{of_a.first + pairing.skip_a, pairing.count};
    notes.push_back(fmt::format(
        "seeds {} against {}: {}", seeds_text(of_a), seeds_text(of_b),
        options.by_index ? fmt::format("the first {} of each, by index", pairing.count)
                         : fmt::format("the common ones, {}, are compared", seeds_text(used))));
  }
  return pairing;
}

void note_other_pipelines(const Archive& archive, const Archive& other,
                          std::vector<std::string>& notes) {
  std::vector<std::string> missing;
  for (const std::string& name : names_of(archive)) {
    if (evaluation::find_row(other.results.rows, name) == nullptr) missing.push_back(name);
  }
  if (missing.empty()) return;
  notes.push_back(
      fmt::format("only in {}, not compared: {}", archive.path, fmt::join(missing, ", ")));
}

void note_versions(const Archive& a, const Archive& b, std::vector<std::string>& notes) {
  if (a.version != b.version) {
    notes.push_back(fmt::format("version {} against {}", a.version, b.version));
  }
  if (a.commit != b.commit) {
    notes.push_back(fmt::format("commit {} against {}", a.commit, b.commit));
  }
}

}  // namespace

Comparison compare_archives(const Archive& a, const Archive& b, const ComparisonOptions& options) {
  std::vector<std::string> notes;
  check_scenarios(a, b, options, notes);
  const SeedPairing pairing = paired_seeds(a, b, options, notes);
  Comparison comparison = prepared(a, b, pairing, options);
  comparison.a = described(a);
  comparison.b = described(b);
  note_versions(a, b, notes);
  std::vector<RowPair> rows;
  rows.reserve(std::max(a.results.rows.size(), options.pipelines.size()));
  if (options.pipelines.empty()) {
    for (const Row& row : a.results.rows) {
      const Row* other = evaluation::find_row(b.results.rows, row.pipeline);
      if (other != nullptr) rows.push_back({&row, other});
    }
    note_other_pipelines(a, b, notes);
    note_other_pipelines(b, a, notes);
  }
  for (const std::string& name : options.pipelines) {
    rows.push_back({&row_of(a, name, "--pipelines"), &row_of(b, name, "--pipelines")});
  }
  if (rows.empty()) {
    throw InputError(fmt::format("no pipeline is in both: {} has {}, {} has {}", a.path,
                                 fmt::join(names_of(a), ", "), b.path,
                                 fmt::join(names_of(b), ", ")));
  }
  comparison.notes = std::move(notes);
  compare(rows, pairing, options, a.results.kind, comparison);
  return comparison;
}

Comparison compare_pipelines(const Archive& archive, const std::string& a, const std::string& b,
                             const ComparisonOptions& options) {
  const SeedPairing pairing = pair_by_seed(seeds_of(archive.results), seeds_of(archive.results));
  Comparison comparison = prepared(archive, archive, pairing, options);
  comparison.a = fmt::format("pipeline {} of {}", a, described(archive));
  comparison.b = fmt::format("pipeline {} of {}", b, described(archive));
  compare({{&row_of(archive, a, "--pipelines"), &row_of(archive, b, "--pipelines")}}, pairing,
          options, archive.results.kind, comparison);
  if (a != b) note_own_load(archive.results, archive.results, comparison.notes);
  return comparison;
}

Comparison compare_with_baseline(const Archive& archive, const std::string& baseline,
                                 const ComparisonOptions& options) {
  const SeedPairing pairing = pair_by_seed(seeds_of(archive.results), seeds_of(archive.results));
  Comparison comparison = prepared(archive, archive, pairing, options);
  comparison.with_baseline = true;
  comparison.a = fmt::format("pipeline {} of {}", baseline, described(archive));
  comparison.b = "each other pipeline of it";
  const Row& against = row_of(archive, baseline, "--with-baseline");
  std::vector<RowPair> rows;
  rows.reserve(archive.results.rows.size());
  for (const Row& row : archive.results.rows) {
    if (row.pipeline != baseline) rows.push_back({&against, &row});
  }
  if (rows.empty()) {
    throw InputError(
        fmt::format("--with-baseline: {} has no pipeline beside {}", archive.path, baseline));
  }
  compare(rows, pairing, options, archive.results.kind, comparison);
  note_own_load(archive.results, archive.results, comparison.notes);
  return comparison;
}

namespace {

Json estimate_json(const evaluation::Estimate& estimate) {
  return {{"value", estimate.value}, {"low", estimate.low}, {"high", estimate.high}};
}

Json paired_json(const evaluation::PairedComparison& c) {
  return {{"pairs", c.pairs},
          {"left_out", c.left_out},
          {"a", {{"mean", c.mean_a}, {"median", c.median_a}}},
          {"b", {{"mean", c.mean_b}, {"median", c.median_b}}},
          {"difference", estimate_json(c.difference)},
          {"ratio", estimate_json(c.ratio)},
          {"smallest_effect", c.smallest_effect},
          {"within_smallest_effect", c.within_effect},
          {"b_higher", c.higher},
          {"b_lower", c.lower},
          {"p", c.is_tested() ? Json(c.p) : Json()},
          {"adjusted_p", c.is_tested() ? Json(c.adjusted_p) : Json()},
          {"confidence", c.is_tested() ? Json(1 - c.error) : Json()},
          {"verdict", verdict_name(c.verdict)},
          {"seeds_needed", c.seeds_needed > 0 ? Json(c.seeds_needed) : Json()}};
}

Json verdicts_json(const VerdictCount& count) {
  return {{"together", count.tests},
          {"equal", count.equal},
          {"correction", "holm"},
          {"false_probability", evaluation::kFamilyError},
          {"false_expected", count.expected_false()},
          {"false_expected_uncorrected", count.expected_false_uncorrected()},
          {"fewest_pairs", count.fewest_pairs}};
}

}  // namespace

VerdictCount count_verdicts(const Comparison& comparison) {
  VerdictCount count;
  for (const ComparedPipeline& pipeline : comparison.pipelines) {
    for (const evaluation::PairedComparison& each : pipeline.metrics) {
      count.tests += each.is_tested() ? 1 : 0;
      count.equal += each.pairs > 0 && !each.is_tested() ? 1 : 0;
      count.most_pairs = std::max(count.most_pairs, each.pairs);
    }
  }
  count.fewest_pairs = evaluation::fewest_pairs(std::max<std::size_t>(1, count.tests));
  return count;
}

std::string comparison_json(const Comparison& comparison) {
  Json root = new_document();
  root["scenario"] = comparison.scenario;
  root["answer"] = answer_json(comparison_answer(comparison));
  state_derivation(comparison.derivation, root);
  root.update({{"a", comparison.a},
               {"b", comparison.b},
               {"seeds",
                {{"first_a", comparison.first_seed_a},
                 {"first_b", comparison.first_seed_b},
                 {"count", comparison.seed_count},
                 {"paired_by", comparison.by_index ? "index" : "seed"}}},
               {"smallest_effect", comparison.smallest_effect},
               {"verdicts", verdicts_json(count_verdicts(comparison))},
               {"pipelines", Json::array()},
               {"notes", comparison.notes}});
  for (const ComparedPipeline& pipeline : comparison.pipelines) {
    Json row = {{"a", pipeline.pipeline_a}, {"b", pipeline.pipeline_b}};
    for (std::size_t i = 0; i < pipeline.metrics.size(); ++i) {
      row[comparison.judged[i]->id] = paired_json(pipeline.metrics[i]);
    }
    root["pipelines"].push_back(std::move(row));
  }
  return file_text(root);
}

std::string comparison_csv(const Comparison& comparison) {
  std::string text =
      "pipeline_a,pipeline_b,metric,pairs,left_out,mean_a,mean_b,median_a,median_b,difference,"
      "difference_low,difference_high,ratio,ratio_low,ratio_high,verdict,seeds_needed,"
      "b_higher,b_lower,p,adjusted_p,confidence\n";
  for (const ComparedPipeline& pipeline : comparison.pipelines) {
    for (std::size_t i = 0; i < pipeline.metrics.size(); ++i) {
      const evaluation::PairedComparison& c = pipeline.metrics[i];
      text +=
          fmt::format("{},{},{},{},{}", csv_cell(pipeline.pipeline_a),
                      csv_cell(pipeline.pipeline_b), comparison.judged[i]->id, c.pairs, c.left_out);
      for (const double value :
           {c.mean_a, c.mean_b, c.median_a, c.median_b, c.difference.value, c.difference.low,
            c.difference.high, c.ratio.value, c.ratio.low, c.ratio.high}) {
        text += fmt::format(",{}", csv_cell(value));
      }
      text += fmt::format(",{},{},{},{}", verdict_name(c.verdict),
                          c.seeds_needed > 0 ? fmt::format("{}", c.seeds_needed) : "", c.higher,
                          c.lower);
      for (const double value : {c.p, c.adjusted_p, 1 - c.error}) {
        text += fmt::format(",{}", csv_cell(c.is_tested() ? value : evaluation::kNan));
      }
      text += "\n";
    }
  }
  return text;
}

}  // namespace simbench::reports

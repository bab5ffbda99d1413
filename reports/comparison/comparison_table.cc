// Makes tables of comparisons for people.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "reports/comparison/comparison.h"
#include "reports/comparison/comparison_scenarios.h"
#include "reports/text/metric_text.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Estimate;
using evaluation::Metric;
using evaluation::PairedComparison;
using evaluation::Verdict;

bool is_sure(const PairedComparison& comparison) {
  return comparison.verdict == Verdict::kBetter || comparison.verdict == Verdict::kWorse;
}

bool has_interval(const Estimate& estimate) { return !std::isnan(estimate.low); }

// "times" from a factor of two on, else percent; with the interval, if there is one.
std::string factor_words(const Estimate& ratio) {
  constexpr double kTimes = 2;
  const auto worded = [&](const char* what, double value, double near, double far,
                          const char* unit) {
    std::string text =
        fmt::format("{}{} {}", number_text(value), *unit == 0 ? " times" : unit, what);
    if (!has_interval(ratio)) return text;
    return fmt::format("{} [{}{}, {}{}]", text, number_text(near), unit, number_text(far), unit);
  };
  if (ratio.value >= kTimes) return worded("larger", ratio.value, ratio.low, ratio.high, "");
  if (ratio.value * kTimes <= 1 && !(ratio.low <= 0)) {
    return worded("smaller", 1 / ratio.value, 1 / ratio.high, 1 / ratio.low, "");
  }
  const auto percent = [](double share) { return 100 * std::abs(share - 1); };
  if (ratio.value >= 1) {
    return worded("larger", percent(ratio.value), percent(ratio.low), percent(ratio.high), " %");
  }
  return worded("smaller", percent(ratio.value), percent(ratio.high), percent(ratio.low), " %");
}

}  // namespace

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kBetter:
      return "better";
    case Verdict::kWorse:
      return "worse";
    case Verdict::kNoDifferenceSeen:
      return "no_difference_seen";
    case Verdict::kTooFewSeeds:
      return "too_few_seeds";
  }
  return "";
}

std::string verdict_text(const PairedComparison& comparison, double smallest_effect) {
  constexpr std::uint64_t kMany = 1'000'000;
  if (comparison.pairs == 0) return "no values";
  std::string text;
  if (comparison.verdict == Verdict::kNoDifferenceSeen) {
    const bool all_equal = comparison.difference.low == 0 && comparison.difference.high == 0;
    text = all_equal ? "no difference seen: all equal" : "no difference seen";
  } else if (is_sure(comparison)) {
    text = verdict_name(comparison.verdict);
    if (comparison.within_effect) {
      text += fmt::format(", by less than {:.3g} %", 100 * smallest_effect);
    }
  } else if (comparison.seeds_needed == 0) {
    text = "too few seeds: more needed";
  } else if (comparison.seeds_needed > kMany) {
    text = "too few seeds: over a million needed";
  } else {
    text = fmt::format("too few seeds: {} needed", comparison.seeds_needed);
  }
  if (comparison.verdict == Verdict::kTooFewSeeds && !has_interval(comparison.difference)) {
    const bool is_higher = comparison.higher >= comparison.lower;
    text += fmt::format(", {} in {} of {}", is_higher ? "higher" : "lower",
                        is_higher ? comparison.higher : comparison.lower, comparison.pairs);
  }
  if (comparison.left_out > 0) {
    text += fmt::format(" ({} left out: no value)", counted(comparison.left_out, "seed"));
  }
  return text;
}

std::string effect_words(const Metric& metric, const PairedComparison& comparison,
                         double smallest_effect) {
  if (!is_sure(comparison)) {
    const bool has_effect = comparison.verdict == Verdict::kTooFewSeeds &&
                            comparison.ratio.value > 0 && !has_interval(comparison.difference);
    return fmt::format("{}: {}{}", metric.title,
                       has_effect ? factor_words(comparison.ratio) + ", but " : "",
                       verdict_text(comparison, smallest_effect));
  }
  if (metric.is_share()) {
    return fmt::format("{} {} in place of {}", metric.title, share_text(comparison.mean_b),
                       share_text(comparison.mean_a));
  }
  if (std::isnan(comparison.ratio.low)) {
    return fmt::format("{} {} in place of {}", metric.title, metric_text(metric, comparison.mean_b),
                       metric_text(metric, comparison.mean_a));
  }
  return fmt::format("{} {}", metric.title, factor_words(comparison.ratio));
}

namespace {

std::string interval_cell(const std::string& low, const std::string& high) {
  return low == "-" || high == "-" ? "-" : fmt::format("[{}, {}]", low, high);
}

std::vector<std::string> cells(const std::string& pipeline, const Metric& metric,
                               const PairedComparison& c, double smallest_effect) {
  return {pipeline,
          metric.title,
          metric_text(metric, c.median_a),
          metric_text(metric, c.median_b),
          difference_text(metric, c.difference.value),
          interval_text(metric, c.difference.low, c.difference.high),
          number_text(c.ratio.value),
          interval_cell(number_text(c.ratio.low), number_text(c.ratio.high)),
          verdict_text(c, smallest_effect)};
}

Table comparison_table(const Comparison& comparison) {
  Table table({{"pipeline", Align::kLeft},
               {"metric", Align::kLeft},
               {"A\nmedian"},
               {"B\nmedian"},
               {"B - A\nmean"},
               {"B - A\ninterval"},
               {"B / A\nof means"},
               {"B / A\ninterval"},
               {.header = "B is", .align = Align::kLeft, .is_verdict = true}},
              2);
  for (const ComparedPipeline& pipeline : comparison.pipelines) {
    const std::string name = pair_name(comparison, pipeline);
    for (std::size_t i = 0; i < pipeline.metrics.size(); ++i) {
      table.add(
          cells(name, *comparison.judged[i], pipeline.metrics[i], comparison.smallest_effect));
    }
  }
  return table;
}

std::string pairing_text(const Comparison& comparison) {
  const SeedRange a{comparison.first_seed_a, comparison.seed_count};
  const SeedRange b{comparison.first_seed_b, comparison.seed_count};
  if (!comparison.by_index) {
    return fmt::format("{}, one for each of the seeds {}", counted(a.count, "pair"), seeds_text(a));
  }
  return fmt::format("{} by index: seeds {} with {}", counted(a.count, "pair"), seeds_text(a),
                     seeds_text(b));
}

// "yoon2021_both: AMD 12 % larger [8 %, 15 %]" of each verdict, the first few of them.
std::string verdict_list(const Comparison& comparison, Verdict verdict) {
  constexpr std::size_t kMost = 4;
  std::vector<std::string> found;
  std::size_t more = 0;
  for (const ComparedPipeline& pipeline : comparison.pipelines) {
    for (std::size_t i = 0; i < pipeline.metrics.size(); ++i) {
      if (pipeline.metrics[i].verdict != verdict) continue;
      if (found.size() == kMost) {
        ++more;
        continue;
      }
      found.push_back(fmt::format(
          "{}: {}", pipeline.pipeline_b,
          effect_words(*comparison.judged[i], pipeline.metrics[i], comparison.smallest_effect)));
    }
  }
  if (found.empty()) return "";
  return fmt::format("{}{}.", fmt::join(found, "; "),
                     more > 0 ? fmt::format("; and {} more", more) : "");
}

std::size_t count_of(const Comparison& comparison, Verdict verdict) {
  std::size_t count = 0;
  for (const ComparedPipeline& pipeline : comparison.pipelines) {
    count += static_cast<std::size_t>(
        std::ranges::count(pipeline.metrics, verdict, &PairedComparison::verdict));
  }
  return count;
}

Block words(const Comparison& comparison) {
  Block block{.heading = "How much better"};
  for (const ComparedPipeline& pipeline : comparison.pipelines) {
    std::vector<std::string> effects;
    for (std::size_t i = 0; i < pipeline.metrics.size(); ++i) {
      effects.push_back(
          effect_words(*comparison.judged[i], pipeline.metrics[i], comparison.smallest_effect));
    }
    block.items.push_back(fmt::format("{} against {}: {}", pipeline.pipeline_b, pipeline.pipeline_a,
                                      fmt::join(effects, "; ")));
  }
  return block;
}

// How many verdicts there are and how sure they are together; what these pairs cannot tell.
std::vector<std::string> verdicts_words(const Comparison& comparison) {
  const VerdictCount count = count_verdicts(comparison);
  std::vector<std::string> words;
  if (count.tests > 0) {
    words.push_back(fmt::format(
        "{} made together, with Holm's correction: the probability that any better or worse is "
        "false is at most {:.3g} %. Expected number of false ones if nothing differs: about {:.2g} "
        "(at {:.3g} % each, without the correction: {:.3g}).",
        counted(count.tests, "verdict"), 100 * evaluation::kFamilyError, count.expected_false(),
        100 * evaluation::kFamilyError, count.expected_false_uncorrected()));
  }
  if (count.equal > 0) {
    words.push_back(
        fmt::format("{} of equal values, which need no test.", counted(count.equal, "line")));
  }
  if (count.tests > 0 && count.most_pairs < count.fewest_pairs) {
    words.push_back(fmt::format(
        "Of {} no p-value can be below {:.3g} (2 / 2^{}), however large the difference, and {} "
        "corrected for their number ask for {:.2g}: these seeds can show neither better nor worse. "
        "{} can. What they do tell: medians, means, their ratio, and in how many pairs B is "
        "higher or lower.",
        counted(count.most_pairs, "pair"), std::ldexp(2, -static_cast<int>(count.most_pairs)),
        count.most_pairs, counted(count.tests, "verdict"),
        evaluation::kFamilyError / static_cast<double>(count.tests),
        counted(count.fewest_pairs, "pair")));
  }
  return words;
}

std::string comparison_legend(const Comparison& comparison) {
  return fmt::format(
      "Median: over the seeds, as in the table of a run. Mean difference and ratio of means: over "
      "pairs of the same seed; their intervals come from the means of subsets of the pairs, at "
      "the level that Holm's correction leaves to the line (confidence in JSON and CSV), {:.4g} % "
      "or more. better, worse: the interval excludes 0. no difference seen: it includes 0 and "
      "lies within {:.3g} % of A's mean (--smallest-effect). too few seeds: it includes 0 and "
      "more than that; with the seeds needed, a guess from the scatter of these, it leads to one "
      "of the other results.",
      100 * (1 - evaluation::kFamilyError), 100 * comparison.smallest_effect);
}

}  // namespace

std::string pair_name(const Comparison& comparison, const ComparedPipeline& pipeline) {
  return pipeline.pipeline_a == pipeline.pipeline_b || comparison.with_baseline
             ? pipeline.pipeline_b
             : fmt::format("{} / {}", pipeline.pipeline_b, pipeline.pipeline_a);
}

AnswerText comparison_answer(const Comparison& comparison) {
  const std::size_t better = count_of(comparison, Verdict::kBetter);
  const std::size_t worse = count_of(comparison, Verdict::kWorse);
  const std::size_t few = count_of(comparison, Verdict::kTooFewSeeds);
  const std::size_t same = count_of(comparison, Verdict::kNoDifferenceSeen);
  AnswerText answer{.lead = better + worse == 0
                                ? "No difference between A and B is shown by these seeds."
                                : fmt::format("B is better than A in {} and worse in {}.",
                                              counted(better, "value"), counted(worse, "value"))};
  answer.add("Better", verdict_list(comparison, Verdict::kBetter));
  answer.add("Worse", verdict_list(comparison, Verdict::kWorse));
  answer.add("Others", fmt::format("{} without a difference seen, {} with too few seeds to tell.",
                                   counted(same, "value"), few));
  return answer;
}

std::vector<std::string> scenario_facts(const Comparison& comparison) {
  std::vector<std::string> facts = {
      fmt::format("{}: {}", scenarios::named(comparison.scenario, comparison.derivation),
                  pairing_text(comparison))};
  if (!comparison.derivation.changes.empty()) {
    facts.push_back(scenarios::changed_text(comparison.derivation));
  }
  return facts;
}

Document comparison_document(const Comparison& comparison) {
  Document document{.head = paragraphs(comparison_answer(comparison))};
  document.head.push_back(fmt::format("A: {}", comparison.a));
  document.head.push_back(fmt::format("B: {}", comparison.b));
  for (std::string& fact : scenario_facts(comparison)) document.head.push_back(std::move(fact));
  document.blocks.push_back({.table = comparison_table(comparison)});
  if (comparison.with_baseline) document.blocks.push_back(words(comparison));
  if (std::vector<std::string> sure = verdicts_words(comparison); !sure.empty()) {
    document.blocks.push_back({.heading = "How sure", .items = std::move(sure)});
  }
  if (!comparison.notes.empty()) {
    document.blocks.push_back({.heading = "What differs besides", .items = comparison.notes});
  }
  document.blocks.push_back(
      {.heading = "How to read it", .items = {comparison_legend(comparison)}});
  return document;
}

}  // namespace simbench::reports

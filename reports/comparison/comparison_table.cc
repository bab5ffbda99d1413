// Comparisons for people.
#include <fmt/format.h>

#include "reports/comparison/comparison.h"
#include "reports/comparison/comparison_scenarios.h"
#include "reports/comparison/comparison_words.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Metric;
using evaluation::PairedComparison;

// As the other numbers, but a small ratio keeps its digits.
std::string ratio_cell(double ratio) {
  constexpr double kSmall = 0.1;
  return ratio > 0 && ratio < kSmall ? factor_text(ratio) : number_text(ratio);
}

std::vector<std::string> cells(const std::string& pipeline, const Metric& metric,
                               const PairedComparison& c, double smallest_effect) {
  const auto shown = [&](double value) { return number_text(shown_value(metric, value)); };
  return {pipeline,
          shown_title(metric),
          shown(c.median_a),
          shown(c.median_b),
          shown(c.difference.value),
          fmt::format("[{}, {}]", shown(c.difference.low), shown(c.difference.high)),
          ratio_cell(c.ratio.value),
          fmt::format("[{}, {}]", ratio_cell(c.ratio.low), ratio_cell(c.ratio.high)),
          verdict_text(c, smallest_effect)};
}

Table comparison_table(const Comparison& comparison) {
  Table table({{"pipeline", Align::kLeft},
               {"metric", Align::kLeft},
               {"A\nmedian"},
               {"B\nmedian"},
               {"B - A\nmean"},
               {"B - A\n95 % interval"},
               {"B / A\nof means"},
               {"B / A\n95 % interval"},
               {"B is", Align::kLeft}});
  const auto judged = evaluation::judged_metrics();
  for (const ComparedPipeline& pipeline : comparison.pipelines) {
    const std::string name = pipeline.pipeline_a == pipeline.pipeline_b || comparison.with_baseline
                                 ? pipeline.pipeline_b
                                 : fmt::format("{} / {}", pipeline.pipeline_b, pipeline.pipeline_a);
    for (std::size_t i = 0; i < pipeline.metrics.size(); ++i) {
      table.add(cells(name, *judged[i], pipeline.metrics[i], comparison.smallest_effect));
    }
  }
  return table;
}

std::string pairing_text(const Comparison& comparison) {
  const SeedRange a{comparison.first_seed_a, comparison.seed_count};
  const SeedRange b{comparison.first_seed_b, comparison.seed_count};
  if (!comparison.by_index) {
    return fmt::format("{} pairs, one for each of the seeds {}", a.count, seeds_text(a));
  }
  return fmt::format("{} pairs by index: seeds {} with {}", a.count, seeds_text(a), seeds_text(b));
}

Block words(const Comparison& comparison) {
  const auto judged = evaluation::judged_metrics();
  Block block{.heading = "How much better"};
  for (const ComparedPipeline& pipeline : comparison.pipelines) {
    std::vector<std::string> effects;
    for (std::size_t i = 0; i < pipeline.metrics.size(); ++i) {
      effects.push_back(effect_words(*judged[i], pipeline.metrics[i], comparison.smallest_effect));
    }
    block.items.push_back(fmt::format("{} against {}: {}", pipeline.pipeline_b, pipeline.pipeline_a,
                                      fmt::join(effects, "; ")));
  }
  return block;
}

std::string legend(const Comparison& comparison) {
  return fmt::format(
      "Median: over the seeds, as in the table of a run. Mean difference and ratio of means with "
      "their 95 % intervals: over pairs of the same seed, by bootstrap. better, worse: the "
      "interval excludes 0. no difference seen: it includes 0 and any difference is within {:.3g} "
      "% of A's "
      "mean (--smallest-effect). too few seeds: it includes 0 and more than that; with the seeds "
      "needed it is narrower than that, so that one of the others must come out.",
      100 * comparison.smallest_effect);
}

}  // namespace

Document comparison_document(const Comparison& comparison) {
  Document document{.head = {fmt::format("A: {}", comparison.a), fmt::format("B: {}", comparison.b),
                             fmt::format("{}: {}", comparison.scenario, pairing_text(comparison))}};
  document.blocks.push_back({.table = comparison_table(comparison)});
  if (comparison.with_baseline) document.blocks.push_back(words(comparison));
  if (!comparison.notes.empty()) {
    document.blocks.push_back({.heading = "What differs besides", .items = comparison.notes});
  }
  document.blocks.push_back({.heading = "How to read it", .items = {legend(comparison)}});
  return document;
}

}  // namespace simbench::reports

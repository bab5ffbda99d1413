// Comparisons for people.
#include <fmt/format.h>

#include "reports/comparison/comparison.h"
#include "reports/comparison/comparison_scenarios.h"
#include "reports/comparison/comparison_words.h"
#include "reports/text/number_text.h"
#include "reports/text/text_table.h"

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

TextTable table_of(const Comparison& comparison) {
  TextTable table({{"pipeline", Align::kLeft},
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

std::string head(const Comparison& comparison) {
  return wrapped(fmt::format("A: {}", comparison.a)) + wrapped(fmt::format("B: {}", comparison.b)) +
         wrapped(fmt::format("{}: {}", comparison.scenario, pairing_text(comparison)));
}

std::string words(const Comparison& comparison) {
  if (!comparison.with_baseline) return "";
  const auto judged = evaluation::judged_metrics();
  std::string text = "\nHow much better\n";
  for (const ComparedPipeline& pipeline : comparison.pipelines) {
    std::vector<std::string> effects;
    for (std::size_t i = 0; i < pipeline.metrics.size(); ++i) {
      effects.push_back(effect_words(*judged[i], pipeline.metrics[i], comparison.smallest_effect));
    }
    text += wrapped(fmt::format("{} against {}: {}", pipeline.pipeline_b, pipeline.pipeline_a,
                                fmt::join(effects, "; ")),
                    2);
  }
  return text;
}

std::string notes(const Comparison& comparison) {
  if (comparison.notes.empty()) return "";
  std::string text = "\nWhat differs besides\n";
  for (const std::string& note : comparison.notes) text += wrapped(note, 2);
  return text;
}

std::string legend(const Comparison& comparison) {
  return "\nHow to read it\n" +
         wrapped(
             fmt::format(
                 "Median: over the seeds, as in the table of a run. Mean difference and ratio of "
                 "means with their 95 % intervals: over pairs of the same seed, by bootstrap. "
                 "better, worse: the interval excludes 0. no difference seen: it includes 0 and "
                 "any difference is within {:.3g} % of A's mean (--smallest-effect). too few "
                 "seeds: it includes 0 and more than that; with the seeds needed it is narrower "
                 "than that, so that one of the others must come out.",
                 100 * comparison.smallest_effect),
             2);
}

}  // namespace

std::string comparison_table(const Comparison& comparison) {
  return head(comparison) + "\n" + table_of(comparison).plain() + words(comparison) +
         notes(comparison) + legend(comparison);
}

std::string comparison_markdown(const Comparison& comparison) {
  std::string text = fmt::format("- A: {}\n- B: {}\n- {}: {}\n\n", comparison.a, comparison.b,
                                 comparison.scenario, pairing_text(comparison));
  text += table_of(comparison).markdown();
  if (!comparison.notes.empty()) text += "\n";
  for (const std::string& note : comparison.notes) text += fmt::format("- {}\n", note);
  return text;
}

}  // namespace simbench::reports

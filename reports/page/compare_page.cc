#include "reports/page/compare_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "evaluation/statistics/paired.h"
#include "reports/archive/archive.h"
#include "reports/figures/comparison_figures.h"

namespace simbench::reports {
namespace {

using evaluation::PairedComparison;
using evaluation::Verdict;

// "yoon2021_both against ntp_last_set", "all against ntp_last_set of monday", "tuesday against
// monday".
std::string comparison_heading(const Comparison& comparison) {
  const ComparedPipeline& first = comparison.pipelines.front();
  if (comparison.with_baseline) {
    return fmt::format("{}: all against {}", comparison.archive_a, first.pipeline_a);
  }
  if (comparison.archive_a == comparison.archive_b) {
    return fmt::format("{}: {} against {}", comparison.archive_a, first.pipeline_b,
                       first.pipeline_a);
  }
  return fmt::format("{} against {}", comparison.archive_b, comparison.archive_a);
}

// The first pair of which something is sure.
std::string leading_pair(const Comparison& comparison) {
  const auto found = std::ranges::find_if(comparison.pipelines, [](const auto& pipeline) {
    return std::ranges::any_of(pipeline.metrics, [](const PairedComparison& metric) {
      return metric.verdict == Verdict::kBetter || metric.verdict == Verdict::kWorse;
    });
  });
  return pair_name(comparison,
                   found == comparison.pipelines.end() ? comparison.pipelines.front() : *found);
}

}  // namespace

HtmlArticle comparison_article(const Comparison& comparison,
                               const std::vector<std::string>& command) {
  std::vector<Block> blocks = comparison_document(comparison).blocks;
  blocks.front().heading = "Verdicts";  // alone it needs none
  AnswerText answer = comparison_answer(comparison);
  answer.add("A", comparison.a);
  answer.add("B", comparison.b);
  std::string facts;
  for (const std::string& fact : scenario_facts(comparison)) {
    facts += html_paragraph("provenance", fact);
  }
  const std::string heading = comparison_heading(comparison);
  return {.name = heading,
          .heading = heading,
          .answer = std::move(answer),
          .lead_figures = {kComparedDistributions, kPairedDifferences},
          .lead_pipeline = leading_pair(comparison),
          .about = facts,
          .body = html(blocks),
          .reproduce = fmt::format("<dl>\n{}</dl>\n",
                                   html_command("This comparison", simbench_line(command)))};
}

std::string compare_html(const Comparison& comparison, const std::vector<std::string>& command) {
  return html_page({.title = fmt::format("simbench compare {}", comparison_heading(comparison)),
                    .subtitle = "which differences are real, seed by seed",
                    .main = html_article(comparison_article(comparison, command)),
                    .data = {figures_json(comparison_figures(comparison))}});
}

}  // namespace simbench::reports

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "algorithms/ports/stage.h"
#include "evaluation/sweep/ranking.h"
#include "evaluation/sweep/sweep_standing.h"
#include "reports/sweep/sweep_parts.h"
#include "reports/sweep/sweep_report.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"
#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

using evaluation::Metric;
using evaluation::RankedBy;
using evaluation::Ranking;
using evaluation::ResponseRow;
using evaluation::SweepPlan;

constexpr std::size_t kMostFlips = 3;
constexpr double kMattersFrom = 1.05;  // a smaller factor is none

// The plan and rows of the pipelines that a rig can run.
struct RunnablePart {
  SweepPlan plan;
  std::vector<ResponseRow> rows{};
};

std::vector<bool> runnable_pipelines(const SweepPlan& plan, RankedBy ranked_by) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario_text(plan.scenario_json, "the sweep's scenario");
  std::vector<bool> runnable;
  for (const std::string& name : plan.pipelines) {
    const auto found = std::ranges::find(scenario.pipelines, name, &scenarios::Pipeline::name);
    evaluation::Row row;
    if (found != scenario.pipelines.end()) copy_stages(*found, row);
    runnable.push_back(evaluation::standing_of_stages(row, ranked_by) ==
                       evaluation::RowStanding::kRanked);
  }
  return runnable;
}

RunnablePart runnable_part(const SweepPlan& plan, const std::vector<ResponseRow>& rows,
                           RankedBy ranked_by) {
  const std::vector<bool> runnable = runnable_pipelines(plan, ranked_by);
  RunnablePart part{.plan = plan};
  part.plan.pipelines.clear();
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < runnable.size(); ++i) {
    places.push_back(part.plan.pipelines.size());
    if (runnable[i]) part.plan.pipelines.push_back(plan.pipelines[i]);
  }
  for (ResponseRow& row : evaluation::without_failed(rows, ranked_by)) {
    if (!runnable[row.pipeline]) continue;
    row.pipeline = places[row.pipeline];
    part.rows.push_back(std::move(row));
  }
  return part;
}

// What the answer says of one pipeline: its rows that have a value, by value.
class Winner {
 public:
  Winner(const RunnablePart& part, const Metric& metric, std::size_t pipeline)
      : part_(part), metric_(metric), name_(part.plan.pipelines[pipeline]) {
    for (const ResponseRow& row : part.rows) {
      if (row.pipeline == pipeline && !std::isnan(value(row))) rows_.push_back(&row);
    }
    std::ranges::stable_sort(rows_, {}, [this](const ResponseRow* row) { return value(*row); });
  }

  bool exists() const { return !rows_.empty(); }

  std::string lead(const Ranking& ranking) const {
    const std::size_t points = part_.plan.points();
    const std::string values = points == 1
                                   ? time_text(value(*rows_.front()))
                                   : fmt::format("{} to {}", time_text(value(*rows_.front())),
                                                 time_text(value(*rows_.back())));
    if (part_.plan.pipelines.size() == 1) {
      return fmt::format("{}, the only pipeline here that a rig can run, has {} {} of {}.", name_,
                         article(), metric_.title, values);
    }
    std::size_t first = 0;
    std::size_t apart = 0;
    for (const evaluation::RankedPoint& point : ranking.points) {
      if (part_.plan.pipelines[point.order.front()] != name_) continue;
      ++first;
      if (point.is_apart.front()) ++apart;
    }
    return fmt::format(
        "{} is the best of the {} pipelines that a rig can run at {} of {} (beyond chance at {}): "
        "{} {}.",
        name_, part_.plan.pipelines.size(), first, counted(points, "point"), apart, metric_.title,
        values);
  }

  std::string range() const {
    if (rows_.size() < 2) return "";
    return fmt::format("It is best at {} and worst at {}.", place(*rows_.front()),
                       place(*rows_.back()));
  }

  // Which axis changes it most, the others being fixed.
  std::string what_matters() const {
    double largest = 0;
    std::string pointer;
    for (std::size_t axis = 0; axis < part_.plan.axes.size(); ++axis) {
      const double factor = factor_along(axis);
      if (factor <= largest) continue;
      largest = factor;
      pointer = part_.plan.axes[axis].pointers.front();
    }
    if (pointer.empty() || part_.plan.points() == 1) return "";
    if (largest < kMattersFrom) {
      return fmt::format("None of the swept values changes it by more than {:.0f} %.",
                         100 * (kMattersFrom - 1));
    }
    return fmt::format("{} matters {}: between its values the {} changes up to {} times.", pointer,
                       part_.plan.axes.size() > 1 ? "most" : "to it", metric_.title,
                       number_text(largest));
  }

  std::string sets() const {
    if (of_clocks(part_.plan)) return "";
    const Metric& precision = evaluation::metric("precision");
    const Metric& recall = evaluation::metric("recall");
    std::size_t known = 0;
    std::size_t sound = 0;
    for (const ResponseRow* row : rows_) {
      const double pure = row->value(precision);
      const double whole = row->value(recall);
      if (std::isnan(pure) || std::isnan(whole)) continue;
      ++known;
      const bool all_came = row->of("complete_pulses").median == row->of("due_pulses").median;
      if (pure == 1 && whole == 1 && all_came) ++sound;
    }
    if (known == 0) return "";
    return fmt::format(
        "Its sets can be trusted at {} of {}: no set mixes pulses, no pulse is "
        "missing.",
        sound, counted(known, "point"));
  }

  std::string certainty() const {
    double widest = 0;
    std::size_t fewest = part_.plan.seeds;
    for (const ResponseRow* row : rows_) {
      const std::vector<double>& values = row->of(metric_.sweep).values;
      const std::size_t seeds = evaluation::count_of_existing(values);
      fewest = std::min(fewest, seeds);
      const double relative =
          evaluation::median_interval(values, static_cast<std::int64_t>(seeds)).relative;
      if (!std::isnan(relative)) widest = std::max(widest, relative);
    }
    std::string text =
        fewest < kFewestSeeds
            ? few_seeds_text(fewest, " of a point")
            : fmt::format("The medians are known to {:.0f} % or better", std::ceil(100 * widest));
    const std::size_t without = part_.plan.points() - rows_.size();
    if (without > 0) text += fmt::format("; {} without a value", counted(without, "point"));
    return text + ".";
  }

 private:
  double value(const ResponseRow& row) const { return row.value(metric_); }
  std::string place(const ResponseRow& row) const { return leading_text(part_.plan, row.point); }
  const char* article() const { return *metric_.title == 'a' ? "an" : "a"; }

  // The largest quotient of two values that differ in this axis alone.
  double factor_along(std::size_t axis) const {
    std::map<std::vector<std::size_t>, std::pair<double, double>> ranges;
    for (const ResponseRow* row : rows_) {
      if (!(value(*row) > 0)) continue;
      std::vector<std::size_t> steps = part_.plan.steps(row->point);
      steps[axis] = 0;
      auto& [low, high] =
          ranges.try_emplace(steps, std::numeric_limits<double>::infinity(), 0.0).first->second;
      low = std::min(low, value(*row));
      high = std::max(high, value(*row));
    }
    double largest = 0;
    for (const auto& [steps, range] : ranges) {
      largest = std::max(largest, range.second / range.first);
    }
    return largest;
  }

  const RunnablePart& part_;
  const Metric& metric_;
  std::string name_;
  std::vector<const ResponseRow*> rows_;
};

// The pipeline that is first at most points; of equals the one that is named first.
std::size_t most_often_first(const Ranking& ranking, std::size_t pipelines) {
  std::vector<std::size_t> firsts(pipelines);
  for (const evaluation::RankedPoint& point : ranking.points) ++firsts[point.order.front()];
  return static_cast<std::size_t>(std::ranges::max_element(firsts) - firsts.begin());
}

std::string flips_text(const SweepPlan& plan, const Ranking& ranking) {
  if (plan.pipelines.size() < 2 || plan.points() < 2) return "";
  if (ranking.flips.empty()) return "No two of them change places within these values.";
  std::vector<std::string> sentences;
  for (const evaluation::RankingFlip& flip : ranking.flips) {
    if (sentences.size() == kMostFlips) break;
    sentences.push_back(flip_text(plan, flip));
  }
  std::string text = fmt::format("{}", fmt::join(sentences, " "));
  if (ranking.flips.size() > kMostFlips) {
    text += fmt::format(" {} change places, too.",
                        counted(ranking.flips.size() - kMostFlips, "more pair"));
  }
  return text;
}

// The pipelines of programs that ended, with their first failure.
std::string failures_text(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  struct Failure {
    std::size_t pipeline;
    const ResponseRow* first;
    std::size_t points = 0;
  };
  std::vector<Failure> failures;
  for (const ResponseRow& row : rows) {
    if (row.failed.empty()) continue;
    auto known = std::ranges::find(failures, row.pipeline, &Failure::pipeline);
    if (known == failures.end()) {
      known = failures.insert(known, {.pipeline = row.pipeline, .first = &row});
    }
    ++known->points;
  }
  std::vector<std::string> sentences;
  sentences.reserve(failures.size());
  for (const Failure& each : failures) {
    sentences.push_back(fmt::format("{} failed at {} of {}: a program ended; at {}: {}.",
                                    plan.pipelines[each.pipeline], each.points,
                                    counted(plan.points(), "point"),
                                    leading_text(plan, each.first->point), each.first->failed));
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

}  // namespace

AnswerText sweep_answer(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  const RankedBy ranked_by = evaluation::ranking_of(plan, rows);
  const RunnablePart part = runnable_part(plan, rows, ranked_by);
  if (part.plan.pipelines.empty()) return {.lead = "No pipeline here is one that a rig can run."};
  const Metric& metric = evaluation::ranked_metric(ranked_by);
  const Ranking ranking = evaluation::rank(part.plan, part.rows, metric);
  const Winner winner(part, metric, most_often_first(ranking, part.plan.pipelines.size()));
  if (!winner.exists()) {
    AnswerText none{
        .lead = fmt::format("No pipeline that a rig can run has a value of the {}.", metric.title)};
    none.add("Failed", failures_text(plan, rows));
    return none;
  }
  AnswerText answer{.lead = winner.lead(ranking)};
  answer.add("Failed", failures_text(plan, rows));
  answer.add("Range", winner.range());
  answer.add("Order", flips_text(part.plan, ranking));
  answer.add("Effect", winner.what_matters());
  answer.add("Sets", winner.sets());
  answer.add("Uncertain", winner.certainty());
  return answer;
}

}  // namespace simbench::reports

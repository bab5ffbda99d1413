#include "evaluation/run/part_progress.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace simbench::evaluation {

std::vector<std::size_t> programs_first(const std::vector<bool>& of_programs) {
  std::vector<std::size_t> order(of_programs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_partition(order, [&](std::size_t i) { return of_programs[i]; });
  return order;
}

PartPlan part_plan(std::vector<bool> of_programs, std::uint64_t seeds, std::size_t threads) {
  PartPlan plan{.pipelines = {}, .of_programs = std::move(of_programs), .threads = threads};
  const std::vector<std::size_t> order = programs_first(plan.of_programs);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    plan.pipelines.insert(plan.pipelines.end(), order.begin(), order.end());
  }
  return plan;
}

PartProgress::PartProgress(const Progress& progress, PartPlan plan, Clock clock)
    : progress_(progress),
      plan_(std::move(plan)),
      clock_(std::move(clock)),
      is_on_(progress.on_part && std::ranges::count(plan_.of_programs, true) > 0),
      runs_(plan_.pipelines.size()) {}

std::chrono::duration<double> PartProgress::steady_seconds() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

void PartProgress::begin(std::size_t run) {
  if (!is_on_) return;
  const std::lock_guard lock(mutex_);
  runs_[run].begin_s = clock_().count();
}

ShareDone PartProgress::share_of(std::size_t run) {
  if (!is_on_ || !plan_.of_programs[plan_.pipelines[run]]) return {};
  return [this, run](double share) { take(run, share); };
}

void PartProgress::end(std::size_t run) {
  if (is_on_) take(run, 1);
}

void PartProgress::take(std::size_t run, double share) {
  const std::lock_guard lock(mutex_);
  Run& taken = runs_[run];
  taken.took_s = clock_().count() - taken.begin_s;
  taken.share = std::clamp(share, 0.0, 1.0);
  tell();
}

double PartProgress::left_s() const {
  struct Measured {
    double took_s = 0;
    double shares = 0;
    double left = 0;  // runs
  };
  std::vector<Measured> pipelines(plan_.of_programs.size());
  for (std::size_t run = 0; run < runs_.size(); ++run) {
    Measured& pipeline = pipelines[plan_.pipelines[run]];
    pipeline.took_s += runs_[run].took_s;
    pipeline.shares += runs_[run].share;
    pipeline.left += 1 - runs_[run].share;
  }
  double left_s = 0;
  bool is_known = false;
  for (const Measured& pipeline : pipelines) {
    if (pipeline.took_s < kLeastMeasuredS || pipeline.shares < kLeastMeasuredShare) continue;
    left_s += pipeline.left * pipeline.took_s / pipeline.shares;
    is_known = true;
  }
  const auto threads = static_cast<double>(std::min(plan_.threads, runs_.size()));
  return is_known ? left_s / std::max(1.0, threads) : kNan;
}

void PartProgress::tell() {
  const double done = std::accumulate(runs_.begin(), runs_.end(), 0.0,
                                      [](double sum, const Run& run) { return sum + run.share; });
  progress_.on_part({.done = done, .total = runs_.size(), .left_s = left_s()});
}

}  // namespace simbench::evaluation

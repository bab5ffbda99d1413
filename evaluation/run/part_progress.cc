#include "evaluation/run/part_progress.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace simbench::evaluation {

std::vector<std::size_t> programs_first(const std::vector<bool>& of_programs) {
  std::vector<std::size_t> order(of_programs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return of_programs[i]; });
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
  runs_[run].has_begun = true;
  runs_[run].begin_s = clock_().count();
}

ShareDone PartProgress::share_of(std::size_t run) {
  if (!is_on_ || !plan_.of_programs[plan_.pipelines[run]]) return {};
  return [this, run](double share) {
    if (share >= kStartedShare) take(run, share);
  };
}

void PartProgress::end(std::size_t run) {
  if (is_on_) take(run, 1);
}

void PartProgress::take(std::size_t run, double share) {
  const std::lock_guard lock(mutex_);
  Run& taken = runs_[run];
  taken.share = std::clamp(share, 0.0, 1.0);
  const double since_begin_s = clock_().count() - taken.begin_s;
  if (!taken.start_s) {
    taken.start_s = since_begin_s;
    taken.first_share = taken.share;
  }
  taken.took_s = since_begin_s - *taken.start_s;
  tell();
}

void PartProgress::Measured::add(const Run& run) {
  if (!run.has_begun) {
    ++not_begun;
    return;
  }
  shares_left += 1 - run.share;
  if (!run.start_s) return;
  ++started;
  start_s += *run.start_s;
  first_shares += run.first_share;
  took_s += run.took_s;
  shares += run.share - run.first_share;
}

bool PartProgress::Measured::is_known() const {
  const bool is_of_wholes = started > 0 && first_shares == started;  // of runs that tell no shares
  return is_of_wholes || (took_s >= kLeastMeasuredS && shares >= kLeastMeasuredShare);
}

double PartProgress::Measured::each_share_s() const { return shares > 0 ? took_s / shares : 0; }

double PartProgress::Measured::each_run_s() const {
  return (start_s + each_share_s() * (started - first_shares)) / started;
}

double PartProgress::left_s() const {
  std::vector<Measured> pipelines(plan_.of_programs.size());
  for (std::size_t run = 0; run < runs_.size(); ++run) {
    pipelines[plan_.pipelines[run]].add(runs_[run]);
  }
  double left_s = 0;
  double known = 0;  // pipelines of programs
  double known_run_s = 0;
  double unknown_runs = 0;
  for (std::size_t i = 0; i < pipelines.size(); ++i) {
    const Measured& each = pipelines[i];
    if (each.is_known()) {
      left_s += each.each_share_s() * each.shares_left + each.each_run_s() * each.not_begun;
      if (!plan_.of_programs[i]) continue;
      ++known;
      known_run_s += each.each_run_s();
    } else if (plan_.of_programs[i]) {
      unknown_runs += each.shares_left + each.not_begun;
    }
  }
  if (known == 0) return kNan;
  left_s += unknown_runs * known_run_s / known;
  return left_s / static_cast<double>(std::clamp(plan_.threads, std::size_t{1}, runs_.size()));
}

void PartProgress::tell() {
  const double done = std::accumulate(runs_.begin(), runs_.end(), 0.0,
                                      [](double sum, const Run& run) { return sum + run.share; });
  progress_.on_part({.done = done, .total = runs_.size(), .left_s = left_s()});
}

}  // namespace simbench::evaluation

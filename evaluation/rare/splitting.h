// How often something rare happens, by importance splitting: the probability of what a run does
// once in a million, without a million runs.
//
// A run is a function of independent random numbers. It has a level, which grows towards the event
// (say its largest spread), and a share: how much of it is the event (of its sets those beyond a
// bound), which is 0 wherever the level is not above the bound. Wanted is the mean share over all
// runs. Between ordinary runs and the bound lie levels. Many runs start. Some of those above the
// first level each begin a chain: a random part of a run's numbers is changed by a rule that keeps
// their law and is reversible; the changed run is next in the chain if it stays above the level,
// else the run before counts once more. All runs of the chains together have the law of runs above
// that level; those above the next level begin the next chains, and so on to the bound. The
// estimate is the product of the parts that are above the levels times the mean share of the last
// chains' runs.
//
// Contract
//  - Unbiased: levels, sizes of the changes and the number of repeats are found by a pilot and then
//    fixed; the moves keep the conditional law. How well they mix only decides the variance.
//  - The interval is empirical: the whole is repeated independently up to `repeats` times, fewer
//    (at least 2) if `most_runs` would be exceeded, and the 95 % interval is Cox's for the mean of
//    numbers whose logarithms are nearly normal, with Student's quantile. It holds as far as the
//    repeats show the spread: an event that is reached in ways that few runs find at first is
//    underestimated by most repeats, and neither this nor any other splitting shows that. Compare
//    with count_rare() where that is affordable.
//  - Deterministic: the same function, options and seed give the same result with any number of
//    threads: what is counted is runs, not seconds. The function is called from several threads at
//    once, with no two runs of the same numbers.
//  - Too rare: below `least_probability`, where no run gets any further, or where the pilot has
//    used half of `most_runs`, there is no estimate but is_below.
//
// Many starts, each of which is new, keep kinds of rigs apart that chains seldom cross; long chains
// forget where they began.
//
// Measured: sums of 20 normal numbers and the largest of 24 exponentials at 1e-6 within a factor of
// 1.5, at less than a hundredth of brute force (tests/evaluation/rare). In a simulated world of two
// hosts and four cameras (docs/benchmarks.md, "Rare sets") 1.6e-4 and 1.9e-4 beside 1.72e-4 of
// brute force, and 8.8e-7 [1.9e-7, 5.1e-6] at some 1/40 of its CPU time, not the 1/100 aimed at:
// there some hundred numbers decide an event, so that chains forget slowly. One estimate of five
// near 1e-4, with short chains and four repeats, was half of brute force and its interval beside
// it: intervals of few repeats are too narrow where the repeats are skew.
//
// Source: Au and Beck, "Estimation of small failure probabilities in high dimensions by subset
// simulation", Probabilistic Engineering Mechanics 16(4), 2001 (all runs of the chains count);
// Cerou, Del Moral, Furon and Guyader, "Sequential Monte Carlo for rare event estimation",
// Statistics and Computing 22, 2012 (fixed levels are unbiased); Land, "An evaluation of
// approximate confidence interval estimation methods for lognormal means", Technometrics 14(1),
// 1972 (Cox's). Cost: starts + chains * moves * levels runs a repeat, for the pilot nearly twice
// that.
//
//   const RareEstimate estimate = estimate_rare(rare_function, {.bound = 0.1}, nullptr);
//   estimate.probability;  // in [estimate.low, estimate.high]
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {

// A change of a run's numbers: of a share of them, which its key chooses. They are drawn anew (step
// 1), or moved by a step that keeps their law.
struct RareChange {
  std::uint64_t key = 0;
  double share = 1;
  double step = 1;
};

// A run: the numbers of a seed, changed in turn.
struct RareRun {
  std::uint64_t seed = 0;
  std::vector<RareChange> changes{};
};

struct RareScore {
  double level = 0;
  double share = 0;  // 0 where the level is not above the bound
};

using RareFunction = std::function<RareScore(const RareRun& run)>;

struct SplittingOptions {
  double bound = 0;
  std::uint64_t seed = 1;
  std::size_t starts = 1024;  // runs that start, more than chains
  std::size_t chains = 64;    // kept at each level
  std::size_t moves = 8;      // of each of them, at least 2
  std::size_t repeats = 8;    // at least 2
  std::uint64_t most_runs = std::numeric_limits<std::uint64_t>::max();
  double least_probability = 1e-10;
  unsigned jobs = 0;
  const std::atomic<bool>* cancel = nullptr;
};

struct RareEstimate {
  double probability = kNan;
  double low = kNan;  // the 95 % interval
  double high = kNan;
  bool is_below = false;          // too rare: nothing above but `high`, of the level reached
  std::uint64_t runs = 0;         // that were made, the pilot's too
  std::vector<double> levels{};   // below the bound
  std::vector<double> repeats{};  // the estimate of each
};

// Throws what the function throws; EvaluationCancelled. `progress` counts runs, of an estimated
// number.
RareEstimate estimate_rare(const RareFunction& run, const SplittingOptions& options,
                           const Progress& progress);

// Estimates by brute force, from `runs` unchanged runs (at least 2). The interval is Student's for
// the mean over runs, since the sets of a run are not independent; without any event its upper end
// is that of a binomial over runs.
RareEstimate count_rare(const RareFunction& run, std::uint64_t runs,
                        const SplittingOptions& options, const Progress& progress);

}  // namespace simbench::evaluation

// How often something rare happens, by importance splitting: the probability of what a run does
// once in a million, without a million runs.
//
// A run is a function of independent random numbers. It has a level, which grows towards the event
// (say its largest spread), and a share: how much of it is the event (of its sets those beyond a
// bound), which is 0 wherever the level is not above the bound. Wanted is the mean share over all
// runs. Between ordinary runs and the bound lie levels, each reached by a fixed part of the runs
// that reached the one before. Some runs start; those above the first level are kept and copied,
// and each copy is moved: a random part of its numbers is changed by a rule that keeps their law
// and is reversible, and the change is accepted if the run stays above the level. So the copies
// become different runs with the law of runs above that level, and so on to the bound. The estimate
// is the product of the parts times the mean share of the last runs.
//
// Contract
//  - Unbiased: levels and sizes of the changes are found by a pilot and then fixed; the moves keep
//    the conditional law. How well they mix only decides the variance.
//  - The interval is empirical: the whole is repeated independently `repeats` times, and the 95 %
//    interval is Cox's for the mean of numbers whose logarithms are nearly normal, with Student's
//    quantile. It holds as far as the repeats show the spread: an event that is reached in ways
//    that few runs find at first is underestimated by most repeats, and neither this nor any other
//    splitting shows that. Compare with count_rare() where that is affordable.
//  - Deterministic: the same function, options and seed give the same result with any number of
//    threads. The function is called from several threads at once, with no two runs of the same
//    numbers.
//  - Too rare: below `least_probability`, or where no run gets any further, there is no estimate
//  but
//    is_below.
//
// Measured: sums of 20 normal numbers and the largest of 24 exponentials at 1e-6 within a factor of
// 1.5, at less than a hundredth of brute force (tests/evaluation/rare). In a simulated world whose
// events come by rigs (host.ptp_e2e_software of leaderboard_lan, 2 hosts, 4 cameras, 60 pulses):
// 7.1e-4 beside 7.9e-4 of brute force; 4.3e-5 [1.7e-5, 1.2e-4] and, of another seed, 5.5e-5
// [1.1e-5, 4.0e-4] beside 1.07e-4 [5.3e-5, 2.2e-4]: a factor of two, which the intervals hold.
//
// Source: Au and Beck, "Estimation of small failure probabilities in high dimensions by subset
// simulation", Probabilistic Engineering Mechanics 16(4), 2001; Cerou, Del Moral, Furon and
// Guyader, "Sequential Monte Carlo for rare event estimation", Statistics and Computing 22, 2012
// (fixed levels are unbiased); Land, "An evaluation of approximate confidence interval estimation
// methods for lognormal means", Technometrics 14(1), 1972 (Cox's). Cost: (repeats + 1) * runs * (1
// + moves * levels) runs; the relative error grows with the root of the number of levels, thus with
// the logarithm of the probability.
//
//   const RareEstimate estimate = estimate_rare(rare_function, {.bound = 0.1}, nullptr);
//   estimate.probability;  // in [estimate.low, estimate.high]
#ifndef SIMBENCH_EVALUATION_RARE_SPLITTING_H_
#define SIMBENCH_EVALUATION_RARE_SPLITTING_H_

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
  std::size_t moves = 4;      // of each of them, at least 2
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
  bool is_below = false;          // too rare: nothing above but `high`, which is a guide only
  std::uint64_t runs = 0;         // that were made, the pilot's too
  std::vector<double> levels{};   // below the bound
  std::vector<double> repeats{};  // the estimate of each
};

// Throws what the function throws; EvaluationCancelled. `progress` counts runs, of an estimated
// number.
RareEstimate estimate_rare(const RareFunction& run, const SplittingOptions& options,
                           const Progress& progress);

// The same by brute force, from `runs` unchanged runs (at least 2). The interval is Student's for
// the mean over runs, since the sets of a run are not independent; without any event its upper end
// is that of a binomial over runs.
RareEstimate count_rare(const RareFunction& run, std::uint64_t runs,
                        const SplittingOptions& options, const Progress& progress);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_RARE_SPLITTING_H_

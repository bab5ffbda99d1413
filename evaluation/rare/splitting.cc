#include "evaluation/rare/splitting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/run/jobs.h"
#include "laws/generators.h"

namespace simbench::evaluation {
namespace {

// A hash of numbers in turn.
std::uint64_t hash_of(std::initializer_list<std::uint64_t> numbers) {
  std::uint64_t hash = SplitMix64::kIncrement;
  for (const std::uint64_t number : numbers) {
    hash = SplitMix64::mix(hash + number + SplitMix64::kIncrement);
  }
  return hash;
}

// What a number is hashed for.
enum Purpose : std::uint8_t { kStart, kOrder, kKey, kKind };

// A run with its score.
struct Particle {
  RareRun run;
  RareScore score;
};

// Kinds of changes: of some numbers, which are drawn anew or moved. Their size is the share of
// these.
constexpr std::array<double, 2> kChangeSteps = {1, 0.5};
constexpr std::size_t kKinds = kChangeSteps.size();

// How large changes are at a level, and how many were accepted.
struct Moves {
  std::array<double, kKinds> sizes = {0.1, 0.1};
  std::array<std::uint64_t, kKinds> tried{};
  std::array<std::uint64_t, kKinds> accepted{};

  double accepted_part() const {
    return static_cast<double>(std::accumulate(accepted.begin(), accepted.end(), 0UL)) /
           static_cast<double>(std::accumulate(tried.begin(), tried.end(), 0UL));
  }
};

constexpr std::uint64_t kPilot = 0;                // the repeats count from 1
constexpr std::uint64_t kLevelsApart = 1'000'000;  // more than there are levels
constexpr std::size_t kLeastRepeats = 2;

class Splitting {
 public:
  Splitting(const RareFunction& run, const SplittingOptions& options, const Progress& progress)
      : run_(run), options_(options), progress_(progress) {
    SIMBENCH_ASSERT(options.moves > 1 && options.chains > 0 && options.starts > options.chains,
                    "some runs are kept and moved");
    constexpr std::uint64_t kGuessedLevels = 8;
    expect(runs_of_repeat(kGuessedLevels) * (options.repeats + 1));
  }

  RareEstimate estimate() {
    RareEstimate estimate;
    estimate.is_below = !find_levels();
    estimate.levels = levels_;
    if (estimate.is_below) {
      estimate.high = reached_;
    } else {
      repeat(estimate);
    }
    estimate.runs = done_;
    return estimate;
  }

  RareEstimate count(std::uint64_t runs) {
    expected_runs_ = runs;
    std::vector<double> shares(runs);
    run_all(runs, [&](std::size_t i) {
      shares[i] = scored({.seed = hash_of({options_.seed, kStart, kPilot, i})}).share;
    });
    RareEstimate estimate{.runs = runs};
    estimate.probability = mean_of(shares);
    const auto events = std::ranges::count_if(shares, [](double share) { return share > 0; });
    if (events == 0) {
      estimate.low = 0;
      estimate.high = binomial_interval(0, static_cast<std::int64_t>(runs)).high;
      return estimate;
    }
    const double half = half_width(shares) / estimate.probability;
    estimate.low = estimate.probability * std::exp(-half);
    estimate.high = estimate.probability * std::exp(half);
    return estimate;
  }

 private:
  void run_all(std::size_t count, const Job& job) {
    if (!run_jobs(count, {.threads = options_.jobs, .cancel = options_.cancel}, job)) {
      throw EvaluationCancelled("cancelled", {});
    }
  }

  std::uint64_t runs_of_repeat(std::size_t levels) const {
    return options_.starts + options_.chains * options_.moves * levels;
  }

  void expect(std::uint64_t runs) {
    expected_runs_ = std::max(done_, std::min(runs, options_.most_runs));
  }

  RareScore scored(const RareRun& run) {
    const RareScore score = run_(run);
    const std::lock_guard lock(mutex_);
    ++done_;
    expected_runs_ = std::max(expected_runs_, done_);
    if (progress_) progress_(done_, expected_runs_);
    return score;
  }

  std::vector<Particle> started(std::uint64_t repeat) {
    std::vector<Particle> particles(options_.starts);
    run_all(particles.size(), [&](std::size_t i) {
      particles[i].run.seed = hash_of({options_.seed, kStart, repeat, i});
      particles[i].score = scored(particles[i].run);
    });
    return particles;
  }

  // Keeps the particles above the level, in a random order. Returns their part.
  double keep(std::vector<Particle>& particles, double level, std::uint64_t repeat,
              std::size_t stage) const {
    const auto all = static_cast<double>(particles.size());
    std::erase_if(particles, [level](const Particle& each) { return !(each.score.level > level); });
    std::vector<std::pair<std::uint64_t, std::size_t>> order;
    order.reserve(particles.size());
    for (std::size_t i = 0; i < particles.size(); ++i) {
      order.emplace_back(hash_of({options_.seed, kOrder, repeat, stage, i}), i);
    }
    std::ranges::sort(order);
    std::vector<Particle> kept;
    kept.reserve(particles.size());
    for (const auto& [hash, i] : order) kept.push_back(std::move(particles[i]));
    particles = std::move(kept);
    return static_cast<double>(particles.size()) / all;
  }

  // Chains of `moves` runs within the level, from the particles in turn; all of their runs are the
  // new particles.
  void move(std::vector<Particle>& particles, double level, Moves& moves, std::uint64_t repeat,
            std::size_t stage) {
    const std::array<double, kKinds> sizes = moves.sizes;
    std::vector<Particle> moved(options_.chains * options_.moves);
    std::vector<Moves> of_chain(options_.chains);
    run_all(options_.chains, [&](std::size_t i) {
      const Particle* before = &particles[i % particles.size()];
      for (std::size_t step = 0; step < options_.moves; ++step) {
        // The number of a move alone decides its kind: each is reversible by itself.
        const std::size_t kind = (i + step) % kKinds;
        Particle& after = moved[i * options_.moves + step];
        after.run = before->run;
        after.run.changes.push_back({.key = hash_of({options_.seed, kKey, repeat, stage, i, step}),
                                     .share = sizes[kind],
                                     .step = kChangeSteps[kind]});
        after.score = scored(after.run);
        ++of_chain[i].tried[kind];
        if (after.score.level > level) {
          ++of_chain[i].accepted[kind];
        } else {
          after = *before;
        }
        before = &after;
      }
    });
    particles = std::move(moved);
    for (const Moves& each : of_chain) {
      for (std::size_t kind = 0; kind < kKinds; ++kind) {
        moves.tried[kind] += each.tried[kind];
        moves.accepted[kind] += each.accepted[kind];
      }
    }
  }

  // The next level makes smaller changes where too few were accepted, larger ones where many were.
  static std::array<double, kKinds> adapted(const Moves& moves) {
    constexpr double kFew = 0.2;
    constexpr double kMany = 0.4;
    constexpr double kLeast = 1e-5;
    std::array<double, kKinds> sizes = moves.sizes;
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
      if (moves.tried[kind] == 0) continue;
      const double part =
          static_cast<double>(moves.accepted[kind]) / static_cast<double>(moves.tried[kind]);
      if (part < kFew) sizes[kind] = std::max(kLeast, sizes[kind] * std::max(part / kFew, 0.1));
      if (part > kMany) sizes[kind] = std::min(1.0, sizes[kind] * 1.6);
    }
    return sizes;
  }

  // The level that as many particles are above as there are chains; where some are at one level, a
  // lower one that not too few are above. Nothing if there is none.
  std::optional<double> next_level(const std::vector<Particle>& particles) const {
    std::vector<double> levels(particles.size());
    std::ranges::transform(particles, levels.begin(),
                           [](const Particle& each) { return each.score.level; });
    std::ranges::sort(levels, std::greater<>());
    const std::size_t fewest = std::max<std::size_t>(options_.chains / 4, 1);
    for (std::size_t i = options_.chains; i < levels.size(); ++i) {
      const auto first = std::ranges::lower_bound(levels, levels[i], std::greater<>());
      if (static_cast<std::size_t>(first - levels.begin()) >= fewest) return levels[i];
    }
    return std::nullopt;
  }

  // The pilot's chains at a level, from the kept particles again until enough is accepted and not
  // all are at one level. Returns the sizes of the changes that this took.
  std::array<double, kKinds> mixed(std::vector<Particle>& particles, double level) {
    constexpr std::uint64_t kMostRounds = 8;
    constexpr double kEnough = 0.1;
    const std::vector<Particle> kept = particles;
    Moves moves;
    if (!moves_.empty()) moves.sizes = moves_.back();
    for (std::uint64_t round = 0; round < kMostRounds; ++round) {
      const std::uint64_t stage = kLevelsApart * round + levels_.size();
      particles = kept;
      move(particles, level, moves, kPilot, stage);
      const bool is_enough = moves.accepted_part() >= kEnough && next_level(particles);
      moves = {.sizes = adapted(moves), .tried = {}, .accepted = {}};
      if (is_enough) break;
    }
    return moves.sizes;
  }

  // The pilot. False if the bound is too far.
  bool find_levels() {
    std::vector<Particle> particles = started(kPilot);
    while (reached_ > options_.least_probability && done_ < options_.most_runs / 2) {
      const std::optional<double> level = next_level(particles);
      if (!level) return particles.front().score.level > options_.bound;
      if (*level >= options_.bound) return true;
      reached_ *= keep(particles, *level, kPilot, levels_.size());
      levels_.push_back(*level);
      moves_.push_back(mixed(particles, *level));
      expect(std::max(expected_runs_, done_ * (options_.repeats + 1)));
    }
    return false;
  }

  // Repeats until they are enough.
  void repeat(RareEstimate& estimate) {
    const std::uint64_t one = runs_of_repeat(levels_.size());
    expect(done_ + one * options_.repeats);
    while (estimate.repeats.size() < options_.repeats) {
      const std::size_t made = estimate.repeats.size();
      if (made >= kLeastRepeats && done_ + one > options_.most_runs) break;
      estimate.repeats.push_back(repeat_of(made + 1));
    }
    set_interval(estimate);
  }

  double repeat_of(std::uint64_t repeat) {
    std::vector<Particle> particles = started(repeat);
    double product = 1;
    for (std::size_t stage = 0; stage < levels_.size(); ++stage) {
      product *= keep(particles, levels_[stage], repeat, stage);
      if (product == 0) return 0;
      Moves moves{.sizes = moves_[stage], .tried = {}, .accepted = {}};
      move(particles, levels_[stage], moves, repeat, stage);
    }
    double shares = 0;
    for (const Particle& each : particles) shares += each.score.share;
    return product * shares / static_cast<double>(particles.size());
  }

  // Half of the width of the 95 % interval of their mean.
  static double half_width(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    return student_t_exceeded(0.025, n - 1) * standard_deviation(values) / std::sqrt(n);
  }

  // The repeats are products, so their logarithms are nearly normal: Cox's interval for the mean of
  // such numbers, with Student's quantile. Where some are 0, that of their mean.
  static void set_interval(RareEstimate& estimate) {
    estimate.probability = mean_of(estimate.repeats);
    if (estimate.probability == 0) {
      estimate.is_below = true;
      return;
    }
    const auto n = static_cast<double>(estimate.repeats.size());
    double centre = std::log(estimate.probability);
    double half = half_width(estimate.repeats) / estimate.probability;
    if (std::ranges::count(estimate.repeats, 0.0) == 0) {
      std::vector<double> logs(estimate.repeats.size());
      std::ranges::transform(estimate.repeats, logs.begin(), [](double p) { return std::log(p); });
      const double variance = std::pow(standard_deviation(logs), 2);
      centre = mean_of(logs) + variance / 2;
      half = student_t_exceeded(0.025, n - 1) *
             std::sqrt(variance / n + variance * variance / (2 * (n - 1)));
    }
    estimate.low = std::min(estimate.probability, std::exp(centre - half));
    estimate.high = std::clamp(std::exp(centre + half), estimate.probability, 1.0);
  }

  const RareFunction& run_;
  const SplittingOptions& options_;
  const Progress& progress_;
  double reached_ = 1;  // the pilot's probability of the last level
  std::vector<double> levels_;
  std::vector<std::array<double, kKinds>> moves_;  // sizes of the changes at each level
  std::mutex mutex_;                               // guards what follows
  std::uint64_t done_ = 0;
  std::uint64_t expected_runs_ = 0;
};

}  // namespace

RareEstimate estimate_rare(const RareFunction& run, const SplittingOptions& options,
                           const Progress& progress) {
  return Splitting(run, options, progress).estimate();
}

RareEstimate count_rare(const RareFunction& run, std::uint64_t runs,
                        const SplittingOptions& options, const Progress& progress) {
  return Splitting(run, options, progress).count(runs);
}

}  // namespace simbench::evaluation

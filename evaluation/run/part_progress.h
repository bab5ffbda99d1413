// How far an evaluation with real programs is, run by run and within runs, and how long the rest
// takes by the speed measured so far.
//
// A run of real programs takes seconds or minutes where one of an algorithm takes a moment, and
// nobody knows which before: programs decide how often they ask for the time. Runs of one pipeline
// take about as long: until kStartedShare is over, while programs start, and from then on in equal
// times for equal shares. What both took in the runs so far is the estimate for the
// pipeline's rest, and their mean that of other programs; algorithms that have not begun are not
// counted, so runs of programs come first. Nothing is known before kLeastMeasuredS and
// kLeastMeasuredShare of one.
//
// Thread-safe. Costs nothing where nobody asks (Progress::on_part).
//
//   const Progress told([](std::uint64_t done, std::uint64_t total) { print(done, total); });
//   PartProgress parts(told, part_plan({true, false}, /*seeds=*/2, /*threads=*/2));
//   parts.begin(0);
//   const ShareDone share_done = parts.share_of(0);
//   share_done(0.5);
//   parts.end(0);
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "recording/share_done.h"

namespace simbench::evaluation {

struct PartPlan {
  std::vector<std::size_t> pipelines{};  // of each run, in the order in which runs begin
  std::vector<bool> of_programs{};       // by pipeline
  std::size_t threads = 1;
};

// Returns the places of those of programs, then those of the others, each in order.
std::vector<std::size_t> programs_first(const std::vector<bool>& of_programs);
// In that order, seed by seed.
PartPlan part_plan(std::vector<bool> of_programs, std::uint64_t seeds, std::size_t threads);

class PartProgress {
 public:
  using Clock = std::function<std::chrono::duration<double>()>;

  static constexpr double kStartedShare = 0.001;
  static constexpr double kLeastMeasuredS = 0.5;
  static constexpr double kLeastMeasuredShare = 0.01;  // of one run

  // `progress` must outlive this; `clock` counts seconds from any zero.
  PartProgress(const Progress& progress, PartPlan plan, Clock clock = steady_seconds);

  // Whether anybody is to be told: there is a run of programs, and somebody asks.
  bool is_on() const { return is_on_; }
  void begin(std::size_t run);
  // For the run's backend; empty if it is off.
  ShareDone share_of(std::size_t run);
  void end(std::size_t run);

 private:
  struct Run {
    bool has_begun = false;
    double begin_s = 0;
    std::optional<double> start_s{};  // until kStartedShare
    double first_share = 0;
    double took_s = 0;  // since then
    double share = 0;
  };
  // The runs of a pipeline together.
  struct Measured {
    double start_s = 0;
    double started = 0;  // runs
    double took_s = 0;
    double shares = 0;
    double shares_left = 0;  // of the runs that have begun
    double not_begun = 0;    // runs
    double first_shares = 0;

    void add(const Run& run);
    bool is_known() const;
    // They exist if is_known().
    double each_share_s() const;
    double each_run_s() const;
  };

  static std::chrono::duration<double> steady_seconds();
  void take(std::size_t run, double share);
  // With the lock.
  double left_s() const;
  void tell();

  const Progress& progress_;
  const PartPlan plan_;
  const Clock clock_;
  const bool is_on_;
  std::mutex mutex_;  // guards what follows
  std::vector<Run> runs_;
};

}  // namespace simbench::evaluation

// The plan of a sweep: every combination of the steps of its axes, each pipeline, each seed.
//
// An axis states which parameters of the scenario take which values, step by step:
//
//   /usb/delivery_jitter_transfers=0:0.4:0.1           a range, start:stop:step, stop included
//   /trigger/rate_hz=15,30,45                          a list: numbers, words, true, false
//   /hosts/count=2:6:2+/cameras/count=6:18:6           several in lockstep, where one alone
//                                                      would make no valid scenario
//
// The values of the first of an axis differ. Value i of a range is start + i * step, never a sum of
// steps. For decimals it is the decimal that a person expects: 0:1:0.1 has 0.3, not
// 0.30000000000000004. A value's text is the shortest that reads back as the same number.
//
// A point is one combination; the first axis varies slowest. A run is one pipeline at one point
// with one seed: a capture, or a run of the hosts' clocks alone (evaluation/clock_run). Runs are
// numbered point by point, pipeline by pipeline, seed by seed. The results depend on the plan and
// the program alone, so the plan identifies a sweep.
//
//   const SweepRequest request = {.scenario = "18cam_6host_45fps",
//                                 .axes = {"/trigger/rate_hz=15,30,45"}, .seeds = 32};
//   const SweepPlan plan = make_plan(request);
//   check_points(plan, request, 0);                    // throws before anything has run
//   for (std::size_t run = 0; run < plan.runs(); ++run) use(plan.run(run));
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/scoring/results.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {

struct SweepAxis {
  std::vector<std::string> pointers;             // JSON pointers; more than one: in lockstep
  std::vector<std::vector<std::string>> values;  // by pointer, then by step

  std::size_t steps() const { return values.front().size(); }
};

// The most steps of a range; more are a misplaced zero.
inline constexpr std::size_t kMostSteps = 100'000;

// Throws scenarios::InputError, "--sweep TEXT: found ..., allowed ...": no pointer, no value, an
// empty or endless range, a value twice, pointers in lockstep with different numbers of values.
SweepAxis parse_axis(const std::string& text);

inline constexpr std::size_t kMostRuns = 10'000'000;

// What the user states.
struct SweepRequest {
  std::string scenario;                          // name or path
  std::vector<scenarios::Override> overrides{};  // for all points
  std::vector<std::string> axes{};               // as parse_axis() reads them; none: one point
  std::vector<std::string> pipelines{};          // empty: all of the scenario
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 32;
  ResultKind kind = ResultKind::kCaptures;
  ClockPeriod clock_period{};           // of clock runs
  std::optional<RankedBy> ranked_by{};  // nothing: as the scenario says
};

struct SweepRun {
  std::size_t point = 0;
  std::size_t pipeline = 0;
  std::uint64_t seed = 0;
};

struct SweepPlan {
  std::string scenario;                 // its name
  scenarios::Derivation derivation{};   // of the scenario without the axes
  bool draws_load = false;              // Scenario::draws_load(), of that scenario or by an axis
  RankedBy ranked_by = RankedBy::kAmd;  // of that scenario; sweep_standing.h has what is
  std::string scenario_json;            // resolved, with the overrides for all points
  std::vector<SweepAxis> axes;
  std::vector<std::string> pipelines;
  std::vector<std::string> left_out{};  // notes on pipelines that clock runs leave out
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 0;
  ResultKind kind = ResultKind::kCaptures;
  ClockPeriod clock_period{};  // of clock runs

  std::size_t points() const;
  std::size_t runs() const { return points() * pipelines.size() * seeds; }
  SweepRun run(std::size_t index) const;
  // The step of each axis.
  std::vector<std::size_t> steps(std::size_t point) const;
  // The pointers of all axes, in order, and their values at a point.
  std::vector<std::string> pointers() const;
  std::vector<std::string> values(std::size_t point) const;
  std::vector<scenarios::Override> overrides(std::size_t point) const;
  // "/hosts/count=4, /cameras/count=12"; "as it is" without axes.
  std::string point_text(std::size_t point) const;
};

// Throws scenarios::InputError for a scenario that is invalid without the sweep, an invalid axis,
// an unknown pipeline, a pointer swept twice, more than kMostRuns runs; for clock runs also what
// clock_pipelines() refuses.
SweepPlan make_plan(const SweepRequest& request);

// Loads the scenario of every point. Throws an InputError that names the first refused point.
// Returns the texts of scenarios::warnings(), each once. Some milliseconds for each point and
// thread (0: all cores).
std::vector<std::string> check_points(const SweepPlan& plan, const SweepRequest& request,
                                      unsigned threads);

}  // namespace simbench::evaluation

// What a sweep runs: every combination of the steps of its axes, each pipeline, each seed.
//
// A point is one combination; the first axis varies slowest. A run is one pipeline at one point
// with one seed, and runs are numbered point by point, pipeline by pipeline, seed by seed. The plan
// is all that the results depend on, beside the program, and so what tells one sweep from another.
//
//   const SweepRequest request = {.scenario = "18cam_6host_45fps",
//                                 .axes = {"/trigger/rate_hz=15,30,45"}, .seeds = 32};
//   const SweepPlan plan = make_plan(request);
//   check_points(plan, request, 0);                    // throws before anything has run
//   for (std::size_t run = 0; run < plan.runs(); ++run) use(plan.run(run));
#ifndef SIMBENCH_EVALUATION_SWEEP_SWEEP_PLAN_H_
#define SIMBENCH_EVALUATION_SWEEP_SWEEP_PLAN_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/sweep/sweep_axis.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {

inline constexpr std::size_t kMostRuns = 10'000'000;

// As a user asks for it.
struct SweepRequest {
  std::string scenario;                          // name or path
  std::vector<scenarios::Override> overrides{};  // for all points
  std::vector<std::string> axes{};               // as parse_axis() reads them; none: one point
  std::vector<std::string> pipelines{};          // empty: all of the scenario
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 32;
};

struct SweepRun {
  std::size_t point = 0;
  std::size_t pipeline = 0;
  std::uint64_t seed = 0;
};

struct SweepPlan {
  std::string scenario;       // its name
  std::string scenario_json;  // resolved, with the overrides for all points
  std::vector<SweepAxis> axes;
  std::vector<std::string> pipelines;
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 0;

  std::size_t points() const;
  std::size_t runs() const { return points() * pipelines.size() * seeds; }
  SweepRun run(std::size_t index) const;
  // Which step each axis stands at.
  std::vector<std::size_t> steps(std::size_t point) const;
  // All pointers of all axes, in order, and their values at a point.
  std::vector<std::string> pointers() const;
  std::vector<std::string> values(std::size_t point) const;
  std::vector<scenarios::Override> overrides(std::size_t point) const;
  // "/hosts/count=4, /cameras/count=12"; "as it is" of no axes.
  std::string point_text(std::size_t point) const;
};

// The scenario as it is without the sweep must be valid. Throws scenarios::InputError for that, for
// an axis, for pipelines that it does not have, a pointer swept twice, more than kMostRuns runs.
SweepPlan make_plan(const SweepRequest& request);

// Loads the scenario of every point. The first one that is refused is thrown as an InputError that
// names it. Returns what scenarios::warnings() has to say, each text once. Some milliseconds for
// each point and thread (0: all cores).
std::vector<std::string> check_points(const SweepPlan& plan, const SweepRequest& request,
                                      unsigned threads);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SWEEP_SWEEP_PLAN_H_

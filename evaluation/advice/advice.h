// Advice for a buyer: which rigs meet the requirements, with what probability, the cheapest first.
//
// Every option (rig_options.h) is a world of its own, in which all its host synchronisations,
// device times and gatherings run as pipelines; pipelines that differ in the latter two share
// captures. A seed is a rig with its clocks, cables and loads. The probability of meeting the
// requirements is the share of seeds that meet all of them at once, with its exact binomial
// interval.
//
// First every option runs over a few seeds. Then, from the cheapest on, those that may meet the
// requirements run over kAdviceSeeds, until kWantedOptions do: so many that, if all of them meet
// the requirements, the interval's lower end is above 95 %. An option is represented by its best
// pipeline: one whose interval lies above 95 %, of these the most usual (order of
// the clock's host_sync, of the camera's device_time, of gatherings); else the one with the largest
// share, then margin.
//
// Margin: the limit divided by the 95 % quantile over seeds (Requirement::margin_of), the smallest
// of all requirements. A world in which USB drops frames is unfit, whatever it reaches.
//
// What fails first is the stage with the largest part of the error (evaluation/budget), asked of
// the recommended option only.
//
//   const Advice advice = advise({.rig = {.cameras = 24, .rate_hz = 60},
//                                 .requirements = {parse_requirement("amd<1ms")}},
//                                make_world, {}, nullptr);
//   if (advice.recommended) advice.options[*advice.recommended].best().pipeline;
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/advice/requirement.h"
#include "evaluation/advice/rig_options.h"
#include "evaluation/run/evaluate.h"

namespace simbench::evaluation {

inline constexpr std::uint64_t kScreeningSeeds = 8;
// All of them meeting it put the probability at 95 % or more (kFewestOutside is the other side).
inline constexpr std::uint64_t kAdviceSeeds = 72;
inline constexpr std::size_t kWantedOptions = 3;
inline constexpr double kWantedShare = 0.95;
inline constexpr std::uint64_t kBudgetSeeds = 2;

struct AdviceRequest {
  RigRequest rig;
  std::vector<Requirement> requirements;
};

struct AdviceOptions {
  std::uint64_t first_seed = 1;
  std::uint64_t screening_seeds = kScreeningSeeds;
  std::uint64_t seeds = kAdviceSeeds;
  unsigned jobs = 0;
  const std::atomic<bool>* cancel = nullptr;
};

// One pipeline in one option's world.
struct PipelineAdvice {
  scenarios::Pipeline pipeline;
  std::int64_t met = 0;  // seeds that meet all requirements
  std::int64_t seeds = 0;
  double margin = kNan;
  // Each requirement's metric over the seeds: its median and the quantile at its bad end.
  std::vector<double> median{};
  std::vector<double> bad_quantile{};
  std::int64_t frames_dropped = 0;

  double share() const { return static_cast<double>(met) / static_cast<double>(seeds); }
  Interval interval() const { return binomial_interval(met, seeds); }
  // By the whole interval: a share of 95 % of few rigs is none of all.
  bool is_fit() const { return frames_dropped == 0 && interval().low >= kWantedShare; }
  bool may_be_fit() const { return frames_dropped == 0 && interval().high >= kWantedShare; }
};

struct OptionAdvice {
  RigOption option;
  std::vector<PipelineAdvice> pipelines{};  // the best first
  bool is_settled = false;                  // ran over all seeds

  const PipelineAdvice& best() const { return pipelines.front(); }
};

// The part of each stage in the error of the recommended pipeline.
struct FailsFirst {
  std::string metric;  // that was divided: "AMD", "absolute error" or "exposure spread"
  std::string stage;
  double share = kNan;  // of the error
};

struct Advice {
  AdviceRequest request;
  AdviceOptions options_of_run;
  std::vector<OptionAdvice> options{};       // the cheapest first
  std::optional<std::size_t> recommended{};  // the cheapest that is settled and fit
  std::optional<FailsFirst> fails_first{};   // of that one
};

// The pipelines of an option, the most usual first.
std::vector<scenarios::Pipeline> candidate_pipelines(const RigOption& option,
                                                     const AdviceRequest& request);

// The gatherings to choose from; one unless a requirement is about sets.
std::vector<std::string> advice_gatherings(const std::vector<Requirement>& requirements);

// Throws scenarios::InputError for what no world supports, and what evaluate() throws. `progress`
// counts options.
Advice advise(const AdviceRequest& request, const WorldFactory& make_world,
              const AdviceOptions& options, const Progress& progress);

}  // namespace simbench::evaluation

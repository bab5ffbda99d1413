// One capture for several pipelines: which of them can share it, and their scores side by side.
//
// A capture follows from the scenario, the seed, the host synchronisation with its parameters,
// what steers the exposures with its own, and the load that is drawn for the pipeline
// (scenarios::Scenario::draws_load(), keyed by its name). Pipelines share one if they differ in
// device_time and gathering alone, and either the scenario draws no load, or their host
// synchronisation never meets it (HostSync::is_idle()), or they have the same name. Pipelines of
// programs share none: what a program does is not simbench's to say.
//
// Scenarios that differ in members of scoring alone (is_scoring_alone()) have the same captures, so
// their pipelines share too, each scored as its own scenario says (PipelineChoice::scored_in).
//
//   for (const std::vector<std::size_t>& group : capture_groups(scenario, choices)) {
//     SharedCapture capture(scenario, choices, group, seed);
//     capture.record(source);
//     const SeedScore first = capture.score(0);
//   }
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "evaluation/certificates/certified_scoring.h"
#include "evaluation/run/pipeline_choice.h"
#include "evaluation/scoring/pipeline_scorer.h"
#include "recording/recording.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

// Whether a capture depends on this member of the scenario (a JSON pointer) at most through the
// parameters of its host synchronisation, which capture_groups() compares. The schema says so
// ("x-scoring" in scenarios/schema.json): the world has no algorithm but the host_sync that it is
// given, and scorers and gatherers alone read the rest. Not /evaluation/stream: the world reports
// which pulses of that stream count.
bool is_scoring_alone(std::string_view pointer);

// The places of the choices that share a capture. Every place once: those of a group in their
// order, the groups in that of their first. O(n^2).
using CaptureGroups = std::vector<std::vector<std::size_t>>;
CaptureGroups capture_groups(const scenarios::Scenario& scenario,
                             const std::vector<PipelineChoice>& choices);

// Each choice by itself, as on a rig, where every capture is another.
CaptureGroups single_captures(const std::vector<PipelineChoice>& choices);

// The capture of a group at a seed.
class SharedCapture {
 public:
  // `choices` must outlive this. Scores have certificates under `certify`, if there is any.
  SharedCapture(const scenarios::Scenario& scenario, const std::vector<PipelineChoice>& choices,
                const std::vector<std::size_t>& group, std::uint64_t seed,
                const std::optional<Assumptions>& certify = {});

  // Records it with the first choice of the group, to scorers of all. Keeps what goes wrong. Once.
  void record(RecordingSource& source, const ShareDone& share_done = {});

  // The score of a member, by its place in the group; once for each. Throws what went wrong with it
  // or with the capture.
  SeedScore score(std::size_t member);

 private:
  // A scorer and what comes before it.
  struct Member {
    std::unique_ptr<PipelineScorer> scorer;
    std::unique_ptr<CertifiedScoring> certified;  // null: not asked for
    std::unique_ptr<RecordingSink> view;          // null: none
    RecordingSink* sink = nullptr;                // the outermost of them
    std::exception_ptr failure;
  };

  const PipelineChoice& recorded_;  // the first
  std::uint64_t seed_;
  std::vector<Member> members_;
  RecordingCost cost_;
};

}  // namespace simbench::evaluation

// Scores of a capture without truth and without GenLock, where it is unknown which frames belong
// together.
//
// Only the sets that the gatherer under test emitted can be scored: how far apart the stamps of a
// set are, how many frames arrived, and how late sets were emitted. The score cannot show whether
// the frames of a set were exposed together. A gatherer that mixes neighbours consistently looks
// perfect; one that gives up all difficult sets looks better than one that does not; stamps of
// relative estimators, which count from each camera's own first frame, agree by construction.
// Precision, recall and the errors do not exist. Reports label such scores "unverified".
//
// The warm-up lasts as long as layout.first_pulse frames take, for each host on its steady clock
// from its first frame; the evaluated part lasts as long as layout.pulses frames take. Lost frames
// are gaps of the counters: a camera that never returns leaves none.
//
//   UnverifiedScores scores(layout, MedianKind::kUpperMiddle, nullptr);
//   if (scores.part_of(frame) == UnverifiedScores::Part::kEvaluated) tag = kUnknownPulse;
//   gatherer.push_all(block.frames(), scores);
//   scores.score(seed_score);
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/gathering/gathering.h"
#include "evaluation/scoring/pulse_spread.h"
#include "evaluation/scoring/results.h"
#include "evaluation/scoring/score_observer.h"
#include "recording/recording.h"

namespace simbench::evaluation {

// The tag of an evaluated frame whose pulse is unknown. (-1: not evaluated.)
inline constexpr std::int64_t kUnknownPulse = -2;
// A longer gap of a counter, in frames, is a counter that began anew.
inline constexpr std::uint32_t kLongestGap = 10'000;

class UnverifiedScores final : public TimedSetSink {
 public:
  enum class Part : std::uint8_t { kWarmUp, kEvaluated, kAfter };

  // `observer` (or null) is notified of the sets that count.
  UnverifiedScores(const RigLayout& layout, MedianKind median, ScoreObserver* observer);

  // Counts a frame of the scored stream and returns its part of the capture. Once for each frame,
  // in order of delivery.
  Part part_of(const FrameRecord& frame);

  // Sets count if all their members are evaluated.
  void on_set(std::span<const GatherFrame> set) override;
  void on_partial_set(std::span<const GatherFrame> set) override;

  // Sets amd_ms, rmdv_ms, that as printed, set_amd_ms, the emission latencies, frames, sets and
  // pulses (where a set has its number in place of the pulse). The rest of `score` stays.
  void score(SeedScore& score) const;

 private:
  void count(const FrameRecord& frame);

  const MedianKind median_;
  ScoreObserver* observer_;
  Nanoseconds warm_up_;
  Nanoseconds end_;  // of what is evaluated; both since the host's first frame
  std::vector<std::uint32_t> host_of_camera_;
  std::vector<std::optional<SteadyTime>> first_arrival_;       // by host
  std::vector<std::optional<std::uint32_t>> evaluated_count_;  // last evaluated counter, by camera
  FrameCounts frames_;
  std::int64_t partial_ = 0;
  std::vector<PulseScore> sets_;
  PrintedRmdv printed_;
  double latency_sum_ms_ = 0;
  double latency_max_ms_ = 0;
  std::vector<std::int64_t> stamps_ns_;  // workspaces
  std::vector<std::int64_t> sorted_;
};

}  // namespace simbench::evaluation

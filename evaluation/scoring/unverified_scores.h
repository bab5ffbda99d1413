// Scores of a capture of which nobody knows which frames belong together: no truth, no GenLock.
//
// All that can be scored are the sets that the gatherer under test emitted, so the score trusts
// what it should judge. It can say how far apart the stamps of a set are, how many frames came and
// how late sets were emitted. It cannot say whether the frames of a set were exposed together: a
// gatherer that mixes neighbours consistently looks perfect, and one that gives up all difficult
// sets looks better than one that does not; stamps that count from each camera's own first frame
// (relative estimators) agree by construction, whenever the cameras were started. Precision, recall
// and the errors do not exist. Such scores are labelled "unverified" wherever they are shown.
//
// The warm-up is counted in time, for each host on its steady clock from its first frame: as long
// as layout.first_pulse frames take; as much as layout.pulses frames take is evaluated then. Frames
// count as lost by gaps of the counters: a camera that never comes back leaves none.
//
//   UnverifiedScores scores(layout, MedianKind::kUpperMiddle, nullptr);
//   if (scores.part_of(frame) == UnverifiedScores::Part::kEvaluated) tag = kUnknownPulse;
//   scores.before_push(arrival);
//   gatherer.push({.stamp = stamp, .tag = tag}, scores);
//   scores.score(seed_score);
#ifndef SIMBENCH_EVALUATION_SCORING_UNVERIFIED_SCORES_H_
#define SIMBENCH_EVALUATION_SCORING_UNVERIFIED_SCORES_H_

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

// The tag of a frame that is evaluated though its pulse is not known. (-1: not evaluated.)
inline constexpr std::int64_t kUnknownPulse = -2;

class UnverifiedScores final : public FrameSetSink {
 public:
  enum class Part : std::uint8_t { kWarmUp, kEvaluated, kAfter };

  // `observer` is shown the sets that count; null: nobody is.
  UnverifiedScores(const RigLayout& layout, MedianKind median, ScoreObserver* observer);

  // Which part of the capture a frame of the scored stream is in; counts it. Once for each frame,
  // in order of delivery.
  Part part_of(const FrameRecord& frame);

  // The arrival of the frame that is to be pushed next.
  void before_push(GlobalTime arrival) { now_ = arrival; }
  // Sets count if all their members are evaluated.
  void on_set(std::span<const GatherFrame> set) override;
  void on_partial_set(std::span<const GatherFrame> set) override;

  // Fills in amd_ms, rmdv_ms, set_amd_ms, the emission latencies, frames, sets and pulses (there, a
  // set has its number in place of the pulse). The rest of `score` stays.
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
  GlobalTime now_{};
  FrameCounts frames_;
  std::int64_t partial_ = 0;
  std::vector<PulseScore> sets_;
  double latency_sum_ms_ = 0;
  double latency_max_ms_ = 0;
  std::vector<std::int64_t> stamps_ns_;  // workspaces
  std::vector<std::int64_t> sorted_;
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SCORING_UNVERIFIED_SCORES_H_

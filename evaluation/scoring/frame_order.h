// What tells a scorer which frames belong together: three strategies.
//
//   TrueOrder     the truth of a simulation, where each frame has the pulse that exposed it
//   StampOrder    GenLock order, by the sensor stamps of a genlock capture (genlock_order.h). Where
//                 frames have truth too, that decides, and frames are counted whose place in
//                 GenLock order is another
//   UnknownOrder  nothing: the sets that gathering emits are scored by themselves
//                 (unverified_scores.h)
//
// A strategy places each frame of the scored stream, in order of delivery: its pulse, and whether
// it precedes the evaluated part of the capture. It takes the sets that gathering emits, and adds
// what it counted to the score. Frames that no pulse exposed precede the evaluated part until a
// frame of an evaluated pulse has come.
//
//   TrueOrder order({.layout = layout, .table = table});
//   const FramePlace place = order.place(record, truth, frame.sensor);
//   gatherer.push_all(block.frames(), order.sets(Nanoseconds(0)));
//   order.add_to(seed_score);
#pragma once

#include <cstdint>
#include <vector>

#include "algorithms/gathering/gathering.h"
#include "algorithms/gathering/genlock_order.h"
#include "evaluation/scoring/pulse_scores.h"
#include "evaluation/scoring/score_observer.h"
#include "evaluation/scoring/set_counter.h"
#include "evaluation/scoring/unverified_scores.h"
#include "recording/recording.h"

namespace simbench::evaluation {

// The pulse of a frame that none exposed, and of one beyond the evaluated part.
inline constexpr std::int64_t kNoPulse = -1;

struct FramePlace {
  std::int64_t pulse = kNoPulse;  // kUnknownPulse: an evaluated one
  bool warm_up = false;           // before the evaluated part
};

// What an order is made of; all outlive it.
struct OrderParts {
  const RigLayout& layout;
  const PulseTable& table;
  MedianKind median = MedianKind::kUpperMiddle;
  ScoreObserver* observer = nullptr;  // null: none
};

// What TrueOrder and StampOrder share: pulses are known.
class KnownPulses {
 public:
  // `shift` is what the stamps of the sets lack.
  TimedSetSink& sets(Nanoseconds shift) {
    sets_.set_shift(shift);
    return sets_;
  }
  void add_to(SeedScore& score) const { sets_.score(score); }

 protected:
  explicit KnownPulses(const OrderParts& parts)
      : first_pulse_(parts.layout.first_pulse), sets_(parts.table, parts.observer) {}

  FramePlace at(std::int64_t pulse) {
    if (pulse >= first_pulse_) warm_up_over_ = true;
    return {pulse, pulse == kNoPulse ? !warm_up_over_ : pulse < first_pulse_};
  }

 private:
  std::int64_t first_pulse_;
  bool warm_up_over_ = false;
  SetCounter sets_;
};

class TrueOrder final : public KnownPulses {
 public:
  explicit TrueOrder(const OrderParts& parts) : KnownPulses(parts) {}

  static constexpr GroundTruth ground_truth() { return GroundTruth::kSimulation; }
  FramePlace place(const FrameRecord& /*frame*/, const FrameTruth* truth, DeviceTime /*sensor*/) {
    return at(truth != nullptr ? truth->pulse : kNoPulse);
  }
};

class StampOrder final : public KnownPulses {
 public:
  // `truth`: of the first frame, or null.
  StampOrder(const OrderParts& parts, Nanoseconds period, const FrameTruth* truth)
      : KnownPulses(parts),
        has_truth_(truth != nullptr),
        first_true_pulse_(truth != nullptr ? truth->pulse : 0),
        cameras_(parts.layout.cameras.size(),
                 GenlockOrder(period, GenlockOrder::Variant::kReanchored)) {}

  GroundTruth ground_truth() const {
    return has_truth_ ? GroundTruth::kSimulation : GroundTruth::kGenlockOrder;
  }
  FramePlace place(const FrameRecord& frame, const FrameTruth* truth, DeviceTime sensor) {
    const std::int64_t index = cameras_[frame.camera].next(sensor);
    if (truth == nullptr) return at(index);
    if (index != truth->pulse - first_true_pulse_) ++index_errors_;
    return at(truth->pulse);
  }
  void add_to(SeedScore& score) const {
    KnownPulses::add_to(score);
    score.genlock_index_errors = index_errors_;
  }

 private:
  bool has_truth_;
  std::int64_t first_true_pulse_;
  std::int64_t index_errors_ = 0;
  std::vector<GenlockOrder> cameras_;
};

class UnknownOrder final {
 public:
  explicit UnknownOrder(const OrderParts& parts)
      : scores_(parts.layout, parts.median, parts.observer) {}

  static constexpr GroundTruth ground_truth() { return GroundTruth::kNone; }
  FramePlace place(const FrameRecord& frame, const FrameTruth* /*truth*/, DeviceTime /*sensor*/) {
    using Part = UnverifiedScores::Part;
    const Part part = scores_.part_of(frame);
    return {part == Part::kEvaluated ? kUnknownPulse : kNoPulse, part == Part::kWarmUp};
  }
  TimedSetSink& sets(Nanoseconds /*shift*/) { return scores_; }
  void add_to(SeedScore& score) const { scores_.score(score); }

 private:
  UnverifiedScores scores_;
};

}  // namespace simbench::evaluation

// Records a simulated run for a timeline while it is scored.
//
// Observes the recording on its way to the scorer, the world behind it, and the stamps and sets of
// the scorer: so the sets are those that evaluation counts (evaluation/scoring/set_counter.h), by
// the pipeline's own device_time and gathering. Memory: some 100 bytes for each of at most twice
// TraceOptions::max_events events, and 24 bytes for each frame of a set.
//
//   const Trace trace = record_trace(scenario, choice, /*seed=*/1, *source,
//                                    {.max_events = 50'000});
//   write_chrome_trace(trace, std::cout);
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "evaluation/certificates/certified_scoring.h"
#include "evaluation/run/pipeline_choice.h"
#include "evaluation/scoring/pipeline_scorer.h"
#include "evaluation/scoring/score_observer.h"
#include "recording/forwarding_sink.h"
#include "recording/world_observer.h"
#include "reports/timeline/trace.h"
#include "scenarios/scenario.h"

namespace simbench::reports {

class TraceRecorder final : public ForwardingSink,
                            public WorldObserver,
                            public evaluation::ScoreObserver {
 public:
  // Watches `scorer`, which must outlive this; `scored`: the stream that it scores.
  TraceRecorder(evaluation::PipelineScorer& scorer, StreamKind scored, const TraceOptions& options);
  // The sets have certificates. `certified` watched `scorer` and must outlive this.
  TraceRecorder(evaluation::CertifiedScoring& certified, evaluation::PipelineScorer& scorer,
                StreamKind scored, const TraceOptions& options);

  void on_start(const RigLayout& layout) override;
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override;
  void on_event(const RecordingEvent& event) override;

  Nanoseconds clock_interval() const override;
  void on_world(TrueTime start) override;
  void on_capture_start(TrueTime at) override;
  void on_pulse(const ObservedPulse& pulse) override;
  void on_frame(const ObservedFrame& frame) override;
  void on_message(const ObservedMessage& message) override;
  void on_clocks(TrueTime at, std::span<const Nanoseconds> errors) override;

  void on_stamp(const GatherFrame& frame) override;
  void on_set(std::span<const GatherFrame> set, bool complete, GlobalTime now) override;
  void on_shift(Nanoseconds shift) override { shift_ = shift; }

  // Call once, after the scorer has finished. The trace lacks the names of scenario and pipeline.
  Trace finish();

 private:
  // How scorer and gatherer identify a frame.
  struct FrameKey {
    std::uint32_t camera = 0;
    std::uint32_t sensor_us = 0;
    friend bool operator==(FrameKey, FrameKey) = default;
    friend bool operator<(FrameKey a, FrameKey b) {
      return std::tie(a.camera, a.sensor_us) < std::tie(b.camera, b.sensor_us);
    }
  };
  struct Member {
    FrameKey key;
    GlobalTime arrival{};
  };
  struct KeptSet {
    std::vector<Member> members;
    bool complete = false;
    Nanoseconds range{};
    GlobalTime now{};
  };
  struct Stamp {
    FrameKey key;
    GlobalTime global{};
  };
  struct Anchor {
    SteadyTime steady;
    TrueTime at;
  };

  void add(const FrameRecord& frame, const FrameTruth& truth);
  void add(const ClockAdjustment& adjustment);
  void add(const SessionDelays& delays);
  template <class Thing>
  void take(std::vector<Thing>& list, Thing thing);
  template <class Function>
  void for_each_list(const Function& function);
  // Removes things that begin too late for the limit.
  void cut_to_limit();
  void cut_at(TrueTime instant);

  void resolve_adjustments();
  void resolve_sessions();
  // Removes what begins outside the window.
  template <class Thing>
  void keep_window(std::vector<Thing>& list);
  TrueTime true_time(std::uint32_t host, SteadyTime at) const;
  void sort_by_begin();
  void index_frames();
  std::uint32_t* find(const FrameKey& key);
  void mark_leaders();
  void resolve_stamps();
  void resolve_sets();

  StreamKind scored_;
  evaluation::CertifiedScoring* certified_ = nullptr;
  Trace trace_;
  std::uint64_t kept_events_ = 0;
  TrueTime last_seen_{};
  TraceFrame under_way_{};  // the recorded part of the frame that the world reports next
  FrameKey under_way_key_{};
  Nanoseconds shift_{};
  std::vector<std::vector<Anchor>> anchors_;  // by host, in order of time
  std::vector<KeptSet> sets_;
  std::vector<Stamp> late_stamps_;  // by an offline estimator
  struct Indexed {
    FrameKey key;
    std::uint32_t frame = 0;
  };
  std::vector<Indexed> index_;  // by key
};

// Runs the pipeline once. Throws what the source throws.
Trace record_trace(const scenarios::Scenario& scenario, const evaluation::PipelineChoice& choice,
                   std::uint64_t seed, RecordingSource& source, const TraceOptions& options);

}  // namespace simbench::reports

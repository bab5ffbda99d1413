// A sink that passes a capture on to several, side by side.
//
// What a sink throws is kept as its failure; it gets nothing more, and the others go on. Once all
// have failed there is nobody to record for: the last failure is thrown.
//
//   ForkedSink fork({&first_scorer, &second_scorer});
//   source.record(request, fork);
//   if (fork.failure(0)) std::rethrow_exception(fork.failure(0));
#pragma once

#include <cstddef>
#include <exception>
#include <span>
#include <vector>

#include "recording/recording.h"

namespace simbench {

class ForkedSink final : public RecordingSink {
 public:
  // At least one; the sinks must outlive this.
  explicit ForkedSink(const std::vector<RecordingSink*>& sinks) : live_(sinks.size()) {
    for (RecordingSink* const sink : sinks) branches_.push_back({sink, nullptr});
  }

  // What the sink at that place threw; null if it has not failed.
  std::exception_ptr failure(std::size_t sink) const { return branches_[sink].failure; }

  void on_start(const RigLayout& layout) override {
    each([&](RecordingSink& sink) { sink.on_start(layout); });
  }
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override {
    each([&](RecordingSink& sink) { sink.on_frames(frames, truths); });
  }
  void on_event(const RecordingEvent& event) override {
    each([&](RecordingSink& sink) { sink.on_event(event); });
  }

 private:
  struct Branch {
    RecordingSink* sink;
    std::exception_ptr failure;
  };

  template <class Action>
  void each(const Action& action) {
    for (Branch& branch : branches_) {
      if (branch.failure) continue;
      try {
        action(*branch.sink);
      } catch (...) {
        branch.failure = std::current_exception();
        if (--live_ == 0) throw;
      }
    }
  }

  std::vector<Branch> branches_;
  std::size_t live_;
};

}  // namespace simbench

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/coded_trigger/code_decoder.h"
#include "algorithms/gathering/fronts.h"
#include "algorithms/gathering/gatherers.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"
#include "laws/saturate.h"

namespace simbench {
namespace {

class CodedTriggerGatherer final : public BlockGatherer<CodedTriggerGatherer> {
 public:
  CodedTriggerGatherer(const GatheringSetup& setup, const CodeDecoderSettings& settings)
      : length_(setup.pulses->code.length()),
        most_held_(setup.queue_limit.value_or(kCodedTriggerQueue)),
        matcher_(setup.sources, /*tolerance=*/1, most_held_) {
    sources_.reserve(setup.sources);
    for (std::uint32_t source = 0; source < setup.sources; ++source) {
      sources_.push_back({.decoder = CodeDecoder(setup.pulses, settings), .held = {}});
      sources_.back().held.reserve(most_held_ + 1);
    }
  }

  void push(const GatherFrame& frame, FrameSetSink& sink) override {
    SIMBENCH_ASSERT(frame.source < sources_.size(), "a frame of a source that does not exist");
    Source& source = sources_[frame.source];
    const Decoded decoded = source.decoder.push(frame.sensor, frame.exposure_us);
    if (decoded.indexed == 1 && source.held.empty()) {
      newest_index_ = source.decoder.newest_index();
      matcher_.push(newest_index_, frame, sink);
    } else {
      sort_out(source, decoded, frame, sink);
    }
  }

  std::uint64_t discarded() const override { return without_index_ + matcher_.discarded(); }
  bool from_first_frame() const override { return true; }
  std::optional<PlaceSearch> place_search() const override;

 private:
  struct Source {
    CodeDecoder decoder;
    std::vector<GatherFrame> held;  // the newest of those that the decoder holds
    std::size_t dropped = 0;        // older ones, for which there was no room
  };

  void sort_out(Source& source, const Decoded& decoded, const GatherFrame& frame,
                FrameSetSink& sink) {
    if (decoded.is_refused) {
      ++without_index_;
      return;
    }
    source.held.push_back(frame);
    give_up(source, decoded.given_up);
    if (decoded.indexed > 0) {
      if (decoded.has_found_place && !decoded.is_cycle_known) join(source.decoder);
      for (std::size_t i = 0; i < source.held.size(); ++i) {
        newest_index_ = decoded.has_found_place ? source.decoder.found_index(source.dropped + i)
                                                : source.decoder.newest_index();
        matcher_.push(newest_index_, source.held[i], sink);
      }
      source.held.clear();
      source.dropped = 0;
      is_any_locked_ = true;
    } else if (source.held.size() > most_held_) {
      source.held.erase(source.held.begin());
      ++source.dropped;
      ++without_index_;
    }
  }

  // The oldest of those that the decoder held.
  void give_up(Source& source, std::size_t frames) {
    const std::size_t dropped = std::min(frames, source.dropped);
    source.dropped -= dropped;
    const auto count = static_cast<std::ptrdiff_t>(frames - dropped);
    source.held.erase(source.held.begin(), source.held.begin() + count);
    without_index_ += frames - dropped;
  }

  // In the cycle of the source that delivered last.
  void join(CodeDecoder& decoder) const {
    if (!is_any_locked_) return;
    const double ahead = static_cast<double>(newest_index_ - decoder.newest_index());
    decoder.move_by_cycles(saturate_round(ahead / static_cast<double>(length_)));
  }

  std::int64_t length_;
  std::uint32_t most_held_;  // of a source, before its place is known and behind
  std::vector<Source> sources_;
  FrontMatcher matcher_;  // over pulses
  bool is_any_locked_ = false;
  std::int64_t newest_index_ = 0;
  std::uint64_t without_index_ = 0;
};

std::optional<PlaceSearch> CodedTriggerGatherer::place_search() const {
  PlaceSearch all;
  for (const Source& source : sources_) {
    const CodeLock& lock = source.decoder.lock();
    all.add({.sources = 1,
             .found = lock.times > 0 ? 1U : 0U,
             .again = lock.times > 0 ? lock.times - 1 : 0,
             .frames = lock.frames,
             .seconds = lock.seconds,
             .since_first_frame_s = lock.since_first_frame_s,
             .error_probability = lock.error_probability});
  }
  return all;
}

}  // namespace

std::unique_ptr<Gatherer> make_coded_trigger_gatherer(const GatheringSetup& setup,
                                                      const CodeDecoderSettings& settings) {
  SIMBENCH_ASSERT(setup.pulses != nullptr, "a coded trigger has a code");
  return std::make_unique<CodedTriggerGatherer>(setup, settings);
}

std::vector<GatheringEntry> gathering_coded_trigger() {
  return {with_settings<GatheringEntry>(
      {.name = "coded_trigger",
       .family = "coded_trigger",
       .summary = "frames of one pulse of a coded trigger, named by each camera's own stamps",
       .source = "docs/coded_trigger.md",
       .needs = {Need::kTriggerCode}},
      CodeDecoderSettings{}, [](const CodeDecoderSettings& settings, const GatheringSetup& setup) {
        return make_coded_trigger_gatherer(setup, settings);
      })};
}

}  // namespace simbench

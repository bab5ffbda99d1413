#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "algorithms/gathering/fronts.h"
#include "algorithms/gathering/gatherers.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

constexpr double kTurnsPerRadian = 0.5 / std::numbers::pi;

// sin(2 pi turns) for |turns| <= 1/2, within 0.0011: a parabola and one correction.
// Quicker than the library's, and the same number everywhere; a mean needs no more.
double sine(double turns) {
  const double parabola = 8 * turns * (1 - 2 * std::abs(turns));
  return parabola * (0.775 + 0.225 * std::abs(parabola));
}

double cosine(double turns) { return sine(turns <= 0.25 ? turns + 0.25 : turns - 0.75); }

// The direction of (x, y) in turns. Nearly always small here, where three terms are within 1e-9.
double direction(double x, double y) {
  if (!(std::abs(y) < x / 16)) return std::atan2(y, x) * kTurnsPerRadian;
  const double t = y / x;
  return t * (1 - t * t * (1.0 / 3 - t * t / 5)) * kTurnsPerRadian;
}

// phase + k * period, following the stamps.
//
// The circular mean is the direction of a sum of unit vectors, one per frame. The grid turns to
// that direction after each frame, so that only the length of the sum must be kept.
class PhaseGrid {
 public:
  PhaseGrid(std::int64_t period, double decay) : period_(period), decay_(decay) {}

  // Returns the slot of a stamp, and moves the phase by it.
  std::int64_t slot_of(std::int64_t key) {
    if (length_ == 0) point_ = key;
    std::int64_t slots = (key - point_) / period_;
    std::int64_t residual = (key - point_) % period_;
    if (residual > period_ / 2) {
      residual -= period_;
      ++slots;
    } else if (residual < -(period_ / 2)) {
      residual += period_;
      --slots;
    }
    slot_ += slots;
    point_ = std::clamp(key - residual + turn(residual), -kFarthestKey, kFarthestKey);
    return slot_;
  }

 private:
  // Adds a frame at `residual` from the grid; returns by how much this moves the grid.
  std::int64_t turn(std::int64_t residual) {
    const auto period = static_cast<double>(period_);
    const double turns = static_cast<double>(residual) / period;
    const double along = decay_ * length_ + cosine(turns);
    const double across = sine(turns);
    length_ = std::sqrt(along * along + across * across);
    return std::llround(direction(along, across) * period);
  }

  std::int64_t period_;
  double decay_;
  double length_ = 0;       // of the sum of vectors
  std::int64_t point_ = 0;  // of the grid, near the last stamp
  std::int64_t slot_ = 0;   // its number
};

class PhaseBinningGatherer final : public BlockGatherer<PhaseBinningGatherer> {
 public:
  PhaseBinningGatherer(const GatheringSetup& setup, double decay)
      : grid_(setup.period.count(), decay),
        sources_(setup.sources),
        places_(setup.queue_limit.value_or(kPhaseBinningSlots)),
        frames_(std::size_t{setup.sources} * places_.size()),
        is_filled_(frames_.size()) {
    SIMBENCH_ASSERT(setup.sources > 0, "gathering needs a source");
    SIMBENCH_ASSERT(!places_.empty(), "gathering needs room for one slot");
    SIMBENCH_ASSERT(setup.period >= Microseconds(1), "a frame period is a microsecond or more");
    SIMBENCH_ASSERT(decay >= 0 && decay < 1, "a frame weighs less than its successor");
  }

  void push(const GatherFrame& frame, FrameSetSink& sink) override {
    SIMBENCH_ASSERT(frame.source < sources_, "a frame of a source that does not exist");
    const std::int64_t slot = grid_.slot_of(gather_key(frame));
    const auto places = static_cast<std::int64_t>(places_.size());
    if (last_set_ && slot <= *last_set_) {
      if (*last_set_ - slot < places) {
        ++discarded_;
        return;
      }
      last_set_.reset();
    }
    const auto index = static_cast<std::size_t>(((slot % places) + places) % places);
    Place& place = places_[index];
    if (place.slot != slot) {
      give_up(index);
      place.slot = slot;
    }
    const std::size_t cell = index * sources_ + frame.source;
    if (is_filled_[cell] != 0) {
      ++discarded_;
      return;
    }
    frames_[cell] = frame;
    is_filled_[cell] = 1;
    if (place.frames++ == 0) ++open_;
    if (place.frames == sources_) emit(index, sink);
  }

  std::uint64_t discarded() const override { return discarded_; }

 private:
  struct Place {
    std::int64_t slot = 0;
    std::uint32_t frames = 0;
  };

  void emit(std::size_t index, FrameSetSink& sink) {
    sink.on_set({frames_.data() + index * sources_, sources_});
    last_set_ = places_[index].slot;
    clear(index);
    for (std::size_t other = 0; open_ > 0 && other < places_.size(); ++other) {
      if (places_[other].slot < *last_set_) give_up(other);
    }
  }

  void give_up(std::size_t index) {
    if (places_[index].frames == 0) return;
    discarded_ += places_[index].frames;
    clear(index);
  }

  void clear(std::size_t index) {
    const auto first = is_filled_.begin() + static_cast<std::ptrdiff_t>(index * sources_);
    std::fill_n(first, sources_, char{0});
    places_[index].frames = 0;
    --open_;
  }

  PhaseGrid grid_;
  std::uint32_t sources_;
  std::vector<Place> places_;             // slot k is at k modulo their number
  std::vector<GatherFrame> frames_;       // a row per place, a column per source
  std::vector<char> is_filled_;           // likewise
  std::size_t open_ = 0;                  // places that have a frame
  std::optional<std::int64_t> last_set_;  // its slot
  std::uint64_t discarded_ = 0;
};

}  // namespace

std::unique_ptr<Gatherer> make_phase_binning_gatherer(const GatheringSetup& setup, double decay) {
  return std::make_unique<PhaseBinningGatherer>(setup, decay);
}

namespace {

const char* const kGenlockPractice = "practice of genlock rigs; docs/reference/gathering.md";

struct PhaseBinningSettings {
  double decay = kPhaseDecay;

  void bind(ParameterBinder& parameters) {
    parameters.number("decay", decay, 0, 0.999999,
                      "weight of a frame in the phase, against its successor's", kGenlockPractice);
  }
};

}  // namespace

std::vector<GatheringEntry> gathering_phase_binning() {
  return {with_settings<GatheringEntry>(
      {.name = "phase_binning",
       .family = "phase_binning",
       .summary = "the nearest point of the common period's grid, which follows the stamps",
       .source = kGenlockPractice},
      PhaseBinningSettings{},
      [](const PhaseBinningSettings& settings, const GatheringSetup& setup) {
        return make_phase_binning_gatherer(setup, settings.decay);
      })};
}

}  // namespace simbench

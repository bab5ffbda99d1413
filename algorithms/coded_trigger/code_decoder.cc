#include "algorithms/coded_trigger/code_decoder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithms/ports/assert.h"
#include "laws/saturate.h"

namespace simbench {
namespace {

// Three frames in a row that contradict the place end it; single ones among many do not.
constexpr std::uint32_t kStrike = 4;
constexpr std::uint32_t kMostStrikes = 12;
// Stamps that fall back by more are of a clock that was restarted.
constexpr std::int64_t kRestartNs = kSecondNs;
constexpr double kGateWidth = 8;  // standard deviations

}  // namespace

CodeDecoder::CodeDecoder(std::shared_ptr<const CodedPulses> pulses,
                         const CodeDecoderSettings& settings)
    : pulses_(std::move(pulses)),
      shifts_ns_(pulses_->code.shifts_ns().data()),
      sent_(pulses_->code.sent().data()),
      length_(pulses_->code.length()),
      half_exposure_ns_(pulses_->exposures_begin_at_pulse ? -500 : 500),
      noise_us_(settings.noise.noise_us),
      most_gate_us_(smallest_step_us(pulses_->code) / 2),
      search_(pulses_, settings) {}

std::uint32_t CodeDecoder::forget_held() {
  const auto held = static_cast<std::uint32_t>(search_.held());
  search_.clear();
  return held;
}

Decoded CodeDecoder::push_any(std::int64_t at_ns) {
  if (is_released_) {
    is_released_ = false;
    search_.clear();
  }
  if (!first_at_ns_) {
    first_at_ns_ = last_at_ns_ = at_ns;
    return look_for_place(at_ns, 0);
  }
  if (has_index_) last_at_ns_ = std::max(last_at_ns_, at_ns_);
  std::uint32_t given_up = 0;
  if (at_ns <= last_at_ns_) {
    if (last_at_ns_ - at_ns < kRestartNs) return {.is_refused = true};
    given_up = forget_held();
    is_locked_ = has_index_ = false;
    first_at_ns_ = at_ns;
  }
  last_at_ns_ = at_ns;
  if (!is_locked_) return look_for_place(at_ns, given_up);
  const double grid_ns = static_cast<double>(at_ns - at_ns_) - grid_offset_ns_;
  const std::int64_t slots = saturate_round(grid_ns / step_ns_);
  if (slots >= 1 && slots <= kLongestGapPeriods && follows(at_ns, grid_ns, slots)) {
    return {.given_up = forget_held(), .indexed = 1};
  }
  strikes_ += kStrike;
  if (strikes_ >= kMostStrikes) is_locked_ = false;
  return look_for_place(at_ns, given_up);
}

Decoded CodeDecoder::look_for_place(std::int64_t at_ns, std::uint32_t given_up) {
  const CodeSearch::Outcome outcome = search_.add(at_ns);
  given_up += outcome.given_up;
  if (!outcome.is_found) return {.given_up = given_up};
  const bool is_cycle_known = has_index_;
  take_place();
  return {.given_up = given_up,
          .indexed = static_cast<std::uint32_t>(search_.held()),
          .has_found_place = true,
          .is_cycle_known = is_cycle_known};
}

void CodeDecoder::take_place() {
  const CodeVerdict& verdict = search_.verdict();
  const std::int64_t at_ns = search_.newest_at_ns();
  const std::int64_t slots = search_.slot(search_.held() - 1);
  const double period_ns = to_ns(pulses_->code.period());
  first_index_ = static_cast<std::int64_t>(verdict.place);
  if (has_index_) {
    const double since = static_cast<double>(at_ns - at_ns_) / step_ns_;
    const double ahead = static_cast<double>(index_ - first_index_ - slots) + since;
    first_index_ += length_ * saturate_round(ahead / static_cast<double>(length_));
  } else if (first_index_ + slots >= length_) {
    // What came before pulse 0, a frame of a camera that ran free, is not of the cycle's end.
    first_index_ -= length_;
  }
  index_ = first_index_ + slots;
  place_ = static_cast<std::int64_t>(pulses_->code.place(index_));
  at_ns_ = at_ns;
  const double fit_us = verdict.level_us + verdict.rate_us * static_cast<double>(slots);
  grid_offset_ns_ = 1e3 * (fit_us - search_.newest_residual_us());
  step_ns_ = period_ns + 1e3 * verdict.rate_us;
  const double noise_us = std::max(noise_us_, verdict.noise_us);
  const double gate_us = kGateWidth * noise_us;
  gate_ns_ = 1e3 * (most_gate_us_ > 0 ? std::min(gate_us, most_gate_us_) : gate_us);
  is_locked_ = has_index_ = is_released_ = true;
  strikes_ = 0;
  ++lock_.times;
  lock_.frames = static_cast<std::uint32_t>(search_.held());
  lock_.seconds = static_cast<double>(slots - search_.slot(0)) * step_ns_ * 1e-9;
  lock_.since_first_frame_s = static_cast<double>(at_ns - *first_at_ns_) * 1e-9;
  lock_.error_probability = verdict.error_probability;
  lock_.noise_us = verdict.noise_us;
}

void CodeDecoder::move_by_cycles(std::int64_t cycles) {
  index_ += cycles * length_;
  first_index_ += cycles * length_;
}

}  // namespace simbench

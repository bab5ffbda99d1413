#include "sim/trigger/trigger_tree.h"

#include <algorithm>
#include <cmath>

#include "scenarios/trigger_code.h"
#include "sim/engine/random.h"

namespace simbench::sim {

TriggerTree::TriggerTree(const scenarios::Trigger& settings, std::size_t cameras,
                         std::uint64_t seed)
    : settings_(settings), seed_(seed), period_ns_(1e9 / settings.pulse_rate_hz()) {
  delays_.reserve(cameras);
  for (std::size_t camera = 0; camera < cameras; ++camera) {
    const auto per_branch = static_cast<std::size_t>(settings.cameras_per_sub_trigger);
    const std::size_t branch = camera / per_branch;
    const auto cameras_before = static_cast<double>(camera % per_branch);
    RandomStream branch_stream(seed, "trigger/branch", branch);
    RandomStream cable_stream(seed, "trigger/cable", camera);
    const double own_us =
        settings.delay_of_camera_us.empty() ? 0 : settings.delay_of_camera_us.at(camera);
    delays_.push_back(from_us(own_us + branch_stream.uniform(0, settings.branch_delay_max_us) +
                              cable_stream.uniform(0, settings.cable_delay_max_us) +
                              cameras_before * settings.daisy_chain_delay_us));
  }
  if (const auto code = scenarios::trigger_code(settings)) {
    code_ = std::make_shared<const TriggerCode>(*code);
  }
  start(TrueTime{});
}

void TriggerTree::start(TrueTime capture_start) {
  capture_start_ = capture_start;
  first_due_ = capture_start + from_ms(settings_.start_delay_ms);
}

TrueTime TriggerTree::due(std::int64_t slot) const {
  return first_due_ + from_ns(static_cast<double>(slot) * period_ns_);
}

std::optional<TrueTime> TriggerTree::pulse(std::int64_t slot) const {
  const TrueTime at = due(slot);
  const double since_start_ms = to_ms(at - capture_start_);
  for (const scenarios::TriggerPause& pause : settings_.pauses) {
    if (since_start_ms >= pause.at_ms && since_start_ms < pause.at_ms + pause.duration_ms) {
      return std::nullopt;
    }
  }
  RandomStream stream(seed_, "trigger/pulse", static_cast<std::uint64_t>(slot));
  if (stream.chance(settings_.missed_pulse_probability)) return std::nullopt;
  const Nanoseconds jitter = from_us(stream.normal(settings_.pulse_jitter_sigma_us));
  if (!code_) return at + jitter;
  if (!code_->is_sent(slot)) return std::nullopt;
  return at + code_->shift(slot) + jitter;
}

std::int64_t TriggerTree::first_slot_from(TrueTime at) const {
  const double periods = static_cast<double>((at - first_due_).count()) / period_ns_;
  std::int64_t slot = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::floor(periods)));
  while (due(slot) < at) ++slot;
  return slot;
}

}  // namespace simbench::sim

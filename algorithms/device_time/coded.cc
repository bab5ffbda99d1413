#include "algorithms/device_time/coded.h"

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/coded_trigger/code_decoder.h"
#include "algorithms/device_time/offset_stream.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"
#include "laws/line_fit.h"
#include "laws/saturate.h"

namespace simbench {
namespace {

class CodedTime final : public DeviceTimeEstimator {
 public:
  explicit CodedTime(const CodedTimeSettings& settings)
      : settings_(settings), window_(settings.frames) {
    held_.reserve(CodeSearch::kMostHeld + 1);
  }

  bool relative() const override { return true; }
  bool shares_zero() const override { return true; }

  void on_coded_pulses(const std::shared_ptr<const CodedPulses>& pulses) override {
    pulses_ = pulses;
    decoder_.emplace(pulses, settings_.decoder);
  }

  GlobalTime stamp(const DeviceSample& sample) override {
    SIMBENCH_ASSERT(decoder_.has_value(), "a coded trigger has a code");
    if (!first_) first_ = sample.sensor;
    const Decoded decoded = decoder_->push(sample.sensor, sample.exposure_us);
    if (!decoded.is_refused) take(decoded, sample.sensor + half_exposure(sample));
    if (!anchor_) {
      const Int128 elapsed_us = Int128{us_of(sample.sensor)} - us_of(*first_);
      return GlobalTime(Nanoseconds(saturate(1000 * elapsed_us)));
    }
    const Microseconds half = half_exposure(sample);
    const DeviceTime at_pulse = sample.sensor + half;
    return anchor_->stamp(at_pulse, window_.line().at(anchor_->x(at_pulse))) - half;
  }

 private:
  static std::int64_t us_of(DeviceTime time) { return time.time_since_epoch().count(); }

  // From the middle of the exposure to the end of it that follows the pulse.
  Microseconds half_exposure(const DeviceSample& sample) const {
    const Microseconds half(sample.exposure_us / 2);
    return pulses_->exposures_begin_at_pulse ? -half : half;
  }

  void take(const Decoded& decoded, DeviceTime at_pulse) {
    held_.push_back(at_pulse);
    held_.erase(held_.begin(), held_.begin() + decoded.given_up);
    if (decoded.has_found_place) begin_line();
    for (std::size_t i = 0; i < decoded.indexed; ++i) {
      add(held_[i], decoded.has_found_place ? decoder_->found_index(i) : decoder_->newest_index());
    }
    held_.erase(held_.begin(), held_.begin() + decoded.indexed);
  }

  // The clock, or the trigger, may be another than before.
  void begin_line() {
    anchor_.reset();
    window_ = LineWindow(settings_.frames);
  }

  void add(DeviceTime at_pulse, std::int64_t index) {
    const TriggerCode& code = pulses_->code;
    const Int128 due_ns = Int128{index} * code.period().count() + code.shift(index).count();
    const HostTime due{Nanoseconds(saturate(due_ns))};
    const DeviceSample point = {.sensor = at_pulse,
                                .arrival = due,
                                .arrival_steady = SteadyTime(due.time_since_epoch()),
                                .exposure_us = 0};
    if (!anchor_) anchor_.emplace(point);
    window_.push(anchor_->point(point));
  }

  CodedTimeSettings settings_;
  std::shared_ptr<const CodedPulses> pulses_;
  std::optional<CodeDecoder> decoder_;
  std::vector<DeviceTime> held_;  // at the pulse
  std::optional<DeviceTime> first_;
  std::optional<SampleAnchor> anchor_;  // from the first point on
  LineWindow window_;
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_coded(const CodedTimeSettings& settings) {
  SIMBENCH_ASSERT(settings.frames >= 2, "a line has two points");
  return std::make_unique<CodedTime>(settings);
}

void CodedTimeSettings::bind(ParameterBinder& parameters) {
  decoder.bind(parameters);
  parameters.number("frames", frames, 2, 1e5, "of the line from a camera's stamps to pulses",
                    "docs/coded_trigger.md section 5");
}

std::vector<DeviceTimeEntry> device_time_coded() {
  return {with_settings<DeviceTimeEntry>(
      {.name = "coded",
       .family = "coded_trigger",
       .summary = "line from the sensor stamps to the pulses of a coded trigger",
       .source = "docs/coded_trigger.md section 5",
       .needs = {Need::kTriggerCode}},
      CodedTimeSettings{}, make_coded)};
}

}  // namespace simbench

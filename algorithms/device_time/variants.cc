#include "algorithms/device_time/variants.h"

#include <utility>
#include <vector>

#include "algorithms/device_time/clock_map.h"
#include "laws/saturate.h"

namespace simbench {
namespace {

// Changes the samples on their way to the inner estimator.
class Adapter : public DeviceTimeEstimator {
 public:
  explicit Adapter(std::unique_ptr<DeviceTimeEstimator> inner) : inner_(std::move(inner)) {}

  GlobalTime stamp(const DeviceSample& sample) override { return inner_->stamp(adapted(sample)); }
  bool offline() const override { return inner_->offline(); }
  void learn(std::span<const DeviceSample> recording) override {
    std::vector<DeviceSample> samples;
    samples.reserve(recording.size());
    for (const DeviceSample& sample : recording) samples.push_back(adapted(sample));
    inner_->learn(samples);
  }
  bool from_first_frame() const override { return inner_->from_first_frame(); }
  void on_poll(const PollSample& poll) override { inner_->on_poll(poll); }
  void on_adjustment(const ClockAdjustment& adjustment) override {
    inner_->on_adjustment(adjustment);
  }
  void on_led_sighting(const LedSample& sighting) override { inner_->on_led_sighting(sighting); }
  void on_coded_pulses(const std::shared_ptr<const CodedPulses>& pulses) override {
    inner_->on_coded_pulses(pulses);
  }
  bool relative() const override { return inner_->relative(); }
  bool shares_zero() const override { return inner_->shares_zero(); }

 protected:
  virtual DeviceSample adapted(const DeviceSample& sample) const = 0;
  DeviceTimeEstimator& inner() { return *inner_; }

 private:
  std::unique_ptr<DeviceTimeEstimator> inner_;
};

HostTime as_host(SteadyTime steady) { return HostTime(steady.time_since_epoch()); }

class OnSteadyClock final : public Adapter {
 public:
  using Adapter::Adapter;

  GlobalTime stamp(const DeviceSample& sample) override {
    const GlobalTime stamp = Adapter::stamp(sample);
    if (relative()) return stamp;
    const SteadyTime steady(stamp.time_since_epoch());
    if (const auto system = map_.to_system(steady)) return GlobalTime(system->time_since_epoch());
    const Int128 offset_ns =
        Int128{nanoseconds_of(sample.arrival)} - nanoseconds_of(sample.arrival_steady);
    return GlobalTime(Nanoseconds(saturate(nanoseconds_of(steady) + offset_ns)));
  }

  void on_poll(const PollSample& poll) override {
    PollSample steady = poll;
    steady.t0 = as_host(poll.t0_steady);
    steady.t1 = as_host(poll.t1_steady);
    inner().on_poll(steady);
  }

  void on_adjustment(const ClockAdjustment& adjustment) override {
    map_.add(adjustment);
    inner().on_adjustment(adjustment);
  }

 private:
  DeviceSample adapted(const DeviceSample& sample) const override {
    DeviceSample steady = sample;
    steady.arrival = as_host(sample.arrival_steady);
    return steady;
  }

  ClockMap map_;
};

template <class Time>
Time earlier(Time time, Int128 by_ns) {
  return Time(Nanoseconds(saturate(nanoseconds_of(time) - by_ns)));
}

class DelayCorrected final : public Adapter {
 public:
  DelayCorrected(std::unique_ptr<DeviceTimeEstimator> inner, const CalibratedDelays& delays)
      : Adapter(std::move(inner)), delays_(delays) {}

  void on_poll(const PollSample& poll) override {
    const Int128 early_ns = -delays_.poll_asymmetry.count() / 2;
    PollSample corrected = poll;
    corrected.t0 = earlier(poll.t0, early_ns);
    corrected.t1 = earlier(poll.t1, early_ns);
    corrected.t0_steady = earlier(poll.t0_steady, early_ns);
    corrected.t1_steady = earlier(poll.t1_steady, early_ns);
    inner().on_poll(corrected);
  }

 private:
  DeviceSample adapted(const DeviceSample& sample) const override {
    const Int128 latency_ns = Int128{500} * sample.exposure_us + delays_.arrival.count();
    DeviceSample corrected = sample;
    corrected.arrival = earlier(sample.arrival, latency_ns);
    corrected.arrival_steady = earlier(sample.arrival_steady, latency_ns);
    return corrected;
  }

  CalibratedDelays delays_;
};

class OnSdkStamps final : public Adapter {
 public:
  using Adapter::Adapter;

 private:
  DeviceSample adapted(const DeviceSample& sample) const override {
    DeviceSample cut = sample;
    const std::int64_t steps = floor_div(nanoseconds_of(sample.arrival), kSdkResolution.count());
    cut.arrival = HostTime(Nanoseconds(saturate(Int128{steps} * kSdkResolution.count())));
    return cut;
  }
};

// Removes `suffix` from the end of `name`, once.
bool take(std::string_view& name, std::string_view suffix, bool& taken) {
  if (taken || !name.ends_with(suffix)) return false;
  name.remove_suffix(suffix.size());
  return taken = true;
}

}  // namespace

std::unique_ptr<DeviceTimeEstimator> on_steady_clock(std::unique_ptr<DeviceTimeEstimator> inner) {
  return std::make_unique<OnSteadyClock>(std::move(inner));
}

std::unique_ptr<DeviceTimeEstimator> on_sdk_stamps(std::unique_ptr<DeviceTimeEstimator> inner) {
  return std::make_unique<OnSdkStamps>(std::move(inner));
}

std::unique_ptr<DeviceTimeEstimator> exposure_corrected(
    std::unique_ptr<DeviceTimeEstimator> inner) {
  return delay_corrected(std::move(inner), {});
}

std::unique_ptr<DeviceTimeEstimator> delay_corrected(std::unique_ptr<DeviceTimeEstimator> inner,
                                                     const CalibratedDelays& delays) {
  return std::make_unique<DelayCorrected>(std::move(inner), delays);
}

DeviceTimeName parse_device_time_name(std::string_view name) {
  DeviceTimeName parsed;
  while ((!parsed.sdk && take(name, "_steady", parsed.steady)) ||
         (!parsed.steady && take(name, "_sdk", parsed.sdk)) ||
         take(name, "_exposure_corrected", parsed.exposure_corrected) ||
         take(name, "_calibrated", parsed.calibrated)) {
  }
  parsed.base = name;
  parsed.exposure_corrected = parsed.exposure_corrected || parsed.calibrated;
  return parsed;
}

std::unique_ptr<DeviceTimeEstimator> make_variant(const DeviceTimeName& name,
                                                  std::unique_ptr<DeviceTimeEstimator> inner,
                                                  const CalibratedDelays& delays) {
  if (name.calibrated) {
    inner = delay_corrected(std::move(inner), delays);
  } else if (name.exposure_corrected) {
    inner = exposure_corrected(std::move(inner));
  }
  if (name.sdk) return on_sdk_stamps(std::move(inner));
  return name.steady ? on_steady_clock(std::move(inner)) : std::move(inner);
}

}  // namespace simbench

// A recording as text, with all that is in it and in its order: for comparing whole recordings.
#ifndef SIMBENCH_TESTS_SIM_RIG_WRITTEN_RECORDING_H_
#define SIMBENCH_TESTS_SIM_RIG_WRITTEN_RECORDING_H_

#include <fmt/format.h>

#include <cstdint>
#include <iterator>
#include <string>

#include "recording/recording.h"

namespace simbench::sim {

class WrittenRecording final : public RecordingSink {
 public:
  void on_start(const RigLayout& layout) override {
    line("start", layout.hosts, layout.cameras.size(), layout.frame_rate_hz, layout.first_pulse,
         layout.pulses);
  }
  void on_frame(const FrameRecord& frame, const FrameTruth* truth) override {
    line("frame", frame.camera, static_cast<int>(frame.stream), static_cast<int>(frame.domain),
         frame.counter, frame.exposure_us, frame.sensor.us, frame.frame.us, ns(frame.backend),
         ns(frame.arrival), ns(frame.arrival_steady));
    line("truth", truth->pulse, ns(truth->exposure_start), ns(truth->exposure_end),
         ns(truth->reference), ns(truth->own_host), ns(truth->own_steady), ns(truth->delivered));
  }
  void on_pulse(const PulseTruth& truth) override {
    line("pulse", truth.pulse, ns(truth.at));
    for (const Nanoseconds error : truth.host_errors) line("error", error.count());
  }
  void on_adjustment(const ClockAdjustment& a) override {
    line("adjustment", a.host, ns(a.at), ns(a.before), ns(a.after), a.rate_ppb);
  }
  void on_poll(const DevicePoll& poll) override {
    line("poll", poll.camera, poll.device.us, ns(poll.t0), ns(poll.t1), ns(poll.t0_steady),
         ns(poll.t1_steady));
  }
  void on_exchange(std::uint32_t host, const Exchange& e) override {
    line("exchange", host, e.peer);
    for (const auto& stamp : {e.t1, e.t2, e.t3, e.t4}) line("t", stamp ? ns(*stamp) : -1);
  }
  void on_outcome(const SyncOutcome& o) override {
    line("outcome", o.slave, o.synchronised, o.passes, o.message);
  }
  void on_alignment(const AlignmentReport& r) override {
    line("alignment", r.camera, r.aligned, r.controls, r.message);
  }
  void on_led_sighting(const LedSighting& s) override {
    line("led", s.camera, s.sensor.us, s.led_start_ns, s.led_end_ns);
  }

  std::string text;

 private:
  template <class Time>
  static std::int64_t ns(Time time) {
    return time.time_since_epoch().count();
  }
  template <class... Values>
  void line(const Values&... values) {
    (fmt::format_to(std::back_inserter(text), "{} ", values), ...);
    text += '\n';
  }
};

}  // namespace simbench::sim

#endif  // SIMBENCH_TESTS_SIM_RIG_WRITTEN_RECORDING_H_

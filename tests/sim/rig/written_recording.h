// A recording as text, with all that is in it and in its order: for comparing whole recordings.
#ifndef SIMBENCH_TESTS_SIM_RIG_WRITTEN_RECORDING_H_
#define SIMBENCH_TESTS_SIM_RIG_WRITTEN_RECORDING_H_

#include <fmt/format.h>

#include <cstdint>
#include <iterator>
#include <string>
#include <variant>

#include "tests/recording/test_sink.h"

namespace simbench::sim {

class WrittenRecording final : public TestSink {
 public:
  void on_start(const RigLayout& layout) override {
    line("start", layout.hosts, layout.cameras.size(), layout.frame_rate_hz, layout.first_pulse,
         layout.pulses);
  }
  void on_event(const RecordingEvent& event) override {
    std::visit([this](const auto& each) { write(each); }, event);
  }

  std::string text;

 private:
  template <class Time>
  static std::int64_t ns(Time time) {
    return time.time_since_epoch().count();
  }
  void frame_came(const FrameRecord& frame, const FrameTruth* truth) override {
    line("frame", frame.camera, static_cast<int>(frame.stream), static_cast<int>(frame.domain),
         frame.counter, frame.exposure_us, frame.sensor.us, frame.frame.us, ns(frame.backend),
         ns(frame.arrival), ns(frame.arrival_steady));
    line("truth", truth->pulse, ns(truth->exposure_start), ns(truth->exposure_end),
         ns(truth->reference), ns(truth->own_host), ns(truth->own_steady), ns(truth->delivered));
  }
  void write(const PulseTruth& truth) {
    line("pulse", truth.pulse, ns(truth.at));
    for (const Nanoseconds error : truth.host_errors) line("error", error.count());
  }
  void write(const ClockAdjustment& a) {
    line("adjustment", a.host, ns(a.at), ns(a.before), ns(a.after), a.rate_ppb);
  }
  void write(const DevicePoll& poll) {
    line("poll", poll.camera, poll.device.us, ns(poll.t0), ns(poll.t1), ns(poll.t0_steady),
         ns(poll.t1_steady));
  }
  void write(const ExchangeEvent& e) {
    line("exchange", e.host, e.exchange.peer);
    for (const auto& stamp : {e.exchange.t1, e.exchange.t2, e.exchange.t3, e.exchange.t4}) {
      line("t", stamp ? ns(*stamp) : -1);
    }
  }
  void write(const SyncOutcome& o) {
    line("outcome", o.slave, o.synchronised, o.passes, o.message);
  }
  void write(const AlignmentReport& r) {
    line("alignment", r.camera, r.aligned, r.controls, r.message);
  }
  void write(const LedSighting& s) {
    line("led", s.camera, s.sensor.us, s.led_start_ns, s.led_end_ns);
  }
  template <class... Values>
  void line(const Values&... values) {
    (fmt::format_to(std::back_inserter(text), "{} ", values), ...);
    text += '\n';
  }
};

}  // namespace simbench::sim

#endif  // SIMBENCH_TESTS_SIM_RIG_WRITTEN_RECORDING_H_

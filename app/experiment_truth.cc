#include "app/experiment_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "algorithms/device_time/clock_map.h"

namespace simbench::app {
namespace {

using FrameName = std::tuple<std::uint32_t, StreamKind, std::uint32_t>;

FrameName name_of(const FrameRecord& frame) { return {frame.camera, frame.stream, frame.counter}; }

// What was played, counted from the zero of its recording.
class Played {
 public:
  struct Frame {
    FrameTruth truth;
    Nanoseconds delay;  // from the middle of the exposure to its delivery
  };

  explicit Played(const KeptRecording& recording) {
    std::optional<TrueTime> zero;
    for (const RecordingEvent& event : recording.events()) {
      const auto* frame = std::get_if<FrameEvent>(&event);
      if (frame == nullptr || !frame->truth) continue;
      frames_.emplace(name_of(frame->record), Frame{*frame->truth, frame->record.arrival_steady -
                                                                       frame->truth->own_steady});
      if (frame->truth->pulse < 0) continue;
      zero = std::min(zero.value_or(frame->truth->exposure_start), frame->truth->exposure_start);
    }
    if (!zero) throw RecordingFailed("the played capture has no frame that a pulse exposed");
    zero_ = *zero;
    for (const RecordingEvent& event : recording.events()) {
      if (const auto* pulse = std::get_if<PulseEvent>(&event)) pulses_.push_back(*pulse);
    }
    std::stable_sort(pulses_.begin(), pulses_.end(),
                     [](const PulseEvent& a, const PulseEvent& b) { return a.at < b.at; });
  }

  const Frame& find(const FrameRecord& frame) const {
    const auto found = frames_.find(name_of(frame));
    if (found == frames_.end()) {
      throw RecordingFailed(
          fmt::format("camera {}: frame {} was never played", frame.camera, frame.counter));
    }
    return found->second;
  }
  const std::vector<PulseEvent>& pulses() const { return pulses_; }  // in order of time
  Nanoseconds since_zero(TrueTime at) const { return at - zero_; }

 private:
  std::map<FrameName, Frame> frames_;
  std::vector<PulseEvent> pulses_;
  TrueTime zero_;
};

// What each host's clocks read at an instant.
class Clocks {
 public:
  Clocks(std::vector<hardware::NodeOscillator> oscillators, const KeptRecording& captured)
      : oscillators_(std::move(oscillators)), maps_(oscillators_.size()) {
    for (const RecordingEvent& event : captured.events()) {
      const auto* adjustment = std::get_if<ClockAdjustment>(&event);
      if (adjustment != nullptr && adjustment->host < maps_.size()) {
        maps_[adjustment->host].add(*adjustment);
      }
    }
    for (std::size_t host = 0; host < maps_.size(); ++host) {
      if (maps_[host].segments() == 0) {
        throw RecordingFailed(fmt::format("host {} left no log of its clock", host));
      }
    }
  }

  std::size_t hosts() const { return maps_.size(); }
  SteadyTime steady(std::size_t host, MonotonicTime at) const {
    return oscillators_[host].steady(at);
  }
  HostTime system(std::size_t host, MonotonicTime at) const {
    return maps_[host].to_system(steady(host, at)).value();
  }
  MonotonicTime when(std::size_t host, SteadyTime at) const { return oscillators_[host].when(at); }

 private:
  std::vector<hardware::NodeOscillator> oscillators_;
  std::vector<ClockMap> maps_;
};

class Notifier {
 public:
  Notifier(const ExperimentTruth& truth, const KeptRecording& captured, RecordingSink& sink)
      : played_(truth.played),
        zero_(truth.zero),
        layout_(truth.played.layout()),
        clocks_(truth.oscillators, captured),
        sink_(sink) {
    if (clocks_.hosts() != layout_.hosts) {
      throw RecordingFailed(
          fmt::format("{} hosts answered, {} were played to", clocks_.hosts(), layout_.hosts));
    }
  }

  void tell_all(const KeptRecording& captured) {
    sink_.on_start(layout_);
    for (const RecordingEvent& event : captured.events()) {
      if (const auto* frame = std::get_if<FrameEvent>(&event)) {
        tell_frame(frame->record);
      } else {
        notify(event, sink_);
      }
    }
    tell_pulses(MonotonicTime::max());
  }

 private:
  MonotonicTime instant(TrueTime played) const { return zero_ + played_.since_zero(played); }
  static TrueTime as_true(MonotonicTime at) { return TrueTime(at.time_since_epoch()); }

  void tell_frame(const FrameRecord& frame) {
    const std::uint32_t host = layout_.cameras.at(frame.camera).host;
    const MonotonicTime arrived = clocks_.when(host, frame.arrival_steady);
    tell_pulses(arrived);
    FrameTruth truth = played_.find(frame).truth;
    const MonotonicTime middle = instant(truth.mid_exposure());
    truth.exposure_start = as_true(instant(truth.exposure_start));
    truth.exposure_end = as_true(instant(truth.exposure_end));
    truth.reference = clocks_.system(0, middle);
    truth.own_host = clocks_.system(host, middle);
    truth.own_steady = clocks_.steady(host, middle);
    truth.delivered = clocks_.system(0, arrived);
    sink_.on_frame(frame, &truth);
  }

  // Those up to this instant.
  void tell_pulses(MonotonicTime until) {
    for (; told_ < played_.pulses().size(); ++told_) {
      const PulseEvent& pulse = played_.pulses()[told_];
      const MonotonicTime at = instant(pulse.at);
      if (at > until) return;
      const HostTime master = clocks_.system(0, at);
      std::vector<Nanoseconds> errors;
      for (std::size_t host = 0; host < clocks_.hosts(); ++host) {
        errors.push_back(clocks_.system(host, at) - master);
      }
      sink_.on_pulse({.pulse = pulse.pulse, .at = as_true(at), .host_errors = errors});
    }
  }

  Played played_;
  MonotonicTime zero_;
  const RigLayout& layout_;
  Clocks clocks_;
  RecordingSink& sink_;
  std::size_t told_ = 0;
};

}  // namespace

void add_truth(const ExperimentTruth& truth, const KeptRecording& captured, RecordingSink& sink) {
  Notifier(truth, captured, sink).tell_all(captured);
}

}  // namespace simbench::app

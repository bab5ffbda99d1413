#include "sim/rig/capture.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace simbench::sim {

Capture::Capture(const scenarios::Scenario& scenario, Engine& engine,
                 std::vector<SystemClock*> clocks, const Outages& outages,
                 const CaptureReports& reports, std::vector<ClockInterface> interfaces)
    : scenario_(scenario),
      engine_(engine),
      clocks_(std::move(clocks)),
      outages_(outages),
      reports_(reports),
      slots_(evaluated_slots(scenario)),
      arrival_quantum_(from_ms(scenario.hosts.clock.arrival_quantum_ms)),
      backend_stamps_(scenario.usb.backend_stamp, arrival_quantum_),
      interfaces_(std::move(interfaces)),
      host_errors_(clocks_.size()) {
  interfaces_.resize(clocks_.size(), ClockInterface({}, {}, {}));
}

RigLayout Capture::layout() const {
  RigLayout layout{.hosts = static_cast<std::uint32_t>(clocks_.size()),
                   .cameras = {},
                   .frame_rate_hz = scenario_.trigger.rate_hz,
                   .first_pulse = slots_.first,
                   .pulses = scenario_.timeline.frames};
  for (std::int64_t camera = 0; camera < scenario_.cameras.count; ++camera) {
    layout.cameras.push_back({static_cast<std::uint32_t>(scenario_.host_of(camera))});
  }
  return layout;
}

void Capture::start(CameraWorld& world, std::function<void()> on_end,
                    const std::atomic<bool>* cancel) {
  SIMBENCH_ASSERT(world.start() == engine_.now(), "the cameras start with the capture");
  world_ = &world;
  for (const SystemClock* clock : clocks_) steady_starts_.push_back(clock->steady(world.start()));
  cancel_ = cancel;
  on_end_ = std::move(on_end);
  reports_.start(engine_.now());
  for (const scenarios::Fault& fault : scenario_.faults) {
    const auto* step = std::get_if<scenarios::ClockStep>(&fault);
    if (step == nullptr) continue;
    engine_.call_at(engine_.now() + from_ms(step->at_ms), [this, step] { step_clock(*step); });
  }
  engine_.call_at(world.last_exposure(), [this] { end(); });
  begin_period(0);
  next_at_ = next_in_period();
}

void Capture::step_clock(const scenarios::ClockStep& fault) {
  SystemClock& clock = *clocks_[static_cast<std::size_t>(fault.host)];
  clock.set(engine_.now(), clock.read(engine_.now()) + from_ms(fault.step_ms));
}

// No exposure begins any more: the last period has been made, and with it the end is known.
void Capture::end() {
  catch_up();
  if (world_->end() > engine_.now()) {
    engine_.call_at(world_->end(), [this] { end(); });
  } else {
    on_end_();
  }
}

void Capture::begin_period(std::size_t number) {
  if (cancel_ != nullptr && *cancel_) throw RecordingCancelled();
  period_ = world_->period(number);
  period_number_ = number;
  is_pulse_reported_ = false;
  frames_reported_ = polls_reported_ = 0;
}

TrueTime Capture::next_frame_at() const {
  return frames_reported_ < period_->frames.size() ? period_->frames[frames_reported_].at
                                                   : TrueTime::max();
}

TrueTime Capture::next_poll_at() const {
  return polls_reported_ < period_->polls.size() ? period_->polls[polls_reported_].end
                                                 : TrueTime::max();
}

// Goes on to the next period if nothing is left of this one.
TrueTime Capture::next_in_period() {
  while (period_ != nullptr) {
    if (period_->pulse && !is_pulse_reported_) return period_->pulse->at;
    const TrueTime next = std::min(next_frame_at(), next_poll_at());
    if (next != TrueTime::max()) return next;
    begin_period(period_number_ + 1);
  }
  return TrueTime::max();
}

void Capture::report_through(TrueTime now) {
  next_at_ = TrueTime::max();  // who is reported to may ask again
  TrueTime next = next_in_period();
  for (; next <= now; next = next_in_period()) {
    if (period_->pulse && !is_pulse_reported_) {
      is_pulse_reported_ = true;
      report_pulse(*period_->pulse);
    } else if (next == next_poll_at()) {
      report_poll(period_->polls[polls_reported_++]);
    } else {
      report_frames(std::min(now, next_poll_at() - Nanoseconds(1)));
    }
  }
  next_at_ = next;
}

void Capture::report_pulse(const CameraPulse& pulse) {
  if (pulse.slot >= slots_.first) {
    read_errors(clocks_, pulse.at, host_errors_);
    reports_.recorded_pulse({.pulse = pulse.slot, .at = pulse.at, .host_errors = host_errors_});
  }
  reports_.pulse(pulse);
}

void Capture::report_poll(const CameraPoll& poll) {
  const auto host = static_cast<std::size_t>(scenario_.host_of(poll.camera));
  if (outages_.host_stopped(static_cast<PeerId>(host), poll.end)) return;
  const SystemClock& clock = *clocks_[host];
  reports_.poll({.camera = poll.camera,
                 .device = poll.device,
                 .t0 = interfaces_[host].read(clock.read(poll.begin)),
                 .t1 = interfaces_[host].read(clock.read(poll.end)),
                 .t0_steady = clock.steady(poll.begin),
                 .t1_steady = clock.steady(poll.end)});
}

// Those of this period until `last`, at least one.
void Capture::report_frames(TrueTime last) {
  const std::vector<CameraFrame>& frames = period_->frames;
  const std::size_t first = frames_reported_;
  do {
    ++frames_reported_;
  } while (frames_reported_ < frames.size() && frames[frames_reported_].at <= last);
  const std::span<const CameraFrame> block(frames.data() + first, frames_reported_ - first);
  if (!reports_.are_single()) return report_block(block);
  for (const CameraFrame& frame : block) report_single(frame);
}

void Capture::report_block(std::span<const CameraFrame> frames) {
  records_.clear();
  truths_.clear();
  for (const CameraFrame& frame : frames) {
    const CameraStream& stream = world_->cameras().stream(frame.stream);
    if (frame.fate != FrameFate::kDelivered || is_stopped(stream.host, frame.at)) continue;
    stamp(frame, stream);
  }
  if (!records_.empty()) reports_.frames(records_, truths_);
}

void Capture::report_single(const CameraFrame& frame) {
  const CameraStream& stream = world_->cameras().stream(frame.stream);
  if (frame.fate == FrameFate::kDelivered) {
    if (is_stopped(stream.host, frame.at)) return;
    report_block({&frame, 1});
    reports_.used(records_.front(), stream, frame.at);
  }
  reports_.observed(frame, stream);
}

// What its host and the master make of a frame.
void Capture::stamp(const CameraFrame& frame, const CameraStream& stream) {
  const SystemClock& clock = *clocks_[stream.host];
  const TrueTime middle = frame.mid_exposure();
  const SystemClock::Reading arrival = clock.read_both(frame.at);
  const SystemClock::Reading exposed = clock.read_both(middle);
  records_.push_back(
      {.camera = stream.camera,
       .stream = stream.kind,
       .counter = frame.counter,
       .exposure_us = frame.exposure_us,
       .sensor = frame.sensor,
       .frame = frame.frame,
       .backend = backend_stamps_.stamp(clock, steady_starts_[stream.host], frame.copied, arrival),
       .arrival = round_down(arrival.system, arrival_quantum_),
       .arrival_steady = round_down(arrival.steady, arrival_quantum_)});
  truths_.push_back({.pulse = frame.pulse,
                     .exposure_start = frame.exposure_start,
                     .exposure_end = frame.exposure_end,
                     .reference = clocks_[0]->read(middle),
                     .own_host = exposed.system,
                     .own_steady = exposed.steady,
                     .delivered = clocks_[0]->read(frame.at)});
}

}  // namespace simbench::sim

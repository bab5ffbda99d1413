#include "sim/rig/capture.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace simbench::sim {
namespace {

constexpr std::size_t kAhead = 16;  // frames, for the cache

// A camera's stamp by its host's steady clock, with the noise of its own stamps.
DeviceStamp host_stamp(const SimFrame& frame, SteadyTime reading, Nanoseconds epoch) {
  const SteadyTime noisy = reading + epoch + from_ns_down(frame.stamp_noise_ns);
  return {static_cast<std::uint32_t>(floor_div(noisy.time_since_epoch().count(), 1000))};
}

}  // namespace

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
      stamps_on_host_(scenario.cameras.stamp_clock == scenarios::ClockOwner::kHost),
      pulse_event_(PulseTruth{.host_errors = std::vector<Nanoseconds>(clocks_.size())}) {
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

void Capture::start(CameraWorld& world, CameraStamps& stamps, std::function<void()> on_end,
                    const std::atomic<bool>* cancel) {
  const TrueTime now = engine_.now();
  SIMBENCH_ASSERT(stamps.start() == now, "the cameras start with the capture");
  world_ = &world;
  stamps_ = &stamps;
  shift_ = now.time_since_epoch();
  cancel_ = cancel;
  for (const SystemClock* clock : clocks_) steady_starts_.push_back(clock->steady(now));
  on_end_ = std::move(on_end);
  reports_.start(now);
  if (scenario_.cameras.led_clock) {
    led_clock_.emplace(scenario_, world.seed(), world.last_exposure());
  }
  for (const scenarios::Fault& fault : scenario_.faults) {
    const auto* step = std::get_if<scenarios::ClockStep>(&fault);
    if (step == nullptr) continue;
    engine_.call_at(now + from_ms(step->at_ms), [this, step] { step_clock(*step); });
  }
  engine_.call_at(date(world.last_exposure()), [this] { end(); });
  begin_period(0);
  next_at_ = date(next_in_period(TrueTime{}));
}

void Capture::step_clock(const scenarios::ClockStep& fault) {
  SystemClock& clock = *clocks_[static_cast<std::size_t>(fault.host)];
  clock.set(engine_.now(), clock.read(engine_.now()) + from_ms(fault.step_ms));
}

// No exposure begins any more: the last period has been made, and with it the end is known.
void Capture::end() {
  catch_up();
  if (date(world_->end()) > engine_.now()) {
    engine_.call_at(date(world_->end()), [this] { end(); });
  } else {
    on_end_();
  }
}

void Capture::begin_period(std::size_t number) {
  if (cancel_ != nullptr && *cancel_) throw RecordingCancelled();
  period_ = world_->period(number);
  if (period_ != nullptr) period_stamps_ = stamps_->of_period(number, *period_);
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

// Goes on to the next period if nothing is left of this one. One of steered cameras is not made
// before `now`: until then, its begin is what happens next.
TrueTime Capture::next_in_period(TrueTime now) {
  while (period_ != nullptr) {
    if (period_->pulse && !is_pulse_reported_) return period_->pulse->at;
    const TrueTime next = std::min(next_frame_at(), next_poll_at());
    if (next != TrueTime::max()) return next;
    if (world_->is_steered() && period_->end > now) return period_->end;
    begin_period(period_number_ + 1);
  }
  return TrueTime::max();
}

void Capture::report_through(TrueTime now) {
  next_at_ = TrueTime::max();  // who is reported to may ask again
  const TrueTime until = now - shift_;
  TrueTime next = next_in_period(until);
  for (; next <= until; next = next_in_period(until)) {
    if (period_->pulse && !is_pulse_reported_) {
      is_pulse_reported_ = true;
      report_pulse(*period_->pulse);
    } else if (next == next_poll_at()) {
      report_poll(period_->polls[polls_reported_++]);
    } else {
      report_frames(std::min(until, next_poll_at() - Nanoseconds(1)));
    }
  }
  if (next != TrueTime::max()) next_at_ = date(next);
}

void Capture::report_pulse(const ObservedPulse& pulse) {
  const TrueTime at = date(pulse.at);
  if (pulse.pulse >= slots_.first) {
    auto& truth = std::get<PulseTruth>(pulse_event_);
    truth.pulse = pulse.pulse;
    truth.at = at;
    read_errors(clocks_, at, truth.host_errors);
    reports_.recorded(pulse_event_);
  }
  reports_.pulse(pulse.pulse, at);
}

void Capture::report_poll(const CameraPoll& poll) {
  const auto host = static_cast<std::size_t>(scenario_.host_of(poll.camera));
  const TrueTime begin = date(poll.begin);
  const TrueTime end = date(poll.end);
  if (outages_.host_stopped(static_cast<PeerId>(host), end)) return;
  const SystemClock& clock = *clocks_[host];
  reports_.poll({.camera = poll.camera,
                 .device = stamps_->of_poll(poll),
                 .t0 = interfaces_[host].read(clock.read(begin)),
                 .t1 = interfaces_[host].read(clock.read(end)),
                 .t0_steady = clock.steady(begin),
                 .t1_steady = clock.steady(end)},
                static_cast<std::uint32_t>(host));
}

// Reports the frames of this period until `last`, at least one.
void Capture::report_frames(TrueTime last) {
  const std::vector<SimFrame>& frames = period_->frames;
  const std::size_t first = frames_reported_;
  do {
    ++frames_reported_;
  } while (frames_reported_ < frames.size() && frames[frames_reported_].at <= last);
  const std::size_t end = frames_reported_;
  if (!reports_.are_single()) return report_block(first, end);
  for (std::size_t number = first; number < end; ++number) report_single(number);
}

void Capture::report_block(std::size_t first, std::size_t end) {
  records_.clear();
  truths_.clear();
  flushed_ = 0;
  const std::vector<SimFrame>& frames = period_->frames;
  for (std::size_t i = first; i < end; ++i) {
    if (i + 2 * kAhead < end) clocks_[frames[i + 2 * kAhead].host]->prefetch();
    if (i + kAhead < end) clocks_[frames[i + kAhead].host]->prefetch_setting();
    const SimFrame& frame = frames[i];
    if (frame.fate != FrameFate::kDelivered || is_stopped(frame)) continue;
    stamp(frame, period_stamps_[i]);
    if (led_clock_) report_sighting(frame);
  }
  flush();
}

void Capture::flush() {
  if (flushed_ == records_.size()) return;
  reports_.frames(std::span(records_).subspan(flushed_), std::span(truths_).subspan(flushed_));
  flushed_ = records_.size();
}

// Reports the LED clock after the newest frame of the block, if that shows it.
void Capture::report_sighting(const SimFrame& frame) {
  const auto lit = led_clock_->read(frame, world_->cameras().stream(frame.stream).readout);
  if (!lit) return;
  flush();
  reports_.recorded(LedSighting{.camera = frame.camera,
                                .sensor = records_.back().sensor,
                                .led_start_ns = lit->start.count(),
                                .led_end_ns = lit->end.count()});
}

void Capture::report_single(std::size_t number) {
  const SimFrame& frame = period_->frames[number];
  if (frame.fate == FrameFate::kDelivered) {
    if (is_stopped(frame)) return;
    report_block(number, number + 1);
    reports_.used(records_.front(), world_->cameras().stream(frame.stream), date(frame.at));
  }
  reports_.observed(frame, shift_);
}

// What its host and the master make of a frame.
void Capture::stamp(const SimFrame& frame, const FrameStamps& stamps) {
  const SystemClock& clock = *clocks_[frame.host];
  const TrueTime middle = date(frame.mid_exposure());
  const TrueTime at = date(frame.at);
  const SystemClock::Reading arrival = clock.read_both(at);
  const SystemClock::Reading exposed = clock.read_both(middle);
  const bool is_master = frame.host == 0;
  const bool on_host = stamps_on_host_;
  const std::vector<double>& epochs_s = scenario_.cameras.stamp_epoch_of_camera_s;
  const Nanoseconds epoch =
      epochs_s.empty() ? Nanoseconds(0) : from_seconds(epochs_s[frame.camera]);
  records_.push_back(
      {.camera = frame.camera,
       .stream = frame.kind,
       .counter = frame.counter,
       .exposure_us = frame.exposure_us,
       .sensor = on_host ? host_stamp(frame, exposed.steady, epoch) : stamps.sensor,
       .frame = on_host ? host_stamp(frame, clock.steady(date(frame.readout_start)), epoch)
                        : stamps.frame,
       .backend =
           backend_stamps_.stamp(clock, steady_starts_[frame.host], date(frame.copied), arrival),
       .arrival = arrival_quantum_.round_down(arrival.system),
       .arrival_steady = arrival_quantum_.round_down(arrival.steady)});
  truths_.push_back({.pulse = frame.pulse,
                     .exposure_start = date(frame.exposure_start),
                     .exposure_end = date(frame.exposure_end),
                     .reference = is_master ? exposed.system : clocks_[0]->read(middle),
                     .own_host = exposed.system,
                     .own_steady = exposed.steady,
                     .delivered = is_master ? arrival.system : clocks_[0]->read(at)});
}

}  // namespace simbench::sim

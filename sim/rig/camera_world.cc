#include "sim/rig/camera_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "algorithms/ports/assert.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kLateFrame("host: late delivery of a frame");
// The parts of a period where cameras are steered: what is made ahead is short against a frame.
constexpr int kSteeredParts = 8;
// Frames of steered cameras may come to lag behind the slots.
constexpr std::int64_t kMoreSlots = 8;

std::size_t bytes_of(const CameraPeriod& period) {
  return sizeof(CameraPeriod) + period.frames.capacity() * sizeof(SimFrame) +
         period.polls.capacity() * sizeof(CameraPoll);
}

}  // namespace

EvaluatedSlots evaluated_slots(const scenarios::Scenario& scenario) {
  const TriggerTree trigger(scenario.trigger, 0, 0);
  const std::int64_t first =
      trigger.first_slot_from(TrueTime(from_ms(scenario.timeline.warm_up_ms)));
  return {.first = first, .last = first + scenario.timeline.frames - 1};
}

CameraWorld::CameraWorld(const scenarios::Scenario& scenario, std::uint64_t seed, TrueTime start,
                         const EngineLimits& limits, std::size_t kept_bytes, Steering steering)
    : scenario_(scenario),
      seed_(seed),
      start_(start),
      max_events_(limits.max_events),
      slots_(evaluated_slots(scenario)),
      parts_(steering == Steering::kByControls ? kSteeredParts : 1),
      end_slot_(slots_.last + (has_steered_sensors(scenario, steering) ? kMoreSlots : 0)),
      kinds_(static_cast<std::uint32_t>(scenario.cameras.streams.size())),
      unstable_start_(from_ms(scenario.cameras.unstable_start_ms)),
      trigger_(scenario.trigger, static_cast<std::size_t>(scenario.cameras.count), seed),
      cameras_(scenario, seed, start, steering),
      camera_faults_(scenario.faults),
      last_exposure_(trigger_.due(end_slot_ + 2)),
      polls_(scenario, seed, camera_faults_, last_exposure_),
      end_(last_exposure_),
      kept_bytes_(is_steered() ? 0 : kept_bytes) {
  if (has_steered_sensors(scenario, steering)) {
    reference_.emplace(trigger_.due(0), from_ns(1e9 / scenario.trigger.pulse_rate_hz()));
  }
  if (const auto& reader = scenario.hosts.frame_reader) {
    readers_.assign(cameras_.streams().size(), ReaderQueue(*reader));
  }
  camera_faults_.start(TrueTime{});
  make_hosts();
  plan_slot(TrueTime{});
}

// Cameras are numbered host by host, and so are controllers.
void CameraWorld::make_hosts() {
  for (UsbController& controller : cameras_.make_controllers()) {
    buses_.push_back({.controller = std::move(controller), .offers = {}, .first_stream = 0});
  }
  const auto hosts = static_cast<std::size_t>(scenario_.hosts.count);
  hosts_.reserve(hosts);
  for (std::size_t host = 0; host < hosts; ++host) {
    hosts_.push_back(
        {.jitter = HostJitter(scenario_.usb, seed_, host, TrueTime{}, trigger_.period_ns()),
         .load = HostLoad(scenario_.hosts.load_burst, seed_, static_cast<PeerId>(host)),
         .first_stream = 0,
         .end_stream = 0,
         .first_bus = 0,
         .end_bus = 0,
         .next_timer = {}});
  }
  for (std::uint32_t id = 0; id < cameras_.streams().size(); ++id) {
    const SimStream& stream = cameras_.stream(id);
    HostSide& host = hosts_[stream.host];
    if (host.end_stream == 0) {
      host.first_stream = id;
      host.first_bus = stream.controller;
    }
    host.end_stream = id + 1;
    if (stream.index_on_controller == 0) buses_[stream.controller].first_stream = id;
    host.end_bus = stream.controller + 1;
  }
}

const CameraPeriod* CameraWorld::period(std::size_t index) {
  SIMBENCH_ASSERT(index >= dropped_, "a period that is no longer kept");
  const std::size_t place = index - dropped_;
  if (place < periods_.size()) return &periods_[place];
  if (is_over_) return nullptr;
  if (events_ >= max_events_) {
    const double at_s = to_seconds(next_slot_at_.time_since_epoch());
    throw EngineLimitReached(
        fmt::format("limit of {} events reached at {} s in the cameras' half", max_events_, at_s),
        "");
  }
  CameraPeriod next;
  if (bytes_ > kept_bytes_) {
    next = std::move(periods_.back());
    dropped_ += periods_.size();
    periods_.clear();
  }
  make_period(next);
  bytes_ += bytes_of(next);
  return &periods_.emplace_back(std::move(next));
}

// The first period ends with slot 0, the last one when all is over.
void CameraWorld::make_period(CameraPeriod& period) {
  period.end = begin_part(period);
  for (HostSide& host : hosts_) {
    if (period.pulse) expose_by_pulse(host, *period.pulse);
    expose_by_timers(host, std::min(period.end, last_exposure_));
    transfer(host, period.end);
    for (const Step& step : transferred_) deliver(host, step);
    if (!readers_.empty()) read(host, period.end);
  }
  made_until_ = std::min(period.end, last_exposure_);
  hand_out_frames(period.end, period.frames);
  polls_.hand_out(period.end, period.polls);
  events_ += period.polls.size();
  if (!is_over_) return;
  if (!period.frames.empty()) end_ = std::max(end_, period.frames.back().at);
  std::erase_if(period.polls, [this](const CameraPoll& poll) { return poll.end > end_; });
}

TrueTime CameraWorld::begin_part(CameraPeriod& period) {
  period.pulse.reset();
  if (part_ == 0) {
    if (has_begun_) {
      slot_at_ = next_slot_at_;
      period.pulse = begin_slot();
    }
    has_begun_ = true;
    is_over_ = next_slot_ > end_slot_;
  }
  if (is_over_) return TrueTime::max();
  part_ = (part_ + 1) % parts_;
  return part_ == 0 ? next_slot_at_ : slot_at_ + part_ * ((next_slot_at_ - slot_at_) / parts_);
}

void CameraWorld::steer(std::uint32_t camera, const FrameCommand& command, TrueTime at) {
  for (SimStream& stream : cameras_.streams()) {
    if (stream.camera != camera || !stream.sensor) continue;
    stream.sensor->latch(command, at, made_until_);
    HostSide& host = hosts_[stream.host];
    host.next_timer = std::min(host.next_timer, stream.next_timer());
  }
}

void CameraWorld::sort(std::vector<Step>& steps) {
  std::sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) {
    return std::tie(a.at, a.transferred, a.order) < std::tie(b.at, b.transferred, b.order);
  });
}

void CameraWorld::plan_slot(TrueTime earliest) {
  const std::optional<TrueTime> pulse = trigger_.pulse(next_slot_);
  next_slot_has_pulse_ = pulse.has_value();
  next_slot_at_ = std::max(pulse.value_or(trigger_.due(next_slot_)), earliest);
}

// Also a slot without a pulse takes its time.
std::optional<ObservedPulse> CameraWorld::begin_slot() {
  const ObservedPulse pulse{.pulse = next_slot_++, .at = next_slot_at_};
  const bool has_pulse = next_slot_has_pulse_;
  ++events_;
  plan_slot(pulse.at);
  if (!has_pulse) return std::nullopt;
  return pulse;
}

void CameraWorld::expose_by_pulse(const HostSide& host, const ObservedPulse& pulse) {
  for (std::uint32_t id = host.first_stream; id < host.end_stream; ++id) {
    SimStream& stream = cameras_.stream(id);
    if (stream.runs_free() || pulse.pulse % stream.pulses_per_frame != 0) continue;
    const TrueTime at_camera = pulse.at + trigger_.delay_to(stream.camera);
    stream.shutter.set_exposure(cameras_.exposure(stream.camera, at_camera));
    const auto exposure = stream.shutter.on_pulse(at_camera, pulse.pulse);
    if (exposure) expose(id, *exposure, pulse.at);
  }
}

void CameraWorld::expose_by_timers(HostSide& host, TrueTime before) {
  if (host.next_timer >= before) return;
  host.next_timer = TrueTime::max();
  for (std::uint32_t first = host.first_stream; first < host.end_stream; first += kinds_) {
    for (;; ++events_) {
      const std::uint32_t id = next_timer(first);
      SimStream& stream = cameras_.stream(id);
      const TrueTime now = stream.next_timer();
      if (now >= before) {
        host.next_timer = std::min(host.next_timer, now);
        break;
      }
      const auto exposure = stream.on_timer(now, cameras_.exposure(stream.camera, now));
      if (exposure) expose(id, *exposure, now);
    }
  }
}

// The stream with the earliest timer, of the camera whose first stream that is.
std::uint32_t CameraWorld::next_timer(std::uint32_t first) const {
  std::uint32_t next = first;
  for (std::uint32_t id = first + 1; id < first + kinds_; ++id) {
    const TrueTime timer = cameras_.stream(id).next_timer();
    if (timer < cameras_.stream(next).next_timer()) next = id;
  }
  return next;
}

// Soon after its start a camera may expose late.
Exposure CameraWorld::with_unsteady_start(SimStream& stream, const Exposure& planned) const {
  if (planned.start - stream.started >= unstable_start_) return planned;
  const double sigma_ms = scenario_.cameras.unstable_start_jitter_sigma_ms;
  const Nanoseconds late = from_ms(std::abs(stream.unsteadiness.normal(sigma_ms)));
  return {planned.pulse, planned.start + late, planned.end + late};
}

void CameraWorld::expose(std::uint32_t stream_id, const Exposure& planned, TrueTime now) {
  SimStream& stream = cameras_.stream(stream_id);
  const scenarios::Cameras& cameras = scenario_.cameras;
  const FrameDelays::Draw delays = stream.delays.draw(stream.transfer_ns);
  const double stamp_noise_ns = stream.stamp_noise.normal(stream.stamp_noise_sigma_ns);
  const Exposure exposure = with_unsteady_start(stream, planned);
  if (camera_faults_.vanished(stream.camera, exposure.start)) return;

  const std::uint32_t id = frames_.add();
  FrameInFlight& way = frames_[id];
  SimFrame& frame = way.frame = {.stream = stream_id,
                                 .camera = stream.camera,
                                 .host = stream.host,
                                 .counter = stream.counter++,
                                 .kind = stream.kind,
                                 .pulse = exposure.pulse,
                                 .exposure_start = exposure.start,
                                 .exposure_end = exposure.end,
                                 .readout_start = exposure.end - stream.readout};
  if (reference_ && stream.camera == 0) reference_->add(frame.mid_exposure());
  if (cameras.drop_probability > 0 && stream.loss.chance(cameras.drop_probability)) {
    frame.fate = FrameFate::kLostInCamera;
    return add(ended_, now, now, id);
  }
  const Nanoseconds exposed = frame.readout_start - exposure.start;
  frame.exposure_us = static_cast<std::uint32_t>(exposed.count() / 1000);
  frame.stamp_noise_ns = stamp_noise_ns;
  way.kernel_copy_ns = delays.kernel_copy_ns;
  way.delivery_ns = delays.delivery_ns + camera_faults_.take_delay_ns(stream.camera);
  frame.offered = exposure.end + stream.latency;
  add(buses_[stream.controller].offers, frame.offered, {}, id, stream.index_on_controller);
}

// What is transferred to the host before that, in order of time.
void CameraWorld::transfer(const HostSide& host, TrueTime before) {
  transferred_.clear();
  for (std::uint32_t bus = host.first_bus; bus < host.end_bus; ++bus) transfer(buses_[bus], before);
  sort(transferred_);
}

// What happens on this bus before that, in order of time.
void CameraWorld::transfer(Bus& bus, TrueTime before) {
  sort(bus.offers);
  const bool are_single = is_each_stream_once(bus.offers);
  auto next = bus.offers.begin();
  for (;;) {
    if (are_single) next = pass(bus, next, before);
    const TrueTime offered = next != bus.offers.end() ? next->at : TrueTime::max();
    const TrueTime woken(bus.controller.wake_up());
    if (std::min(offered, woken) >= before) break;
    if (offered < woken) {
      offer(bus, *next++);
      continue;
    }
    while (const auto frame = bus.controller.take_completed(woken.time_since_epoch())) {
      add(transferred_, woken, woken, *frame);
    }
  }
  bus.offers.erase(bus.offers.begin(), next);
}

// Up to 64 streams; of more, it may say no.
bool CameraWorld::is_each_stream_once(const std::vector<Step>& offers) {
  constexpr std::uint32_t kMost = 64;
  std::uint64_t seen = 0;
  return std::none_of(offers.begin(), offers.end(), [&seen](const Step& offer) {
    const std::uint64_t stream = std::uint64_t{1} << (offer.place % kMost);
    return (std::exchange(seen, seen | stream) & stream) != 0;
  });
}

// Passes offers from this one on, as long as they meet no others under way; returns the next one.
auto CameraWorld::pass(Bus& bus, std::vector<Step>::iterator next, TrueTime before)
    -> std::vector<Step>::iterator {
  for (; next != bus.offers.end() && next->at < before; ++next) {
    const SimStream& alike = cameras_.stream(bus.first_stream + next->place % kinds_);
    const Nanoseconds at = next->at.time_since_epoch();
    const TrueTime done(bus.controller.pass(
        at, next->place, alike.transfer_ns,
        std::min(before.time_since_epoch() - Nanoseconds(1), alike.latest(at))));
    if (done == TrueTime::max()) break;
    add(transferred_, done, done, next->frame);
  }
  return next;
}

void CameraWorld::offer(Bus& bus, const Step& offer) {
  SimFrame& frame = frames_[offer.frame].frame;
  const SimStream& stream = cameras_.stream(frame.stream);
  const Nanoseconds at = offer.at.time_since_epoch();
  if (bus.controller.submit(at, stream.index_on_controller, stream.bytes, offer.frame,
                            stream.latest(at))) {
    return;
  }
  frame.fate = FrameFate::kLostOnUsb;
  add(ended_, offer.at, offer.at, offer.frame);
}

void CameraWorld::deliver(HostSide& host, const Step& transferred) {
  FrameInFlight& way = frames_[transferred.frame];
  SimFrame& frame = way.frame;
  SimStream& stream = cameras_.stream(frame.stream);
  const TrueTime now = transferred.at;
  const double host_jitter_ns = host.jitter.at(now) * stream.transfer_ns;
  frame.transferred = now;
  frame.copied = now + from_ns(way.kernel_copy_ns);
  const double delivery_ns = way.delivery_ns + host_jitter_ns + stream.late_ns;
  TrueTime arrival = frame.copied + from_ns(std::max(0.0, delivery_ns));
  arrival +=
      host.load.delay(start_ + arrival.time_since_epoch(), kLateFrame, frame.stream, frame.counter);
  stream.last_arrival = std::max(stream.last_arrival, arrival);
  if (readers_.empty()) {
    return add(ended_, stream.last_arrival, now, transferred.frame);
  }
  readers_[frame.stream].arrive(transferred.frame, stream.last_arrival, read_);
  end_read_frames();
}

void CameraWorld::read(const HostSide& host, TrueTime before) {
  for (std::uint32_t id = host.first_stream; id < host.end_stream; ++id) {
    readers_[id].read_before(before, read_);
  }
  end_read_frames();
}

void CameraWorld::end_read_frames() {
  for (const ReaderQueue::Outcome& outcome : read_) {
    SimFrame& frame = frames_[outcome.frame].frame;
    frame.fate = outcome.fate;
    add(ended_, outcome.at, frame.transferred, outcome.frame);
  }
  read_.clear();
}

// Hands out the frames that were delivered or lost before that.
void CameraWorld::hand_out_frames(TrueTime before, std::vector<SimFrame>& frames) {
  sort(ended_);
  const auto end = std::find_if(ended_.begin(), ended_.end(),
                                [before](const Step& ended) { return ended.at >= before; });
  frames.clear();
  frames.reserve(static_cast<std::size_t>(end - ended_.begin()));
  for (auto ended = ended_.begin(); ended != end; ++ended) {
    SimFrame& frame = frames.emplace_back(frames_[ended->frame].frame);
    frame.at = ended->at;
    if (reference_) frame.pulse = reference_->pulse_of(frame.mid_exposure());
    frames_.release(ended->frame);
    const auto at_ns = static_cast<std::uint64_t>(frame.at.time_since_epoch().count());
    trace_hash_ = SplitMix64::mix(trace_hash_ ^ (at_ns + frame.stream));
  }
  ended_.erase(ended_.begin(), end);
}

}  // namespace simbench::sim

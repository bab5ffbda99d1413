#include "sim/rig/camera_world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithms/ports/assert.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kLateFrame("host: late delivery of a frame");

std::size_t bytes_of(const CameraPeriod& period) {
  return sizeof(CameraPeriod) + period.frames.capacity() * sizeof(CameraFrame) +
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
                         const EngineLimits& limits, std::size_t kept_bytes)
    : scenario_(scenario),
      seed_(seed),
      start_(start),
      slots_(evaluated_slots(scenario)),
      engine_(limits, start),
      id_(engine_.attach(*this)),
      trigger_(scenario.trigger, static_cast<std::size_t>(scenario.cameras.count), seed),
      cameras_(scenario, seed),
      camera_faults_(scenario.faults),
      polls_(scenario, seed, engine_, cameras_, camera_faults_),
      kept_bytes_(kept_bytes) {
  trigger_.start(start);
  camera_faults_.start(start);
  cameras_.start(start);
  controllers_ = cameras_.make_controllers();
  const auto hosts = static_cast<std::size_t>(scenario.hosts.count);
  host_sides_.reserve(hosts);
  for (std::size_t host = 0; host < hosts; ++host) {
    host_sides_.push_back({HostJitter(scenario.usb, seed, host, start, trigger_.period_ns()),
                           HostLoad(scenario.hosts.load_burst, seed, static_cast<PeerId>(host))});
  }
  end_ = last_exposure_ = trigger_.due(slots_.last + 2);
  next_slot_at_ = time_of_slot(0);
  for (std::uint32_t id = 0; id < cameras_.streams().size(); ++id) {
    const TrueTime timer = cameras_.stream(id).shutter.next_timer();
    if (timer != TrueTime::max()) engine_.schedule(timer, id_, kShutterTimer, id);
  }
  polls_.start(last_exposure_);
}

const CameraPeriod* CameraWorld::period(std::size_t index) {
  SIMBENCH_ASSERT(index >= dropped_, "a period that is no longer kept");
  const std::size_t place = index - dropped_;
  if (place < periods_.size()) return &periods_[place];
  if (is_over_) return nullptr;
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
  period.pulse.reset();
  if (has_begun_) period.pulse = on_slot();
  has_begun_ = true;
  const bool is_last = next_slot_ > slots_.last;
  if (is_last) {
    engine_.run();
  } else {
    engine_.run_until(next_slot_at_);
  }
  period.end = is_last ? TrueTime::max() : next_slot_at_;
  hand_out_frames(period.end, period.frames);
  polls_.hand_out(period.polls);
  if (!is_last) return;
  is_over_ = true;
  if (!period.frames.empty()) end_ = std::max(end_, period.frames.back().at);
  std::erase_if(period.polls, [this](const CameraPoll& poll) { return poll.end > end_; });
}

// Those that ended their way before that.
void CameraWorld::hand_out_frames(TrueTime before, std::vector<CameraFrame>& frames) {
  std::sort(ended_.begin(), ended_.end(), [](const Ended& a, const Ended& b) {
    return a.at != b.at ? a.at < b.at : a.order < b.order;
  });
  const auto end = std::find_if(ended_.begin(), ended_.end(),
                                [before](const Ended& ended) { return ended.at >= before; });
  frames.clear();
  frames.reserve(static_cast<std::size_t>(end - ended_.begin()));
  for (auto ended = ended_.begin(); ended != end; ++ended) {
    frames.push_back(frames_[ended->frame].frame);
    frames_.release(ended->frame);
    const auto at_ns = static_cast<std::uint64_t>(ended->at.time_since_epoch().count());
    frames_hash_ = SplitMix64::mix(frames_hash_ ^ (at_ns + frames.back().stream));
  }
  ended_.erase(ended_.begin(), end);
}

// The pulse of the next slot; a slot without one still takes its time.
std::optional<CameraPulse> CameraWorld::on_slot() {
  const std::int64_t slot = next_slot_++;
  const TrueTime now = next_slot_at_;
  const bool has_pulse = trigger_.pulse(slot).has_value();
  if (has_pulse) {
    for (const std::uint32_t id : cameras_.triggered_streams()) {
      CameraStream& stream = cameras_.stream(id);
      const TrueTime at_camera = now + trigger_.delay_to(stream.camera);
      stream.shutter.set_exposure(cameras_.exposure(stream.camera, at_camera));
      const auto exposure = stream.shutter.on_pulse(at_camera, slot);
      if (exposure) expose(id, *exposure);
    }
  }
  next_slot_at_ = std::max(time_of_slot(next_slot_), now);
  if (!has_pulse) return std::nullopt;
  return CameraPulse{.slot = slot, .at = now};
}

TrueTime CameraWorld::time_of_slot(std::int64_t slot) const {
  return std::max(trigger_.pulse(slot).value_or(trigger_.due(slot)), start_);
}

void CameraWorld::handle(const Event& event) {
  switch (event.kind) {
    case kShutterTimer:
      return on_shutter_timer(event.subject);
    case kReadout:
      return on_readout(event.subject);
    default:
      return on_transfer_done(event.subject);
  }
}

void CameraWorld::on_shutter_timer(std::uint32_t stream_id) {
  const TrueTime now = engine_.now();
  if (now >= last_exposure_) return;
  CameraStream& stream = cameras_.stream(stream_id);
  stream.shutter.set_exposure(cameras_.exposure(stream.camera, now));
  const auto exposure = stream.shutter.on_timer(now);
  if (exposure) expose(stream_id, *exposure);
  engine_.schedule(stream.shutter.next_timer(), id_, kShutterTimer, stream_id);
}

// Soon after its start a camera may expose late.
Exposure CameraWorld::with_unsteady_start(CameraStream& stream, const Exposure& planned) const {
  const scenarios::Cameras& cameras = scenario_.cameras;
  if (planned.start - stream.started >= from_ms(cameras.unstable_start_ms)) return planned;
  const Nanoseconds late =
      from_ms(std::abs(stream.unsteadiness.normal(cameras.unstable_start_jitter_sigma_ms)));
  return {planned.pulse, planned.start + late, planned.end + late};
}

void CameraWorld::expose(std::uint32_t stream_id, const Exposure& planned) {
  CameraStream& stream = cameras_.stream(stream_id);
  const scenarios::Cameras& cameras = scenario_.cameras;
  const FrameDelays::Draw delays = stream.delays.draw(stream.transfer_ns);
  const double stamp_noise_ns =
      stream.stamp_noise.normal(cameras.sensor_stamp_jitter_sigma_us * 1e3);
  const Exposure exposure = with_unsteady_start(stream, planned);
  if (camera_faults_.vanished(stream.camera, exposure.start)) return;

  const std::uint32_t id = frames_.add();
  FrameInFlight& way = frames_[id];
  CameraFrame& frame = way.frame = {.stream = stream_id,
                                    .counter = stream.counter++,
                                    .pulse = exposure.pulse,
                                    .exposure_start = exposure.start,
                                    .exposure_end = exposure.end};
  if (cameras.drop_probability > 0 && stream.loss.chance(cameras.drop_probability)) {
    frame.fate = FrameFate::kLostInCamera;
    return end_way(id, engine_.now());
  }
  const Nanoseconds exposed = exposure.end - stream.readout - exposure.start;
  DeviceClock& clock = cameras_.clock(stream.camera);
  frame.exposure_us = static_cast<std::uint32_t>(exposed.count() / 1000);
  frame.sensor = clock.stamp(frame.mid_exposure(), stamp_noise_ns);
  // Readout begins with the first row.
  frame.frame = clock.stamp(exposure.end - stream.readout, stamp_noise_ns);
  way.kernel_copy_ns = delays.kernel_copy_ns;
  way.delivery_ns = delays.delivery_ns + camera_faults_.take_delay_ns(stream.camera);
  engine_.schedule(exposure.end + stream.latency, id_, kReadout, id);
}

void CameraWorld::on_readout(std::uint32_t frame_id) {
  CameraFrame& frame = frames_[frame_id].frame;
  const CameraStream& stream = cameras_.stream(frame.stream);
  frame.offered = engine_.now();
  UsbController& bus = controllers_[stream.controller];
  if (bus.submit(engine_.now(), stream.index_on_controller, stream.bytes, frame_id)) {
    wake_controller(stream.controller);
  } else {
    frame.fate = FrameFate::kLostOnUsb;
    end_way(frame_id, engine_.now());
  }
}

void CameraWorld::on_transfer_done(std::uint32_t controller_id) {
  UsbController& bus = controllers_[controller_id];
  if (!bus.is_woken(engine_.now())) return;
  while (const auto frame_id = bus.take_completed(engine_.now())) deliver(*frame_id);
  wake_controller(controller_id);
}

void CameraWorld::wake_controller(std::uint32_t controller_id) {
  const auto at = controllers_[controller_id].take_wake_up();
  if (at) engine_.schedule(*at, id_, kTransferDone, controller_id);
}

void CameraWorld::deliver(std::uint32_t frame_id) {
  FrameInFlight& way = frames_[frame_id];
  CameraFrame& frame = way.frame;
  CameraStream& stream = cameras_.stream(frame.stream);
  HostSide& host = host_sides_[stream.host];
  const TrueTime now = engine_.now();
  const double host_jitter_ns = host.jitter.at(now) * stream.transfer_ns;
  frame.transferred = now;
  frame.copied = now + from_ns(way.kernel_copy_ns);
  const double delivery_ns = way.delivery_ns + host_jitter_ns + stream.late_ns;
  TrueTime arrival = frame.copied + from_ns(std::max(0.0, delivery_ns));
  arrival += host.load.delay(arrival, kLateFrame, frame.stream, frame.counter);
  stream.last_arrival = std::max(stream.last_arrival, arrival);
  end_way(frame_id, stream.last_arrival);
}

void CameraWorld::end_way(std::uint32_t frame_id, TrueTime at) {
  frames_[frame_id].frame.at = at;
  ended_.push_back({.at = at, .order = frames_made_++, .frame = frame_id});
}

}  // namespace simbench::sim

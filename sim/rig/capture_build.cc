// How a capture is put together from its scenario; what it then does is in capture.cc.
#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithms/ports/assert.h"
#include "scenarios/rates.h"
#include "sim/rig/capture.h"

namespace simbench::sim {
namespace {

Nanoseconds from_us(double us) { return Nanoseconds(std::llround(us * 1e3)); }

UsbSharing sharing_of(const scenarios::Usb& usb) {
  if (usb.sharing == "fifo") return UsbSharing::kFifo;
  if (usb.sharing == "fair") return UsbSharing::kFair;
  return UsbSharing::kDedicated;
}

// 1 MB/s is 1e6 bytes in 1e9 ns.
double bytes_per_ns(const scenarios::Usb& usb) { return usb.bandwidth_mb_per_s * 1e-3; }

double trigger_period_ms(const scenarios::Trigger& trigger) { return 1e3 / trigger.rate_hz; }

}  // namespace

Capture::Capture(const scenarios::Scenario& scenario, std::uint64_t seed, Engine& engine,
                 std::vector<SystemClock*> clocks, RecordingSink& sink)
    : scenario_(scenario),
      seed_(seed),
      engine_(engine),
      id_(engine.attach(*this)),
      clocks_(std::move(clocks)),
      sink_(sink),
      trigger_(scenario.trigger, static_cast<std::size_t>(scenario.cameras.count), seed),
      outages_(scenario.faults),
      late_frame_seen_(scenario.faults.size(), false),
      host_errors_(clocks_.size()),
      arrival_quantum_(from_ms(scenario.hosts.clock.arrival_quantum_ms)) {
  first_slot_ = trigger_.first_slot_from(TrueTime(from_ms(scenario.timeline.warm_up_ms)));
  last_slot_ = first_slot_ + scenario.timeline.frames - 1;
}

void Capture::start(TrueTime at, std::function<void()> on_end) {
  if (observer_ != nullptr) observer_->on_capture_start(at);
  start_ = at;
  on_end_ = std::move(on_end);
  trigger_.start(at);
  outages_.start(at);
  end_ = trigger_.due(last_slot_ + 2);
  build_clocks(at);
  build_streams(at);

  schedule_pulse(0);
  for (std::uint32_t id = 0; id < streams_.size(); ++id) {
    const TrueTime timer = streams_[id].shutter.next_timer();
    if (timer != TrueTime::max()) engine_.schedule(timer, id_, kShutterTimer, id);
  }
  for (std::uint32_t i = 0; i < scenario_.faults.size(); ++i) {
    engine_.schedule(at + from_ms(scenario_.faults[i].at_ms), id_, kFault, i);
  }
  engine_.schedule(end_, id_, kEnd, 0);
}

void Capture::build_clocks(TrueTime at) {
  const scenarios::Cameras& cameras = scenario_.cameras;
  device_clocks_.reserve(static_cast<std::size_t>(cameras.count));
  for (std::size_t camera = 0; camera < static_cast<std::size_t>(cameras.count); ++camera) {
    RandomStream epoch(seed_, "camera/epoch", camera);
    const TrueTime started = camera_start(camera, at);
    OscillatorModel oscillator(cameras.oscillator, seed_,
                               "camera/oscillator/" + std::to_string(camera), started);
    if (!cameras.skew_of_camera_ppm.empty()) {
      oscillator.set_skew(cameras.skew_of_camera_ppm[camera] * 1e-6);
    }
    device_clocks_.emplace_back(std::move(oscillator), epoch.uniform(0, cameras.clock_epoch_max_ms),
                                at);
    exposures_.emplace_back(cameras.auto_exposure, exposure_of(camera), seed_, camera, started);
  }
  for (std::size_t host = 0; host < clocks_.size(); ++host) {
    host_jitter_.emplace_back(scenario_.usb, seed_, host, at, trigger_.period_ns());
    host_loads_.emplace_back(scenario_.hosts.load_burst, seed_, static_cast<PeerId>(host));
  }
}

void Capture::build_streams(TrueTime at) {
  const scenarios::Usb& usb = scenario_.usb;
  const auto per_controller = static_cast<std::uint32_t>(usb.cameras_per_controller);
  const std::size_t kinds = scenario_.cameras.streams.size();
  std::vector<std::uint32_t> cameras_on_host(clocks_.size(), 0);
  std::vector<std::uint32_t> controller_of_host(clocks_.size(), 0);
  for (std::size_t camera = 0; camera < device_clocks_.size(); ++camera) {
    const auto host =
        static_cast<std::size_t>(scenario_.host_of(static_cast<std::int64_t>(camera)));
    SIMBENCH_ASSERT(host < clocks_.size(), "a camera is on a host that does not exist");
    const std::uint32_t place = cameras_on_host[host]++ % per_controller;
    if (place == 0) {
      controller_of_host[host] = static_cast<std::uint32_t>(controllers_.size());
      controllers_.push_back(
          {UsbController({.sharing = sharing_of(usb),
                          .bytes_per_ns = bytes_per_ns(usb),
                          .buffered_frames = static_cast<std::uint32_t>(usb.buffered_frames),
                          .streams_per_camera = static_cast<std::uint32_t>(kinds)},
                         per_controller * kinds)});
    }
    for (std::size_t which = 0; which < kinds; ++which) {
      Stream stream = make_stream(camera, which, at);
      stream.host = static_cast<std::uint32_t>(host);
      stream.controller = controller_of_host[host];
      stream.index_on_controller = static_cast<std::uint32_t>(place * kinds + which);
      if (shutter_mode(scenario_.cameras.streams[which]) != ShutterMode::kFreeRunning) {
        triggered_streams_.push_back(static_cast<std::uint32_t>(streams_.size()));
      }
      streams_.push_back(std::move(stream));
    }
  }
}

Capture::Stream Capture::make_stream(std::size_t camera, std::size_t which, TrueTime at) {
  const scenarios::Stream& profile = scenario_.cameras.streams[which];
  const StreamKind kind = profile.kind == "colour" ? StreamKind::kColour : StreamKind::kDepth;
  const double bytes =
      static_cast<double>(profile.width * profile.height) * profile.bytes_per_pixel;
  const double mode_period_ns =
      1e9 / profile.mode_rate_hz * device_clocks_[camera].true_per_device();
  const Nanoseconds readout = from_ms(profile.shutter == "rolling" ? profile.readout_ms : 0);
  RandomStream latency(seed_, "camera/latency", camera);
  const ShutterSettings shutter{
      .mode = shutter_mode(profile),
      .mode_period_ns = mode_period_ns,
      .exposure = exposure_of(camera),
      .readout = readout,
      .trigger_to_exposure = from_us(scenario_.cameras.trigger_to_exposure_us),
      .guard_fraction = scenario_.cameras.genlock_guard_fraction,
      .free_run_after_periods = scenario_.cameras.slave_free_run_after_periods};
  TrueTime start = camera_start(camera, at);
  if (shutter.mode == ShutterMode::kFreeRunning) {
    // Nothing aligns the frames of a free-running stream: they begin anywhere in a period.
    RandomStream phase(seed_, "camera/free_running_phase", camera, which);
    start += Nanoseconds(static_cast<std::int64_t>(phase.uniform(0, mode_period_ns)));
  }
  const std::uint64_t id = camera * scenario_.cameras.streams.size() + which;
  return Stream{
      .camera = static_cast<std::uint32_t>(camera),
      .host = 0,
      .controller = 0,
      .index_on_controller = 0,
      .kind = kind,
      .bytes = bytes,
      .transfer_ns = bytes / bytes_per_ns(scenario_.usb),
      .latency = from_ms(profile.pipeline_latency_ms +
                         profile.latency_mode_periods * 1e3 / profile.mode_rate_hz +
                         latency.uniform(0, scenario_.cameras.latency_camera_max_ms)),
      .readout = readout,
      .started = start,
      .shutter = Shutter(shutter, start),
      .delays = FrameDelays(scenario_.usb, seed_, id),
      .stamp_noise = RandomStream(seed_, "camera/stamp_noise", id),
      .loss = RandomStream(seed_, "camera/loss", id),
      .unsteadiness = RandomStream(seed_, "camera/unsteadiness", id),
      .last_arrival = TrueTime::min(),
  };
}

Nanoseconds Capture::exposure_of(std::size_t camera) const {
  const scenarios::Cameras& cameras = scenario_.cameras;
  const auto host =
      static_cast<std::uint64_t>(scenario_.host_of(static_cast<std::int64_t>(camera)));
  RandomStream of_camera(seed_, "camera/exposure", camera);
  RandomStream of_host(seed_, "host/exposure", host);
  const double periods = cameras.exposure_camera_periods * of_camera.uniform() +
                         cameras.exposure_host_periods * of_host.uniform();
  return from_ms(cameras.exposure_ms + periods * trigger_period_ms(scenario_.trigger));
}

ShutterMode Capture::shutter_mode(const scenarios::Stream& stream) const {
  if (!scenarios::follows_trigger(scenario_.cameras, stream)) return ShutterMode::kFreeRunning;
  return scenario_.cameras.sync_mode == "genlock" ? ShutterMode::kGenlock : ShutterMode::kSlave;
}

TrueTime Capture::camera_start(std::size_t camera, TrueTime at) const {
  if (scenario_.cameras.common_start) return at;
  RandomStream spread(seed_, "camera/start", camera);
  return at + from_ms(spread.uniform(0, scenario_.cameras.start_spread_ms));
}

RigLayout Capture::layout() const {
  RigLayout layout{.hosts = static_cast<std::uint32_t>(clocks_.size()),
                   .cameras = {},
                   .frame_rate_hz = scenario_.trigger.rate_hz,
                   .first_pulse = first_slot_,
                   .pulses = scenario_.timeline.frames};
  for (std::int64_t camera = 0; camera < scenario_.cameras.count; ++camera) {
    layout.cameras.push_back({static_cast<std::uint32_t>(scenario_.host_of(camera))});
  }
  return layout;
}

}  // namespace simbench::sim

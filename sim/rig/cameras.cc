#include "sim/rig/cameras.h"

#include <algorithm>
#include <string>
#include <utility>

#include "algorithms/ports/assert.h"
#include "scenarios/camera_groups.h"
#include "scenarios/frame_limits.h"
#include "sim/host/host_group.h"

namespace simbench::sim {
namespace {

// 1 MB/s is 1e6 bytes in 1e9 ns.
double bytes_per_ns(const scenarios::Usb& usb) { return usb.bandwidth_mb_per_s * 1e-3; }

// How long a camera can hold a frame that its controller does not take.
Nanoseconds hold_time(const scenarios::Usb& usb, const scenarios::Stream& stream) {
  if (usb.hold_mode_periods == 0) return Nanoseconds::max();
  return from_ms(usb.hold_mode_periods * 1e3 / stream.mode_rate_hz);
}

ShutterMode shutter_mode(const scenarios::Cameras& cameras, const scenarios::Stream& stream) {
  if (!cameras.follows_trigger(stream)) return ShutterMode::kFreeRunning;
  if (cameras.sync_mode == scenarios::SyncMode::kGenlock) return ShutterMode::kGenlock;
  return cameras.begins_at_pulse() ? ShutterMode::kTriggered : ShutterMode::kSlave;
}

}  // namespace

CameraKinds::CameraKinds(const scenarios::Cameras& cameras)
    : group_of_camera_(scenarios::group_of_cameras(cameras)) {
  for (std::size_t group = 0; group < scenarios::group_count(cameras); ++group) {
    groups_.push_back({.cameras = scenarios::cameras_of_group(cameras, group),
                       .pulses_per_frame = scenarios::pulses_per_frame(cameras, group)});
  }
}

Nanoseconds start_delay(const scenarios::Scenario& scenario, std::uint64_t seed,
                        std::size_t camera) {
  if (scenario.cameras.common_start) return Nanoseconds(0);
  RandomStream spread(seed, "camera/start", camera);
  return from_ms(spread.uniform(0, scenario.cameras.start_spread_ms));
}

namespace {

// Its oscillator in a capture that starts at `start`; `cameras` is of its group.
OscillatorModel camera_oscillator(const scenarios::Scenario& scenario,
                                  const scenarios::Cameras& cameras, std::uint64_t seed,
                                  std::size_t camera, TrueTime start) {
  OscillatorModel oscillator(cameras.oscillator, seed,
                             "camera/oscillator/" + std::to_string(camera),
                             start + start_delay(scenario, seed, camera));
  if (!cameras.skew_of_camera_ppm.empty()) {
    oscillator.set_skew(cameras.skew_of_camera_ppm[camera] * 1e-6);
  }
  return oscillator;
}

}  // namespace

std::vector<DeviceClock> device_clocks(const scenarios::Scenario& scenario, std::uint64_t seed,
                                       TrueTime start) {
  const CameraKinds kinds(scenario.cameras);
  const auto count = static_cast<std::size_t>(scenario.cameras.count);
  std::vector<DeviceClock> clocks;
  clocks.reserve(count);
  for (std::size_t camera = 0; camera < count; ++camera) {
    RandomStream epoch(seed, "camera/epoch", camera);
    clocks.emplace_back(camera_oscillator(scenario, kinds.of(camera), seed, camera, start),
                        epoch.uniform(0, scenario.cameras.clock_epoch_max_ms), start);
  }
  return clocks;
}

bool has_steered_sensors(const scenarios::Scenario& scenario, Steering steering) {
  const scenarios::Cameras& cameras = scenario.cameras;
  if (!cameras.frame_control) return false;
  return steering != Steering::kNone || !cameras.follows_trigger(cameras.streams.front());
}

SimCameras::SimCameras(const scenarios::Scenario& scenario, std::uint64_t seed, TrueTime start,
                       Steering steering)
    : scenario_(scenario), kinds_(scenario.cameras), seed_(seed) {
  const auto count = static_cast<std::size_t>(scenario_.cameras.count);
  const std::size_t kinds = scenario_.cameras.streams.size();
  const auto per_controller = static_cast<std::uint32_t>(scenario_.usb.cameras_per_controller);
  const auto hosts = static_cast<std::size_t>(scenario_.hosts.count);
  const std::vector<DeviceClock> clocks = device_clocks(scenario, seed, TrueTime{});
  std::vector<std::uint32_t> cameras_on_host(hosts, 0);
  std::vector<std::uint32_t> controller_of_host(hosts, 0);
  streams_.reserve(count * kinds);
  for (std::size_t camera = 0; camera < count; ++camera) {
    const auto host =
        static_cast<std::size_t>(scenario_.host_of(static_cast<std::int64_t>(camera)));
    SIMBENCH_ASSERT(host < hosts, "a camera is on a host that does not exist");
    const std::uint32_t place = cameras_on_host[host]++ % per_controller;
    if (place == 0) controller_of_host[host] = controllers_++;
    exposures_.emplace_back(scenario_.cameras.auto_exposure, first_exposure(camera), seed, camera,
                            TrueTime{} + start_delay(scenario, seed, camera));
    for (std::size_t which = 0; which < kinds; ++which) {
      SimStream stream = make_stream(clocks[camera], camera, which);
      stream.host = static_cast<std::uint32_t>(host);
      stream.controller = controller_of_host[host];
      stream.index_on_controller = static_cast<std::uint32_t>(place * kinds + which);
      streams_.push_back(std::move(stream));
    }
  }
  if (has_steered_sensors(scenario, steering)) add_sensors(start, steering);
}

// Nothing aligns their frames at the start.
void SimCameras::add_sensors(TrueTime start, Steering steering) {
  const scenarios::FrameControlModel& model = *scenario_.cameras.frame_control;
  const double period_ns = 1e9 / scenario_.trigger.pulse_rate_hz();
  SteeredSensorSettings settings{
      .limits = scenarios::frame_limits(scenario_),
      .readout = streams_.front().readout,
      .jitter_sigma_ns = model.frame_jitter_sigma_us * 1e3,
      .insert_stretches = model.insert_stretches,
      .insert_noise_sigma_ns = model.insert_noise_sigma_us * 1e3,
      .is_ideal = steering == Steering::kIdeal,
      .first_due = TrueTime{} + from_ms(scenario_.trigger.start_delay_ms),
      .period_ns = period_ns};
  for (SimStream& stream : streams_) {
    settings.limits.exposure = first_exposure(stream.camera);
    RandomStream phase(seed_, "camera/free_running_phase", stream.camera);
    stream.started = TrueTime{} + start_delay(scenario_, seed_, stream.camera) +
                     from_ns(phase.uniform(0, period_ns));
    stream.sensor = std::make_unique<SteeredSensor>(
        settings,
        model.sensor_clock == scenarios::ClockOwner::kHost
            ? host_oscillator(scenario_.hosts, seed_, stream.host)
            : camera_oscillator(scenario_, scenario_.cameras, seed_, stream.camera, start),
        RandomStream(seed_, "camera/sensor", stream.camera), stream.started, start);
  }
}

SimStream SimCameras::make_stream(const DeviceClock& clock, std::size_t camera,
                                  std::size_t which) const {
  const scenarios::Cameras& cameras = kinds_.of(camera);
  const scenarios::Stream& profile = cameras.streams[which];
  const ShutterSettings shutter = shutter_settings(clock, camera, profile);
  const scenarios::CalibrationError& error = scenario_.cameras.calibration;
  const double bytes = profile.image_bytes();
  RandomStream latency(seed_, "camera/latency", camera);
  RandomStream of_model(seed_, "calibration/delay");
  RandomStream of_camera(seed_, "calibration/camera_delay", camera);
  TrueTime started = TrueTime{} + start_delay(scenario_, seed_, camera);
  if (shutter.mode == ShutterMode::kFreeRunning) {
    // Nothing aligns the frames of a free-running stream: they begin anywhere in a period.
    RandomStream phase(seed_, "camera/free_running_phase", camera, which);
    started += Nanoseconds(static_cast<std::int64_t>(phase.uniform(0, shutter.mode_period_ns)));
  }
  const std::uint64_t id = camera * scenario_.cameras.streams.size() + which;
  return {.camera = static_cast<std::uint32_t>(camera),
          .host = 0,
          .controller = 0,
          .index_on_controller = 0,
          .kind = profile.kind,
          .pulses_per_frame = kinds_.pulses_per_frame(camera),
          .bytes = bytes,
          .transfer_ns = bytes / bytes_per_ns(scenario_.usb),
          .latency = from_ms(
              std::max(0.0, profile.pipeline_latency_ms +
                                profile.latency_mode_periods * 1e3 / profile.mode_rate_hz +
                                latency.uniform(0, scenario_.cameras.latency_camera_max_ms) +
                                of_model.normal(error.delay_error_sigma_ms))),
          .hold = hold_time(scenario_.usb, profile),
          .readout = shutter.readout,
          .late_ns = of_camera.normal(error.camera_delay_error_sigma_ms) * 1e6,
          .started = started,
          .shutter = Shutter(shutter, started),
          .sensor = nullptr,
          .delays = FrameDelays(scenario_.usb, seed_, id),
          .stamp_noise_sigma_ns = cameras.sensor_stamp_jitter_sigma_us * 1e3,
          .stamp_noise = RandomStream(seed_, "camera/stamp_noise", id),
          .loss = RandomStream(seed_, "camera/loss", id),
          .unsteadiness = RandomStream(seed_, "camera/unsteadiness", id)};
}

ShutterSettings SimCameras::shutter_settings(const DeviceClock& clock, std::size_t camera,
                                             const scenarios::Stream& profile) const {
  const scenarios::Cameras& cameras = kinds_.of(camera);
  return {.mode = shutter_mode(cameras, profile),
          .mode_period_ns = 1e9 / profile.mode_rate_hz * clock.true_per_device(),
          .exposure = first_exposure(camera),
          .readout =
              from_ms(profile.shutter == scenarios::ShutterKind::kRolling ? profile.readout_ms : 0),
          .trigger_to_exposure = from_us(cameras.trigger_to_exposure_us),
          .guard_fraction = cameras.genlock_guard_fraction,
          .free_run_after_periods = cameras.slave_free_run_after_periods};
}

Nanoseconds SimCameras::first_exposure(std::size_t camera) const {
  const scenarios::Cameras& cameras = kinds_.of(camera);
  const auto host =
      static_cast<std::uint64_t>(scenario_.host_of(static_cast<std::int64_t>(camera)));
  RandomStream of_camera(seed_, "camera/exposure", camera);
  RandomStream of_host(seed_, "host/exposure", host);
  const double periods = cameras.exposure_camera_periods * of_camera.uniform() +
                         cameras.exposure_host_periods * of_host.uniform();
  return from_ms(cameras.exposure_ms + periods * scenario_.trigger.period_ms());
}

std::vector<UsbController> SimCameras::make_controllers() const {
  const scenarios::Usb& usb = scenario_.usb;
  const std::size_t kinds = scenario_.cameras.streams.size();
  const std::size_t streams = static_cast<std::size_t>(usb.cameras_per_controller) * kinds;
  const bool is_dedicated = usb.sharing == scenarios::UsbSharing::kDedicated;
  const UsbSettings settings{
      .bytes_per_ns = bytes_per_ns(usb),
      .buffered_frames = static_cast<std::uint32_t>(usb.buffered_frames),
      .streams_per_lane = static_cast<std::uint32_t>(is_dedicated ? kinds : streams),
      .is_fair = usb.sharing == scenarios::UsbSharing::kFair};
  return std::vector<UsbController>(controllers_, UsbController(settings, streams));
}

}  // namespace simbench::sim

#include "scenarios/rates.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "scenarios/camera_profile.h"
#include "scenarios/document.h"
#include "scenarios/loader.h"

namespace simbench::scenarios {
namespace {

constexpr double kRateTolerance = 0.01;
constexpr double kRounding = 1e-9;

void check_profile(const Scenario& scenario, const CameraProfile& camera,
                   const std::string& pointer, const Stream& stream) {
  const StreamProfile* profile = camera.stream(stream.kind);
  if (profile == nullptr) {
    std::vector<std::string> kinds;
    for (const StreamProfile& each : camera.streams) kinds.push_back(each.kind);
    fail_at(scenario, pointer + "/kind",
            fmt::format("found {}, allowed {} (streams of the {})", stream.kind,
                        fmt::join(kinds, ", "), camera.name));
  }
  const ImageSize* offered = profile->find_size(stream.width, stream.height);
  if (offered == nullptr) {
    std::vector<std::string> sizes;
    for (const ImageSize& size : profile->sizes) {
      sizes.push_back(fmt::format("{}x{}", size.width, size.height));
    }
    fail_at(scenario, pointer + "/width",
            fmt::format("found {} {}x{}, allowed {} (profiles of the {})", stream.kind,
                        stream.width, stream.height, fmt::join(sizes, ", "), camera.name));
  }
  const std::vector<double>& rates = offered->rates_hz;
  if (std::find(rates.begin(), rates.end(), stream.mode_rate_hz) == rates.end()) {
    fail_at(
        scenario, pointer + "/mode_rate_hz",
        fmt::format("found {}, allowed {} (profiles of the {} for {} {}x{})", stream.mode_rate_hz,
                    fmt::join(rates, ", "), camera.name, stream.kind, stream.width, stream.height));
  }
}

void check_sync_mode(const Scenario& scenario, const CameraProfile& camera) {
  const std::string& mode = scenario.cameras.sync_mode;
  if (camera.sync_mode(mode) != nullptr) return;
  std::vector<std::string> modes;
  for (const SyncMode& each : camera.sync_modes) modes.push_back(each.mode);
  fail_at(scenario, "/cameras/sync_mode",
          fmt::format("found \"{}\", allowed \"{}\" (sync modes of the {})", mode,
                      fmt::join(modes, "\", \""), camera.name));
}

const CameraProfile& checked_profile(const Scenario& scenario) {
  const std::string& model = scenario.cameras.model;
  if (const CameraProfile* camera = find_camera_profile(model)) return *camera;
  std::vector<std::string> models;
  for (const CameraProfile& each : camera_profiles()) models.push_back(each.model);
  fail_at(scenario, "/cameras/model",
          fmt::format("found \"{}\", allowed {} (simbench list cameras)", shown_text(model),
                      fmt::join(models, ", ")));
}

void check_genlock(const Scenario& scenario, const Stream& stream) {
  const double guard = scenario.cameras.genlock_guard_fraction;
  const double fastest = stream.mode_rate_hz / 2 / (1 - guard);
  const double rate = pulse_rate_hz(scenario.trigger);
  if (rate <= fastest * (1 + kRounding)) return;
  fail_at(scenario, "/trigger/rate_hz",
          fmt::format("found {:.6g} Hz, allowed at most {:.6g} Hz: genlock in a {} Hz mode ignores "
                      "pulses for two mode periods less the guard of {}",
                      rate, fastest, stream.mode_rate_hz, guard));
}

// Slaves follow pulses close to their mode rate. An evaluated stream that runs free keeps its mode
// rate, which must then be the rate that is evaluated.
void check_full_rate(const Scenario& scenario, const CameraProfile& camera,
                     const std::string& pointer, const Stream& stream) {
  const std::vector<double>& rates = camera.sync_rates_hz;
  const std::string& mode = scenario.cameras.sync_mode;
  if (mode != "default" && !rates.empty() &&
      std::find(rates.begin(), rates.end(), stream.mode_rate_hz) == rates.end()) {
    fail_at(scenario, pointer + "/mode_rate_hz",
            fmt::format("found {}, allowed {} in sync mode \"{}\"", stream.mode_rate_hz,
                        fmt::join(rates, ", "), mode));
  }
  if (!follows_trigger(scenario.cameras, stream) && stream.kind != scenario.evaluation.stream) {
    return;
  }
  const double rate = pulse_rate_hz(scenario.trigger);
  if (std::abs(rate / stream.mode_rate_hz - 1) <= kRateTolerance + kRounding) return;
  fail_at(scenario, "/trigger/rate_hz",
          fmt::format("found {:.6g} Hz, allowed {:.6g} to {:.6g} Hz in sync mode \"{}\" with a {} "
                      "Hz mode",
                      rate, stream.mode_rate_hz * (1 - kRateTolerance),
                      stream.mode_rate_hz * (1 + kRateTolerance), mode, stream.mode_rate_hz));
}

}  // namespace

bool follows_trigger(const Cameras& cameras, const Stream& stream) {
  const CameraProfile* camera = find_camera_profile(cameras.model);
  if (camera == nullptr) {
    throw std::invalid_argument("no profile of camera model \"" + cameras.model + "\"");
  }
  return camera->triggers(cameras.sync_mode, stream.kind);
}

double pulse_rate_hz(const Trigger& trigger) {
  return trigger.rate_hz * (1 + trigger.rate_error_ppm * 1e-6);
}

double frame_rate_hz(const Scenario& scenario, const Stream& stream) {
  return follows_trigger(scenario.cameras, stream) ? pulse_rate_hz(scenario.trigger)
                                                   : stream.mode_rate_hz;
}

void check_rates(const Scenario& scenario) {
  const Cameras& cameras = scenario.cameras;
  const CameraProfile& camera = checked_profile(scenario);
  check_sync_mode(scenario, camera);
  for (std::size_t i = 0; i < cameras.streams.size(); ++i) {
    const Stream& stream = cameras.streams[i];
    const std::string pointer = fmt::format("/cameras/streams/{}", i);
    check_profile(scenario, camera, pointer, stream);
    if (cameras.sync_mode != "genlock") {
      check_full_rate(scenario, camera, pointer, stream);
    } else if (follows_trigger(cameras, stream)) {
      check_genlock(scenario, stream);
    }
  }
}

}  // namespace simbench::scenarios

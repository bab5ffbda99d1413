#include "scenarios/rates.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "scenarios/d455_profiles.h"
#include "scenarios/loader.h"

namespace simbench::scenarios {
namespace {

constexpr double kRateTolerance = 0.01;
constexpr double kRounding = 1e-9;

void check_profile(const Scenario& scenario, const std::string& pointer, const Stream& stream) {
  const std::vector<double> rates = offered_rates_hz(stream.kind, stream.width, stream.height);
  if (rates.empty()) {
    fail_at(scenario, pointer + "/width",
            fmt::format("found {} {}x{}, allowed {} (profiles of a D455)", stream.kind,
                        stream.width, stream.height, fmt::join(offered_sizes(stream.kind), ", ")));
  }
  if (std::find(rates.begin(), rates.end(), stream.mode_rate_hz) == rates.end()) {
    fail_at(
        scenario, pointer + "/mode_rate_hz",
        fmt::format("found {}, allowed {} (profiles of a D455 for {} {}x{})", stream.mode_rate_hz,
                    fmt::join(rates, ", "), stream.kind, stream.width, stream.height));
  }
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
void check_full_rate(const Scenario& scenario, const std::string& pointer, const Stream& stream) {
  constexpr std::array kSyncRates = {6.0, 15.0, 30.0, 60.0, 90.0};
  const std::string& mode = scenario.cameras.sync_mode;
  if (mode != "default" &&
      std::find(kSyncRates.begin(), kSyncRates.end(), stream.mode_rate_hz) == kSyncRates.end()) {
    fail_at(scenario, pointer + "/mode_rate_hz",
            fmt::format("found {}, allowed {} in sync mode \"{}\"", stream.mode_rate_hz,
                        fmt::join(kSyncRates, ", "), mode));
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
  if (cameras.sync_mode == "full_slave") return true;
  return stream.kind == "depth" && (cameras.sync_mode == "slave" || cameras.sync_mode == "genlock");
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
  for (std::size_t i = 0; i < cameras.streams.size(); ++i) {
    const Stream& stream = cameras.streams[i];
    const std::string pointer = fmt::format("/cameras/streams/{}", i);
    check_profile(scenario, pointer, stream);
    if (cameras.sync_mode != "genlock") {
      check_full_rate(scenario, pointer, stream);
    } else if (follows_trigger(cameras, stream)) {
      check_genlock(scenario, stream);
    }
  }
}

}  // namespace simbench::scenarios

#include "reconstruction/desync_pattern.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "sim/engine/random.h"

namespace simbench::reconstruction {
namespace {

// The place of each host in [0, 1], with both ends taken; of a single host 1/2.
std::vector<double> host_places(std::int64_t hosts, std::uint64_t seed) {
  std::vector<double> places;
  for (std::int64_t host = 0; host < hosts; ++host) {
    places.push_back(
        sim::RandomStream(seed, "desync of host", static_cast<std::uint64_t>(host)).uniform());
  }
  const auto [low, high] = std::minmax_element(places.begin(), places.end());
  const double first = *low;
  const double range = *high - first;
  for (double& place : places) place = range > 0 ? (place - first) / range : 0.5;
  return places;
}

}  // namespace

evaluation::ExposureSet desynchronised_set(const scenarios::Scenario& scenario, std::uint64_t seed,
                                           double desync_ms, double at_s, std::uint32_t index) {
  const std::vector<double> places = host_places(scenario.hosts.count, seed);
  evaluation::ExposureSet set;
  for (std::int64_t camera = 0; camera < scenario.cameras.count; ++camera) {
    const auto host = static_cast<std::size_t>(scenario.host_of(camera));
    constexpr double kSecondsPerMs = 1e-3;
    const double after = (places[host] - 0.5) * desync_ms * kSecondsPerMs;
    const evaluation::SetExposure exposure{.mid_exposure_s = at_s + after, .counter = index};
    set.cameras.emplace_back(exposure);
  }
  return set;
}

}  // namespace simbench::reconstruction

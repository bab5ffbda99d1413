#include "algorithms/host_sync/two_way/registration_two_way.h"

#include <memory>
#include <string>
#include <utility>

#include "algorithms/host_sync/steering_parameters.h"
#include "algorithms/host_sync/two_way/two_way.h"
#include "algorithms/host_sync/two_way/two_way_hull.h"
#include "algorithms/host_sync/two_way/two_way_minimum.h"
#include "algorithms/host_sync/two_way/two_way_parameters.h"
#include "algorithms/parameter_specs.h"

namespace simbench {
namespace {

enum class Estimator { kRoundTrip, kIndependentMinima, kHull };

const char* const kAssumption = "assumption";
const char* const kSoftwareSync =
    "google-research/libsoftwaresync, SyncConstants.java and SimpleNetworkTimeProtocol.java";

TwoWay::MakeEstimator hull_of(const Parameters& parameters) {
  const TwoWayHull::Settings settings = two_way_hull_settings(parameters);
  return [settings] { return std::make_unique<TwoWayHull>(settings); };
}

TwoWay::MakeEstimator minimum_of(const Parameters& parameters, TwoWayMinimum::Kind kind) {
  TwoWayMinimum::Settings settings;
  settings.kind = kind;
  settings.exchanges = static_cast<std::size_t>(parameters.number("exchanges"));
  settings.window = from_ms(parameters.number("window_s") * 1e3);
  settings.max_rate_ppm = parameters.number("max_rate_ppm");
  return [settings] { return std::make_unique<TwoWayMinimum>(settings); };
}

HostSyncEntry two_way(std::string name, std::string summary, std::string source,
                      Estimator estimator, bool is_naive) {
  HostSyncEntry entry;
  entry.info.name = std::move(name);
  entry.info.family = "two_way";
  entry.info.summary = std::move(summary);
  entry.info.source = std::move(source);
  entry.info.parameters = two_way_parameters();
  entry.make = [estimator, is_naive](const Parameters& parameters) {
    TwoWaySettings settings = two_way_settings(parameters);
    settings.is_naive = is_naive;
    if (estimator == Estimator::kHull) {
      return std::make_unique<TwoWay>(settings, hull_of(parameters));
    }
    const auto kind = estimator == Estimator::kRoundTrip ? TwoWayMinimum::Kind::kRoundTrip
                                                         : TwoWayMinimum::Kind::kIndependent;
    return std::make_unique<TwoWay>(settings, minimum_of(parameters, kind));
  };
  return entry;
}

HostSyncEntry libsoftwaresync() {
  HostSyncEntry entry;
  entry.info.name = "libsoftwaresync";
  entry.info.family = "libsoftwaresync";
  entry.info.summary =
      "best of up to 300 naive round trips, but stops at the first below 1 ms; offset only";
  entry.info.source = kSoftwareSync;
  entry.info.parameters = {
      number_parameter("warm_up_s", 60, 1, 1e6, "how long the service has run before the capture",
                       kAssumption),
      number_parameter("exchanges", 300, 1, 1e5, "most exchanges of a round", kSoftwareSync),
      number_parameter("early_stop_ms", 1, 0, 1e5, "a round trip below this ends the round",
                       kSoftwareSync),
      number_parameter("interval_ms", 10, 0.1, 1e6, "pace within a round", kAssumption),
      number_parameter("round_pause_s", 10, 0.1, 1e6, "time from one round to the next",
                       kAssumption),
  };
  for (ParameterSpec& spec : steering_parameters()) {
    entry.info.parameters.push_back(std::move(spec));
  }
  entry.make = [](const Parameters& parameters) {
    TwoWaySettings settings;
    settings.service_time = from_ms(parameters.number("warm_up_s") * 1e3);
    settings.is_naive = true;
    settings.exchanges = 0;
    settings.interval = from_ms(parameters.number("interval_ms"));
    settings.round_pause = from_ms(parameters.number("round_pause_s") * 1e3);
    settings.steering = steering_settings(parameters);
    settings.steer_interval = Nanoseconds(0);
    TwoWayMinimum::Settings minimum;
    minimum.exchanges = static_cast<std::size_t>(parameters.number("exchanges"));
    minimum.early_stop = from_ms(parameters.number("early_stop_ms"));
    minimum.estimate_rate = false;
    return std::make_unique<TwoWay>(settings,
                                    [minimum] { return std::make_unique<TwoWayMinimum>(minimum); });
  };
  return entry;
}

}  // namespace

std::vector<HostSyncEntry> two_way_host_syncs() {
  return {
      two_way("two_way_min_rtt",
              "best of N round trips, stamped on departure, rate over the rounds",
              "Cristian 1989; docs/reference/host_sync.md section 1", Estimator::kRoundTrip, false),
      two_way("two_way_min_rtt_naive", "the same with clocks read before the send calls",
              "Cristian 1989; docs/reference/host_sync.md section 1", Estimator::kRoundTrip, true),
      libsoftwaresync(),
      two_way("two_way_independent_minima",
              "smallest delay of each direction in N exchanges, rate over the rounds",
              "Jeske 2005; Chaudhari 2010", Estimator::kIndependentMinima, false),
      two_way("two_way_hull",
              "mid-line of the widest corridor between the hulls of both directions' bounds",
              "MOOS, MOOSSkewFilter; TICSync (Harrison and Newman 2011)", Estimator::kHull, false),
      two_way("two_way_hull_naive", "the same with clocks read before the send calls",
              "MOOS, MOOSSkewFilter; TICSync (Harrison and Newman 2011)", Estimator::kHull, true),
  };
}

}  // namespace simbench

#include "algorithms/host_sync/two_way/two_way.h"

#include <memory>
#include <string>
#include <utility>

#include "algorithms/host_sync/clock_steering.h"
#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/two_way/two_way_estimators.h"
#include "algorithms/host_sync/two_way/two_way_probe.h"
#include "algorithms/parameters.h"
#include "algorithms/registry.h"

namespace simbench {

Task<void> TwoWay::run_master(Host& host, std::vector<PeerId> slaves) {
  auto clock = std::make_shared<SteeredClock>(host, settings_.steering);
  std::vector<Task<void>> servers;
  servers.reserve(slaves.size());
  for (const PeerId slave : slaves) {
    servers.push_back(serve_two_way(host, slave, clock, settings_.is_naive));
  }
  co_await join_all(std::move(servers));
}

Task<void> TwoWay::run_slave(Host& host, PeerId master) {
  TwoWaySlave slave(host, master, settings_, make_estimator_());
  co_await slave.run();
}

namespace {

const char* const kAssumption = "assumption";

// Part of an interval by which it is varied.
constexpr double kVariation = 0.1;

Nanoseconds varied(Nanoseconds interval, double uniform) {
  const double factor = 1 + kVariation * (2 * uniform - 1);
  return from_ms(to_ms(interval) * factor);
}

}  // namespace

TwoWaySlave::TwoWaySlave(Host& host, PeerId master, TwoWaySettings settings,
                         std::unique_ptr<TwoWayEstimator> estimator)
    : host_(host),
      master_(master),
      settings_(settings),
      clock_(std::make_shared<SteeredClock>(host, settings.steering)),
      client_(host, master, clock_, settings.is_naive),
      estimator_(std::move(estimator)),
      steer_at_(host.steady_clock().now()) {}

Task<ClockLine> TwoWaySlave::refine(ClockLine line) { co_return line; }

Task<void> TwoWaySlave::run() {
  while (true) {
    const SteadyTime begin = host_.steady_clock().now();
    const Nanoseconds interval = co_await turn();
    const Nanoseconds pause = varied(interval, host_.random_uniform());
    const Nanoseconds taken = host_.steady_clock().now() - begin;
    if (pause > taken) co_await host_.sleep_for(pause - taken);
  }
}

Task<Nanoseconds> TwoWaySlave::turn() {
  const std::optional<TwoWayExchange> exchange = co_await client_.ask(TwoWay::kReplyTimeout);
  const bool is_new = exchange && estimator_->add(*exchange);
  const bool is_burst = client_.answered() < settings_.exchanges;
  const SteadyTime now = host_.steady_clock().now();
  const bool is_due = is_new && now >= steer_at_ && !is_burst;
  if (is_due) {
    steer_at_ = now + settings_.steer_interval;
    const ClockLine line = *estimator_->line();
    const ClockLine refined = co_await refine(line);
    co_await clock_->steer(refined);
  }
  report_outcome(is_due);
  if (is_new && settings_.round_pause.count() > 0) co_return settings_.round_pause;
  co_return is_burst ? settings_.burst_interval : settings_.interval;
}

void TwoWaySlave::report_outcome(bool is_steered) {
  const bool is_silent = client_.answered() == 0 && client_.asked() == TwoWay::kPatience;
  if (is_reported_ || !(is_steered || is_silent)) return;
  is_reported_ = true;
  SyncOutcome outcome;
  outcome.slave = host_.id();
  outcome.passes = client_.asked();
  outcome.synchronised = is_steered;
  if (!is_steered) {
    outcome.message = "slave " + std::to_string(host_.id()) + ": no reply from host " +
                      std::to_string(master_) + " to " + std::to_string(client_.asked()) +
                      " requests; is it running and reachable? Still asking";
  }
  host_.report_outcome(outcome);
}

std::vector<ParameterSpec> two_way_parameters() {
  std::vector<ParameterSpec> specs = {
      number_parameter("warm_up_s", 60, 1, 1e6, "how long the service has run before the capture",
                       kAssumption),
      number_parameter("exchanges", 16, 1, 1e5,
                       "exchanges of the first burst, and of each round that a minimum is taken of",
                       kAssumption),
      number_parameter("burst_interval_ms", 20, 0.1, 1e5, "pace of the first burst", kAssumption),
      number_parameter("interval_ms", 250, 0.1, 1e6, "pace after it, also during the capture",
                       "assumption: 240 exchanges in the window"),
      number_parameter("window_s", 60, 1, 1e5, "span of the hulls and of the estimate of the rate",
                       "assumption: short against the wander of a quartz"),
      number_parameter("max_rate_ppm", 500, 1, 1e4, "largest rate between two hosts",
                       "the limit of adjtimex(2)"),
  };
  for (ParameterSpec& spec : steering_parameters()) specs.push_back(std::move(spec));
  return specs;
}

TwoWaySettings two_way_settings(const Parameters& parameters) {
  TwoWaySettings settings;
  settings.service_time = from_ms(parameters.number("warm_up_s") * 1e3);
  settings.exchanges = static_cast<std::size_t>(parameters.number("exchanges"));
  settings.burst_interval = from_ms(parameters.number("burst_interval_ms"));
  settings.interval = from_ms(parameters.number("interval_ms"));
  settings.steering = steering_settings(parameters);
  settings.steer_interval = settings.steering.settle;
  return settings;
}

TwoWayHull::Settings two_way_hull_settings(const Parameters& parameters) {
  TwoWayHull::Settings settings;
  settings.window = from_ms(parameters.number("window_s") * 1e3);
  settings.max_rate_ppm = parameters.number("max_rate_ppm");
  return settings;
}

namespace {

enum class Estimator { kRoundTrip, kIndependentMinima, kHull };

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

std::vector<HostSyncEntry> host_sync_two_way() {
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

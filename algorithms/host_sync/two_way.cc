#include "algorithms/host_sync/two_way.h"

#include <string>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/two_way_probe.h"

namespace simbench {
namespace {

// Part of an interval by which it is varied.
constexpr double kVariation = 0.1;

Nanoseconds varied(Nanoseconds interval, double uniform) {
  const double factor = 1 + kVariation * (2 * uniform - 1);
  return from_ms(to_ms(interval) * factor);
}

SyncOutcome outcome_of(const Host& host, PeerId master, const TwoWayClient& client) {
  SyncOutcome outcome;
  outcome.slave = host.id();
  outcome.passes = client.asked();
  outcome.synchronised = client.answered() > 0;
  if (!outcome.synchronised) {
    outcome.message = "slave " + std::to_string(host.id()) + ": no reply from host " +
                      std::to_string(master) + " to " + std::to_string(client.asked()) +
                      " requests; is it running and reachable? Still asking";
  }
  return outcome;
}

}  // namespace

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
  auto clock = std::make_shared<SteeredClock>(host, settings_.steering);
  TwoWayClient client(host, master, clock, settings_.is_naive);
  const std::unique_ptr<TwoWayEstimator> estimator = make_estimator_();
  std::optional<SyncOutcome> outcome;
  SteadyTime steer_at = host.steady_clock().now();
  while (true) {
    const SteadyTime begin = host.steady_clock().now();
    const std::optional<TwoWayExchange> exchange = co_await client.ask(kReplyTimeout);
    const bool is_new = exchange && estimator->add(*exchange);
    const bool is_burst = client.answered() < settings_.exchanges;
    const SteadyTime now = host.steady_clock().now();
    const bool is_due = is_new && now >= steer_at && !is_burst;
    if (is_due) {
      steer_at = now + settings_.steer_interval;
      const ClockLine line = *estimator->line();
      co_await clock->steer(line);
    }
    const bool is_settled = is_due || (client.answered() == 0 && client.asked() == kPatience);
    if (!outcome && is_settled) {
      outcome = outcome_of(host, master, client);
      host.report_outcome(*outcome);
    }
    Nanoseconds interval = is_burst ? settings_.burst_interval : settings_.interval;
    if (is_new && settings_.round_pause.count() > 0) interval = settings_.round_pause;
    const Nanoseconds pause = varied(interval, host.random_uniform());
    const Nanoseconds taken = host.steady_clock().now() - begin;
    if (pause > taken) co_await host.sleep_for(pause - taken);
  }
}

}  // namespace simbench

#include "algorithms/host_sync/two_way/two_way_slave.h"

#include <string>
#include <utility>

namespace simbench {
namespace {

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

}  // namespace simbench

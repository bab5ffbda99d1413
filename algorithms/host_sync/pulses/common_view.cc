#include "algorithms/host_sync/pulses/common_view.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/messages.h"
#include "algorithms/host_sync/outcome.h"
#include "algorithms/registry.h"
#include "laws/normal_law.h"

namespace simbench {
namespace {

constexpr Nanoseconds kAnswerTimeout{500'000'000};
// Beyond so many standard deviations the tail of a normal is an exponential, and underflows.
constexpr double kFarTail = 25;

// The master's end towards one slave.
Task<void> serve_pulses(Host& host, PeerId slave, std::shared_ptr<SteeredClock> clock,
                        std::shared_ptr<PulseObserver> observer, bool is_naive) {
  TwoWayServer server(host, slave, clock, is_naive);
  MessageChannel& channel = host.open_channel(slave, Transport::kDatagram);
  while (true) {
    std::optional<ReceivedMessage> received =
        co_await channel.receive(host.steady_clock().now() + kIdle);
    if (!received) continue;
    const std::optional<CommonViewMessage> request = decode_common_view_message(received->bytes);
    if (!request) {
      co_await server.answer(std::move(*received));
      continue;
    }
    if (request->is_answer) continue;
    co_await observer->collect();
    CommonViewMessage answer{.is_answer = true, .index = request->index};
    const std::optional<Sighting> pulse = observer->middle();
    if (pulse) {
      answer.pulse = CommonViewMessage::Pulse{.at = clock->at(pulse->at),
                                              .sigma_ns = std::llround(pulse->sigma_ns)};
    }
    Bytes bytes = encode(answer);
    co_await channel.send(std::move(bytes));
  }
}

class CommonViewSlave : public TwoWaySlave {
 public:
  // `hull` is the estimator's, for its corridor.
  CommonViewSlave(Host& host, PeerId master, const TwoWaySettings& settings,
                  std::unique_ptr<TwoWayEstimator> estimator, const TwoWayHull& hull,
                  PulseObserver observer)
      : TwoWaySlave(host, master, settings, std::move(estimator)),
        hull_(hull),
        observer_(std::move(observer)) {}

 private:
  Task<ClockLine> refine(ClockLine line) override {
    co_await observer_.collect();
    const std::optional<CommonViewMessage::Pulse> pulse = co_await ask();
    if (pulse) take(line, *pulse);
    line.value -= from_ns(correction_ns_);
    co_return line;
  }

  // Requests the time at which the master saw a pulse.
  Task<std::optional<CommonViewMessage::Pulse>> ask() {
    Bytes bytes = encode(CommonViewMessage{.index = ++index_});
    co_await channel().send(std::move(bytes));
    const SteadyTime deadline = host().steady_clock().now() + kAnswerTimeout;
    while (true) {
      std::optional<ReceivedMessage> received = co_await channel().receive(deadline);
      if (!received) co_return std::nullopt;
      const std::optional<CommonViewMessage> answer = decode_common_view_message(received->bytes);
      if (answer && answer->is_answer && answer->index == index_) co_return answer->pulse;
    }
  }

  void take(const ClockLine& line, const CommonViewMessage::Pulse& pulse) {
    const std::optional<Sighting> seen = observer_.nearest(line.when(pulse.at));
    if (!seen) return;
    const auto offset_ns = static_cast<double>((line.read(seen->at) - pulse.at).count());
    const auto master_sigma_ns = static_cast<double>(pulse.sigma_ns);
    correction_ns_ = common_view_correction_ns(
        {.offset_ns = offset_ns, .sigma_ns = std::hypot(seen->sigma_ns, master_sigma_ns)},
        to_ns(hull_.width().value_or(Nanoseconds(0))) / 2);
  }

  const TwoWayHull& hull_;
  PulseObserver observer_;
  std::uint32_t index_ = 0;
  double correction_ns_ = 0;
};

}  // namespace

double common_view_correction_ns(CommonViewCorrection measured, double bound_ns) {
  if (bound_ns <= 0) return 0;
  if (measured.offset_ns < 0) {
    return -common_view_correction_ns({-measured.offset_ns, measured.sigma_ns}, bound_ns);
  }
  const double nearest_ns = std::min(measured.offset_ns, bound_ns);
  if (measured.sigma_ns <= 0) return nearest_ns;
  // In standard deviations from c; low is the farther end.
  const double low = (-bound_ns - measured.offset_ns) / measured.sigma_ns;
  const double high = (bound_ns - measured.offset_ns) / measured.sigma_ns;
  if (high < -kFarTail) return std::max(-bound_ns, bound_ns + measured.sigma_ns / high);
  const double inside = normal_probability(high) - normal_probability(low);
  const double shift = (normal_density(low) - normal_density(high)) / inside;
  return std::clamp(measured.offset_ns + measured.sigma_ns * shift, 0.0, nearest_ns);
}

Task<void> CommonView::run_master(Host& host, std::vector<PeerId> slaves) {
  auto clock = std::make_shared<SteeredClock>(host, settings_.two_way.steering);
  auto observer = std::make_shared<PulseObserver>(host, settings_.pulses);
  std::vector<Task<void>> servers;
  servers.reserve(slaves.size());
  for (const PeerId slave : slaves) {
    servers.push_back(serve_pulses(host, slave, clock, observer, settings_.two_way.is_naive));
  }
  co_await join_all(std::move(servers));
}

Task<void> CommonView::run_slave(Host& host, PeerId master) {
  PulseObserver observer(host, settings_.pulses);
  if (!observer.is_possible()) {
    OutcomeReport(host).failed(
        0, std::string("the host has no ") + port_name(settings_.pulses.source));
    co_return;
  }
  auto estimator = std::make_unique<TwoWayHull>(settings_.hull);
  const TwoWayHull& hull = *estimator;
  CommonViewSlave slave(host, master, settings_.two_way, std::move(estimator), hull,
                        std::move(observer));
  co_await slave.run();
}

void CommonViewSettings::bind(ParameterBinder& parameters) {
  two_way.bind(parameters, hull);
  parameters.number("pulse_window_s", pulses.window, 1, 1e5, "span of the pulses that are compared",
                    kAssumption);
  parameters.number("settle_s", pulses.settle, 0, 1e5,
                    "frames of a camera's first seconds that are left out",
                    "docs/reference/paper.md section 8: the first 5 s are unsteady");
}

namespace {

HostSyncEntry common_view(std::string name, std::string summary, std::string source,
                          PulseSource pulses, Need need) {
  return with_settings<HostSyncEntry>(
      {.name = std::move(name),
       .family = "common_view",
       .summary = std::move(summary),
       .source = std::move(source),
       .needs = {need}},
      CommonViewSettings{.two_way = {}, .hull = {}, .pulses = {.source = pulses}},
      kMake<CommonView>);
}

}  // namespace

std::vector<HostSyncEntry> host_sync_common_view() {
  return {
      common_view("common_view",
                  "two-way hull, its offset corrected by the pulses that all hosts see as frames",
                  "after TriggerSync; two_way_hull", PulseSource::kFrames, Need::kFrames),
      common_view("trigger_wired",
                  "two-way hull, its offset corrected by trigger pulses wired into each host",
                  "theory; two_way_hull", PulseSource::kTrigger, Need::kTriggerLine),
      common_view("pps", "two-way hull, its offset corrected by a PPS wired into each host",
                  "theory; two_way_hull", PulseSource::kPps, Need::kPps),
  };
}

}  // namespace simbench

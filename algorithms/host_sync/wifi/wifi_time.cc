#include "algorithms/host_sync/wifi/wifi_time.h"

#include <cstdint>
#include <optional>
#include <string>

#include "algorithms/host_sync/outcome.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

constexpr std::uint32_t kPatience = 16;

template <class Reading>
SteadyTime middle_of_call(const Reading& reading) {
  return reading.before + (reading.after - reading.before) / 2;
}

template <class Reading>
bool is_quicker(const std::optional<Reading>& reading, const std::optional<Reading>& than) {
  return reading && (!than || reading->after - reading->before < than->after - than->before);
}

Task<std::optional<TsfReading>> quickest_tsf(RadioClock& radio, int readings) {
  std::optional<TsfReading> best;
  for (int i = 0; i < readings; ++i) {
    const std::optional<TsfReading> reading = co_await radio.read_tsf();
    if (is_quicker(reading, best)) best = reading;
  }
  co_return best;
}

Task<std::optional<CounterReading>> quickest_counter(RadioClock& radio, int readings) {
  std::optional<CounterReading> best;
  for (int i = 0; i < readings; ++i) {
    const std::optional<CounterReading> reading = co_await radio.read_counter();
    if (is_quicker(reading, best)) best = reading;
  }
  co_return best;
}

// What a host that follows keeps. The master reports no outcome: its own clock is nobody's.
class Follower {
 public:
  Follower(Host& host, const WifiTimeSettings& settings, bool is_slave)
      : host_(host), clock_(host, settings.steering), outcome_(host), is_slave_(is_slave) {}

  // A coarse clock is known the better, the more often it was read.
  Task<void> steer(ClockLine line) {
    co_await clock_.look();
    co_await clock_.steer(line);
    ++tries_;
    if (is_slave_) outcome_.synchronised(tries_);
  }
  // The try brought nothing, because of `why`.
  void heard_nothing(const char* why) {
    if (++tries_ == kPatience && is_slave_) outcome_.failed(tries_, why);
  }
  RadioClock* radio() {
    RadioClock* const radio = host_.radio_clock();
    if (radio == nullptr && is_slave_) {
      outcome_.failed(0, "the host has no radio whose time it can use (Host::radio_clock)");
    }
    return radio;
  }

 private:
  Host& host_;
  SteeredClock clock_;
  OutcomeReport outcome_;
  bool is_slave_;
  std::uint32_t tries_ = 0;
};

Task<void> follow_tsf(Host& host, WifiTimeSettings settings, bool is_slave) {
  Follower follower(host, settings, is_slave);
  RadioClock* const radio = follower.radio();
  if (radio == nullptr) co_return;
  CounterLine tsf(settings.window);
  while (true) {
    const std::optional<TsfReading> reading = co_await quickest_tsf(*radio, settings.readings);
    if (reading) {
      const SteadyTime middle = middle_of_call(*reading);
      tsf.add(middle.time_since_epoch(), offset_between(reading->tsf, middle));
    }
    const std::optional<CounterLine::Fit> fit = tsf.fit();
    if (reading && fit) {
      const SteadyTime now = host.steady_clock().now();
      const Nanoseconds steady = now.time_since_epoch();
      const ClockLine line{
          .at = now, .value = HostTime(steady + fit->ahead(steady)), .rate_ppb = fit->rate() * 1e9};
      co_await follower.steer(line);
    } else {
      follower.heard_nothing("no beacon of the access point; is it in reach?");
    }
    co_await host.sleep_for(settings.interval);
  }
}

// The TSF over the steady clock, by way of the radio's counter; `tsf` is nothing at the access
// point, whose counter is the TSF.
ClockLine line_through(const CounterLine::Fit& counter, const std::optional<CounterLine::Fit>& tsf,
                       SteadyTime now) {
  const Nanoseconds steady = now.time_since_epoch();
  const Nanoseconds counts = steady + counter.ahead(steady);
  double rate = counter.rate();
  Nanoseconds value = counts;
  if (tsf) {
    value += tsf->ahead(counts);
    rate = (1 + rate) * (1 + tsf->rate()) - 1;
  }
  return {.at = now, .value = HostTime(value), .rate_ppb = rate * 1e9};
}

Task<void> follow_ftm(Host& host, WifiTimeSettings settings, bool is_slave) {
  Follower follower(host, settings, is_slave);
  RadioClock* const radio = follower.radio();
  if (radio == nullptr) co_return;
  CounterLine counter(settings.window);
  CounterLine tsf(settings.window);
  while (true) {
    const std::vector<FtmExchange> exchanges = co_await radio->measure_ftm();
    for (const FtmExchange& exchange : exchanges) {
      tsf.add(middle_of(exchange).time_since_epoch(), tsf_ahead(exchange));
    }
    const std::optional<CounterReading> reading =
        co_await quickest_counter(*radio, settings.readings);
    if (reading) {
      const SteadyTime middle = middle_of_call(*reading);
      counter.add(middle.time_since_epoch(), offset_between(reading->counter, middle));
    }
    const std::optional<CounterLine::Fit> counter_fit = counter.fit();
    const std::optional<CounterLine::Fit> tsf_fit = tsf.fit();
    const bool is_heard = !exchanges.empty() || radio->is_access_point();
    if (is_heard && counter_fit && (tsf_fit || radio->is_access_point())) {
      const ClockLine line = line_through(*counter_fit, tsf_fit, host.steady_clock().now());
      co_await follower.steer(line);
    } else {
      follower.heard_nothing("no session of FTM came back; does the access point answer them?");
    }
    co_await host.sleep_for(settings.interval);
  }
}

}  // namespace

Nanoseconds tsf_ahead(const FtmExchange& exchange) {
  return (offset_between(exchange.t1, exchange.t2) + offset_between(exchange.t4, exchange.t3)) / 2;
}

HardwareTime middle_of(const FtmExchange& exchange) {
  return exchange.t2 + (exchange.t3 - exchange.t2) / 2;
}

Task<void> serve_wifi_tsf(Host& host, std::vector<PeerId> /*slaves*/, WifiTimeSettings settings) {
  co_await follow_tsf(host, settings, false);
}

Task<void> follow_wifi_tsf(Host& host, PeerId /*master*/, WifiTimeSettings settings) {
  co_await follow_tsf(host, settings, true);
}

Task<void> serve_wifi_ftm(Host& host, std::vector<PeerId> /*slaves*/, WifiTimeSettings settings) {
  co_await follow_ftm(host, settings, false);
}

Task<void> follow_wifi_ftm(Host& host, PeerId /*master*/, WifiTimeSettings settings) {
  co_await follow_ftm(host, settings, true);
}

void WifiTimeSettings::bind(ParameterBinder& parameters) {
  bind_warm_up(parameters, service_time);
  parameters.number("interval_s", interval, 0.01, 1e5,
                    "from one reading or session to the next one's begin", kAssumption);
  parameters.number("readings", readings, 1, 1000,
                    "calls to the counter each time, of which the quickest counts", kAssumption);
  parameters.number("window_s", window, 4, 1e5, "span of the readings that a line is fitted to",
                    "assumption: short against the wander of a quartz");
  steering.bind(parameters);
}

std::vector<HostSyncEntry> host_sync_wifi() {
  return {
      with_settings<HostSyncEntry>(
          {.name = "wifi_tsf",
           .family = "wifi_tsf",
           .summary = "every host, the master too, follows the access point's counter, which "
                      "beacons tell (TSF)",
           .source = "IEEE 802.11-2020, 11.1.3; docs/reference/wifi_time.md section 2",
           .needs = {Need::kTsf}},
          WifiTimeSettings{}, kMake<TsfService>),
      with_settings<HostSyncEntry>(
          {.name = "wifi_ftm",
           .family = "wifi_ftm",
           .summary = "every host, the master too, follows the access point's counter, which its "
                      "radio measures (FTM, 802.11mc)",
           .source = "IEEE 802.11-2020, 11.21.6; docs/reference/wifi_time.md section 3",
           .needs = {Need::kFtm}},
          WifiTimeSettings{}, kMake<FtmService>),
  };
}

}  // namespace simbench

// A small world of simulated hosts for tests: no cost, no noise, no latency unless a test says so.
#pragma once

#include <boost/asio/co_spawn.hpp>
#include <exception>
#include <utility>
#include <variant>
#include <vector>

#include "sim/host/host_group.h"
#include "tests/recording/test_sink.h"
#include "tests/sim/at_ms.h"

namespace simbench::sim {

inline scenarios::Scenario ideal_hosts(std::int64_t count = 2) {
  scenarios::Scenario scenario{};
  scenario.hosts.count = count;
  scenario.network.retransmit_timeout_ms = 200;
  scenario.network.stamp_point = scenarios::StampPoint::kApplication;
  return scenario;
}

class KeptRecord : public TestSink {
 public:
  void on_event(const RecordingEvent& event) override {
    if (const auto* adjustment = std::get_if<ClockAdjustment>(&event)) {
      adjustments.push_back(*adjustment);
    } else if (const auto* exchanged = std::get_if<ExchangeEvent>(&event)) {
      exchanges.emplace_back(exchanged->host, exchanged->exchange);
    } else if (const auto* outcome = std::get_if<SyncOutcome>(&event)) {
      outcomes.push_back(*outcome);
    } else if (const auto* reported = std::get_if<SessionDelays>(&event)) {
      delays.push_back(*reported);
    } else if (const auto* failure = std::get_if<ProgramFailure>(&event)) {
      program_failures.push_back(*failure);
    }
  }

  std::vector<ClockAdjustment> adjustments;
  std::vector<std::pair<std::uint32_t, Exchange>> exchanges;
  std::vector<SyncOutcome> outcomes;
  std::vector<SessionDelays> delays;
  std::vector<ProgramFailure> program_failures;
};

class SimWorld {
 public:
  explicit SimWorld(scenarios::Scenario parameters, std::uint64_t seed = 1,
                    InitialClocks clocks = InitialClocks::kUnsynchronised,
                    std::string_view load_key = "test@world", TrueTime start = {})
      : scenario(std::move(parameters)),
        engine({}, start),
        context(engine),
        hosts(scenario, seed, load_key, clocks, context, record) {}

  void spawn(Task<void> task) {
    boost::asio::co_spawn(context, std::move(task), [](const std::exception_ptr& failure) {
      if (failure) std::rethrow_exception(failure);
    });
  }
  SimHost& host(std::size_t index) { return hosts.host(index); }
  TrueTime now() const { return engine.now(); }
  double now_ms() const { return ms_of(engine.now()); }

  scenarios::Scenario scenario;
  KeptRecord record;
  Engine engine;
  VirtualContext context;
  HostGroup hosts;
};

}  // namespace simbench::sim

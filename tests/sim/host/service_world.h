// A small world of simulated hosts in which a service runs for a while.
//
//   ServiceWorld world(scenario);
//   world.start(service);
//   world.run_until(3600);
//   EXPECT_LT(std::abs(world.error_s(1)), 1e-3);
#pragma once

#include <boost/asio/co_spawn.hpp>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "sim/host/host_group.h"
#include "tests/sim/host/sim_world.h"

namespace simbench::sim {

class ServiceWorld {
 public:
  explicit ServiceWorld(scenarios::Scenario parameters, std::uint64_t seed = 1)
      : scenario_(std::move(parameters)),
        engine_({}, TrueTime{}),
        context_(std::make_unique<VirtualContext>(engine_)),
        hosts_(scenario_, seed, "test@world", InitialClocks::kUnsynchronised, *context_, record) {
    hosts_.report_clocks();
  }
  ServiceWorld(const ServiceWorld&) = delete;
  ServiceWorld& operator=(const ServiceWorld&) = delete;
  // Coroutines that still wait go first: they use the hosts.
  ~ServiceWorld() { context_.reset(); }

  void start(HostSync& service) {
    std::vector<PeerId> slaves;
    for (PeerId host = 1; host < hosts_.size(); ++host) slaves.push_back(host);
    for (const PeerId slave : slaves) spawn(service.run_slave(hosts_.host(slave), 0));
    spawn(service.run_master(hosts_.host(0), slaves));
  }
  void spawn(Task<void> task) {
    boost::asio::co_spawn(*context_, std::move(task), [](const std::exception_ptr& failure) {
      if (failure) std::rethrow_exception(failure);
    });
  }
  void begin_faults() { hosts_.begin_faults(); }
  void run_until(double at_s) { engine_.run_until(TrueTime(from_ms(at_s * 1e3))); }
  // Runs on to `end_s` and calls `look` every `step_s`.
  void watch(double end_s, double step_s, const std::function<void(double at_s)>& look) {
    for (double at_s = now_s() + step_s; at_s <= end_s; at_s += step_s) {
      run_until(at_s);
      look(at_s);
    }
  }

  double now_s() const { return to_seconds(engine_.now() - TrueTime{}); }
  // The slave's clock minus the master's.
  double error_s(std::size_t slave) {
    const TrueTime now = engine_.now();
    return to_seconds(hosts_.clock(slave).read(now) - hosts_.clock(0).read(now));
  }
  SystemClock& clock(std::size_t host) { return hosts_.clock(host); }
  SimHost& host(std::size_t index) { return hosts_.host(index); }
  std::uint64_t events() const { return engine_.events(); }
  TrueTime now() const { return engine_.now(); }

  KeptRecord record;

 private:
  scenarios::Scenario scenario_;
  Engine engine_;
  std::unique_ptr<VirtualContext> context_;
  HostGroup hosts_;
};

}  // namespace simbench::sim

// The host synchronisation of a world under way: the coroutines of the master and of all slaves;
// and those of the capture alignment. Slaves follow the hosts that the scenario states
// (/hosts/follows); one that others follow has both parts, as a relay.
//
//   SynchronisationRun synchronisation(hosts, context);
//   synchronisation.start(host_sync, [&] { start_capture(); });
//   run_world(engine);
//   synchronisation.check(scenario, "chrony");
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/ports/capture_alignment.h"
#include "algorithms/ports/host_sync.h"
#include "clocks/disciplined_clock.h"
#include "scenarios/loader.h"
#include "scenarios/scenario.h"
#include "sim/engine/engine.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/host_group.h"

namespace simbench::sim {

// engine.run(); throws scenarios::InputError, one line, for a world too large for its limits.
//
// It runs inside a loop of Asio's own, since coroutines that end there leave their memory to the
// next ones.
inline void run_world(Engine& engine) {
  try {
    boost::asio::io_context loop(1);
    boost::asio::post(loop, [&engine] { engine.run(); });
    loop.run();
  } catch (const EngineLimitReached& limit) {
    throw scenarios::InputError(fmt::format(
        "found a world that is too large: {}; allowed: fewer frames, cameras or hosts, or "
        "a shorter host synchronisation",
        limit.limit()));
  }
}

class SynchronisationRun {
 public:
  // Both must outlive the engine's run; the coroutines end with the context.
  SynchronisationRun(HostGroup& hosts, VirtualContext& context)
      : hosts_(hosts), context_(context) {}
  SynchronisationRun(const SynchronisationRun&) = delete;
  SynchronisationRun& operator=(const SynchronisationRun&) = delete;

  // Begins now; `on_end` is called when the master has returned. A coroutine that throws stops the
  // engine.
  void start(HostSync& host_sync, std::function<void()> on_end) {
    on_end_ = std::move(on_end);
    std::vector<std::vector<PeerId>> followers(hosts_.size());
    for (PeerId host = 1; host < hosts_.size(); ++host) {
      followers[hosts_.followed(host)].push_back(host);
    }
    for (PeerId slave = 1; slave < hosts_.size(); ++slave) {
      Host& of = hosts_.host(slave);
      const PeerId followed = hosts_.followed(slave);
      boost::asio::co_spawn(
          context_,
          followers[slave].empty() ? host_sync.run_slave(of, followed)
                                   : host_sync.run_relay(of, followed, std::move(followers[slave])),
          [this, slave](const std::exception_ptr& failure) { ended(slave, failure); });
    }
    boost::asio::co_spawn(context_, host_sync.run_master(hosts_.host(0), std::move(followers[0])),
                          [this](const std::exception_ptr& failure) {
                            ended(0, failure);
                            if (!failure) on_end_();
                          });
  }

  // The coroutines of a capture alignment, on all hosts, from now on.
  void start(CaptureAlignment& alignment) {
    std::vector<PeerId> slaves;
    for (PeerId host = 1; host < hosts_.size(); ++host) slaves.push_back(host);
    for (PeerId host = 0; host < hosts_.size(); ++host) {
      Host& of = hosts_.host(host);
      boost::asio::co_spawn(
          context_, host == 0 ? alignment.run_master(of, slaves) : alignment.run_slave(of, 0),
          [this, host](const std::exception_ptr& failure) { ended(host, failure); });
    }
  }

  // Throws what a coroutine has thrown; for an adjustment that a clock refuses an InputError, which
  // names the host and the host_sync of the scenario's pipeline of that name.
  void check(const scenarios::Scenario& scenario, const std::string& pipeline) const {
    if (!failure_) return;
    try {
      std::rethrow_exception(failure_);
    } catch (const clocks::ClockError& error) {
      const auto found =
          std::ranges::find(scenario.pipelines, pipeline, &scenarios::Pipeline::name);
      throw scenarios::InputError(
          fmt::format("host_sync {} on host {}: {}",
                      found == scenario.pipelines.end() ? pipeline : found->host_sync, failed_host_,
                      error.what()));
    }
  }

 private:
  void ended(PeerId host, const std::exception_ptr& failure) {
    if (!failure) return;
    failure_ = failure;
    failed_host_ = host;
    context_.engine().stop();
  }

  HostGroup& hosts_;
  VirtualContext& context_;
  std::function<void()> on_end_;
  std::exception_ptr failure_;
  PeerId failed_host_ = 0;  // whose coroutine that was
};

}  // namespace simbench::sim

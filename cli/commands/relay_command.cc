#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/commands/commands.h"
#include "hardware/relay/relay.h"
#include "hardware/rig/rig.h"
#include "scenarios/loader.h"

namespace simbench::cli {
namespace {

constexpr const char* kRelayExamples = R"(
A tool for tests: nodes on one machine communicate through it as if the scenario's network lay
between them, with its latency, loss, duplication and reordering. `simbench validate-model` uses it.

Each node has a rig file of its own, given here in the order of the hosts: its own entry states
where it listens, the others are addresses on which the relay listens. Addresses are loopback or
private. Prints "ready" when it listens, and its statistics as a line of JSON when it ends: on
SIGTERM or SIGINT, after --for, or with the program that started it.

Examples:
  simbench relay --scenario 6node_relay --nodes node0.json,node1.json
  simbench relay --scenario 6node_relay --nodes node0.json,node1.json --seed 7 --for 60

Exit status: 0 ok, 1 internal error, 2 bad usage or input.)";

struct RelayOptions {
  std::string scenario;
  std::vector<std::string> sets;
  std::vector<std::string> nodes;
  std::vector<std::string> wires;
  std::uint64_t seed = 1;
  double for_s = 0;
};

int run_relay(const RelayOptions& options) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  hardware::ask_for_exact_timers();
  // Above the nodes' priority, if permitted: the relay's own lateness is no part of the network.
  setpriority(PRIO_PROCESS, 0, -20);
  const scenarios::Scenario scenario =
      scenarios::load_scenario(options.scenario, overrides_of(options.sets));
  hardware::check_relay_can(scenario);
  hardware::RelaySettings settings{
      .nodes = {}, .scenario = &scenario, .seed = options.seed, .wires = options.wires};
  for (const std::string& file : options.nodes) settings.nodes.push_back(hardware::load_rig(file));

  boost::asio::io_context context(1);
  boost::asio::signal_set signals(context, SIGTERM, SIGINT);
  boost::asio::steady_timer limit(context);
  std::unique_ptr<hardware::Relay> relay;
  try {
    relay = std::make_unique<hardware::Relay>(context, settings);
  } catch (const hardware::RelayError& error) {
    throw scenarios::InputError(error.what());
  }
  const auto end = [&](const boost::system::error_code& error) {
    if (error) return;
    relay->stop();
    signals.cancel();
    limit.cancel();
  };
  signals.async_wait([&](const boost::system::error_code& error, int) { end(error); });
  if (options.for_s > 0) {
    limit.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(options.for_s)));
    limit.async_wait(end);
  }
  print_result("ready\n");
  context.run();
  print_result(hardware::statistics_json(relay->statistics()) + "\n");
  return kOk;
}

}  // namespace

void add_relay_command(CommandLine& line) {
  auto options = std::make_shared<RelayOptions>();
  Command command(line, "relay",
                  "Act as a scenario's network between nodes on this machine (for tests)");
  command.scenario(options->scenario);
  command.sets(options->sets);
  command
      .list("--nodes", "FILE,FILE...", options->nodes,
            "The rig file of each node, in the order of the hosts")
      .required();
  command.list("--wires", "NAME,NAME...", options->wires,
               "Network interfaces of the programs' network, in the order of the hosts:\n"
               "datagrams from one to another pass by the same law");
  command.seed("--seed", options->seed, "The seed of latencies and losses. Default: 1");
  command.number("--for", "SECONDS", options->for_s, 0, 86400,
                 "End after this time. Default: no limit");
  command.footer(kRelayExamples);
  command.runs([options] { return run_relay(*options); });
}

}  // namespace simbench::cli

#include "cli/commands/relay_command.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "cli/exit_status.h"
#include "hardware/relay/relay.h"
#include "hardware/rig/rig.h"
#include "scenarios/loader.h"

namespace simbench::cli {
namespace {

constexpr const char* kRelayExamples = R"(
A tool for tests: nodes on one machine talk through it as if the scenario's network lay between
them, with its latency, loss, duplication and reordering. It is what `simbench validate-model` puts
between its nodes.

Each node has a rig file of its own, given here in the order of the hosts: its own entry says where
it listens, the others are addresses for the relay to listen on. Addresses are loopback or private.
Prints "ready" once it listens, and its statistics as a line of JSON when it ends: on SIGTERM or
SIGINT, after --for, or with the program that started it.

Examples:
  simbench relay --scenario 6node_relay --nodes node0.json,node1.json
  simbench relay --scenario 6node_relay --nodes node0.json,node1.json --seed 7 --for 60

Exit status: 0 ok, 1 internal error, 2 bad usage or input.)";

struct RelayOptions {
  std::string scenario;
  std::vector<std::string> sets;
  std::vector<std::string> nodes;
  std::uint64_t seed = 1;
  double for_s = 0;
};

int run_relay(const RelayOptions& options) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  prctl(PR_SET_TIMERSLACK, 1UL);
  // Before the nodes, where that is permitted: its own lateness is no part of the network.
  setpriority(PRIO_PROCESS, 0, -20);
  const scenarios::Scenario scenario =
      scenarios::load_scenario(options.scenario, overrides_of(options.sets));
  hardware::check_relay_can(scenario);
  hardware::RelaySettings settings{.nodes = {}, .scenario = &scenario, .seed = options.seed};
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
  std::cout << "ready" << std::endl;
  context.run();
  print_result(hardware::statistics_json(relay->statistics()) + "\n");
  return kOk;
}

}  // namespace

void add_relay_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "relay", "Be the network of a scenario between nodes on this machine (for tests)");
  auto options = std::make_shared<RelayOptions>();
  command
      ->add_option("--scenario", options->scenario,
                   "Name of a scenario (see `simbench list`) or path of a scenario file")
      ->type_name("SCENARIO")
      ->required();
  add_set_option(*command, options->sets);
  command
      ->add_option("--nodes", options->nodes,
                   "The rig file of each node, in the order of the hosts")
      ->type_name("FILE,FILE...")
      ->delimiter(',')
      ->required();
  command->add_option("--seed", options->seed, "Of latencies and losses. Default: 1")
      ->type_name("K")
      ->check(whole_number(0, std::numeric_limits<std::uint32_t>::max()));
  command->add_option("--for", options->for_s, "End after this time. Default: run on")
      ->type_name("SECONDS")
      ->check(number_within(0, 86400));
  command->footer(kRelayExamples);
  command->callback([options, &action] { action = [options] { return run_relay(*options); }; });
}

}  // namespace simbench::cli

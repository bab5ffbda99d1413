// Host synchronisation by real programs on the host of a node: the same programs, files and library
// as on a simulated host (sim/programs/program_sync.h), around the node's software clock.
//
// Nothing but the clock is served (shim/own_clock.h): the programs wait in real time and speak over
// the network of the namespace in which the node runs. They are confined (processes/confinement.h):
// they set no clock of the machine. The node's namespace should reach nothing but the experiment.
//
// A program that ends by itself may be the host's failure, or have done its work
// (processes/program_endings.h). Cancelling ends the programs.
//
// Errors: std::runtime_error on a host whose clock is not in software, and for a folder that cannot
// be made. A program that cannot be started has ended.
//
//   NodePrograms chronyd({.programs = {.master = {{"/usr/sbin/chronyd", "-d", "-f",
//   "server.conf"}},
//                                      .slave = {{"/usr/sbin/chronyd", "-d", "-f", "client.conf"}},
//                                      .files = {{"client.conf", "server {master} iburst"}}},
//                         .shim = "/usr/lib/simbench/libsimbench_shim.so"});
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "recording/temporary_folder.h"
#include "scenarios/scenario.h"

namespace simbench::hardware {

struct NodeProgramSettings {
  scenarios::HostPrograms programs;
  std::map<std::string, std::string> paths{};  // absolute, by a command's first word without one
  std::string shim;                            // the library's absolute path
  // Where the host's files and what its programs print stay, in host3; empty: nowhere.
  std::string log_folder{};
  std::string interface = "eth0";  // {interface}
};

class NodePrograms final : public HostSync {
 public:
  explicit NodePrograms(NodeProgramSettings settings);

  std::optional<Nanoseconds> warm_up() const override;
  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override;
  Task<void> run_slave(Host& host, PeerId master) override;

 private:
  Task<void> run(Host& host, std::vector<scenarios::HostPrograms::Command> commands);
  std::string make_folder(PeerId host) const;

  NodeProgramSettings settings_;
  TemporaryFolder temporary_;
};

}  // namespace simbench::hardware

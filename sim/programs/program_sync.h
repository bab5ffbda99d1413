// Host synchronisation by real programs: their processes on each host, in the simulated world.
//
// Every host runs the programs of its role, the master's or a slave's, from the beginning of the
// run; they end with the world. In commands, files and the environment, {master} is the master's
// address, {address} and {host} are the host's own address and number, {files} is its folder. Files
// are written there first.
//
// The first program of a host that ends is the host's failure, with its last words; nobody says
// that a host is synchronised.
//
// Only one process runs at a time, and time moves only when all wait: the same scenario and seed
// give the same bytes. For the simulated world only: other hosts are a std::logic_error.
//
//   ProgramSync chronyd({.master = {{"/usr/sbin/chronyd", "-d", "-f", "server.conf"}},
//                        .slave = {{"/usr/sbin/chronyd", "-d", "-f", "client.conf"}},
//                        .files = {{"client.conf", "server {master} iburst"}}});
#ifndef SIMBENCH_SIM_PROGRAMS_PROGRAM_SYNC_H_
#define SIMBENCH_SIM_PROGRAMS_PROGRAM_SYNC_H_

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/ports/host_sync.h"

namespace simbench::sim {

struct ProgramSettings {
  using Command = std::vector<std::string>;
  std::vector<Command> master;  // the first word is an absolute path
  std::vector<Command> slave;
  std::map<std::string, std::string> files;  // contents by name
  std::map<std::string, std::string> environment;
  Nanoseconds run_before_capture{};
  std::string shim;    // the library's absolute path
  std::string folder;  // where the hosts' folders are made: "host0", ...
  std::size_t hosts = 0;
};

class ProgramSync final : public HostSync {
 public:
  explicit ProgramSync(ProgramSettings settings) : settings_(std::move(settings)) {}

  std::optional<Nanoseconds> warm_up() const override { return settings_.run_before_capture; }
  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override;
  Task<void> run_slave(Host& host, PeerId master) override;

 private:
  ProgramSettings settings_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_PROGRAMS_PROGRAM_SYNC_H_

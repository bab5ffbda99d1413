// Host synchronisation by real programs: their processes on each host, in the simulated world.
//
// Every host runs the programs of its role, the master's or a slave's, from the beginning of the
// run; they end with the world, or when the capture begins where they do not run during it. Each
// host has a folder of its own, in which its programs run; the files are written there first, with
// their placeholders filled in (processes/placeholders.h), and what the programs print goes to
// "0_chronyd.log", by number and name.
//
// A program that ends by itself may be the host's failure, or have done its work
// (processes/program_endings.h). A slave whose clock no program has set or steered after
// run_before_capture_s, or a minute if that is more, is not synchronised until one does. After the
// run notes() has the failures, slaves that nobody has set in a shorter run, and a master whose
// programs have all ended.
//
// Only one process runs at a time, and time moves only when all wait: the same scenario and seed
// give the same bytes. For the simulated world only: other hosts are a std::logic_error.
//
//   ProgramSync chronyd({.pipeline = "chronyd",
//                        .programs = {.master = {{"/usr/sbin/chronyd", "-d", "-f", "server.conf"}},
//                                     .slave = {{"/usr/sbin/chronyd", "-d", "-f", "client.conf"}},
//                                     .files = {{"client.conf", "server {master} iburst"}}},
//                        .shim = "/usr/lib/simbench/libsimbench_shim.so",
//                        .hosts = 6});
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "processes/program_use.h"
#include "recording/temporary_folder.h"
#include "scenarios/scenario.h"

namespace simbench::sim {

class SimHost;

struct ProgramSettings {
  std::string pipeline;  // its name
  scenarios::HostPrograms programs;
  std::map<std::string, std::string> paths{};  // absolute, by a command's first word without one
  std::string shim;                            // the library's absolute path
  // Where the hosts' folders stay, in PIPELINE/seed1/host0; empty: nowhere.
  std::string log_folder{};
  std::optional<std::chrono::milliseconds> patience{};  // else Child::kPatience
  std::size_t hosts = 0;
};

class ProgramSync final : public HostSync {
 public:
  explicit ProgramSync(ProgramSettings settings);

  std::optional<Nanoseconds> warm_up() const override;
  std::vector<std::string> notes() const override;
  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override;
  Task<void> run_slave(Host& host, PeerId master) override;
  // The programs of a slave are to serve as well.
  bool can_relay() const override { return true; }

 private:
  Task<void> run(Host& host, std::vector<scenarios::HostPrograms::Command> commands);
  // Empty, and made.
  std::string make_folder(SimHost& host);
  // The host's log folder, as the user has named it; empty: nobody keeps it.
  std::string kept_folder(const SimHost& host) const;

  ProgramSettings settings_;
  std::unique_ptr<TemporaryFolder> temporary_;
  std::shared_ptr<processes::RunUse> run_ = std::make_shared<processes::RunUse>();
  std::vector<ProgramFailure> failures_;  // one of a host, in the order of their ends
  std::vector<std::string> notes_;
  std::set<PeerId> unset_;  // slaves whose clocks nobody set, which nothing else says
};

}  // namespace simbench::sim

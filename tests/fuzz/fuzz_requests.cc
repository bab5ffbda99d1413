// What a program of the simulated world can send to it: any bytes, in any packets, are answered or
// end the program with a note.
//
// An input is packets: two bytes of length, the lower first, then as many bytes.
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/host_sync/join.h"
#include "scenarios/loader.h"
#include "sim/programs/program.h"
#include "tests/sim/host/service_world.h"

namespace {

using simbench::Task;
using simbench::sim::CardClock;
using simbench::sim::HostFiles;
using simbench::sim::HostNetwork;
using simbench::sim::HostProcesses;
using simbench::sim::KernelClock;
using simbench::sim::Program;
using simbench::sim::PulseDevices;
using simbench::sim::ServiceWorld;
using simbench::sim::SimHost;

constexpr std::size_t kHosts = 2;
constexpr double kWorldSeconds = 2;

Task<void> serve(Program& program, std::string& note) {
  co_await program.serve();
  note = program.ending();
}

Task<void> run(SimHost& host, int link, std::string& note) {
  HostNetwork network(host, kHosts);
  KernelClock kernel(host);
  CardClock card(host);
  PulseDevices pulses(host);
  HostProcesses processes;
  HostFiles files(host, "/no/folder");
  Program program({host, network, kernel, card, pulses, processes, files},
                  {.command = {"program"}, .link = link});
  std::vector<Task<void>> tasks;
  tasks.push_back(kernel.run());
  tasks.push_back(pulses.run());
  tasks.push_back(network.stamp_departures());
  tasks.push_back(network.answer_refused());
  tasks.push_back(serve(program, note));
  co_await simbench::join_all(std::move(tasks));
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const simbench::scenarios::Scenario kScenario = simbench::scenarios::load_scenario(
      "6host_star", {{"/hosts/count", "2"}, {"/cameras/count", "2"}});
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) return 0;
  while (size >= 2) {
    const std::size_t wanted = data[0] + 256U * data[1];
    const std::size_t length = wanted < size - 2 ? wanted : size - 2;
    if (send(ends[1], data + 2, length, MSG_DONTWAIT) < 0) break;
    data += 2 + length;
    size -= 2 + length;
  }
  shutdown(ends[1], SHUT_WR);
  std::string note;
  {
    ServiceWorld world(kScenario);
    world.spawn(run(world.host(1), ends[0], note));
    world.run_until(kWorldSeconds);
  }
  close(ends[1]);
  if (note.size() > 2000 || note.find('\n') != std::string::npos) std::abort();
  return 0;
}

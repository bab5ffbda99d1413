// simbench with two more algorithms: constant_delay for the stage device_time, and cristian
// for host_sync.
//
//   my_bench list                            shows them among simbench's own
//   my_bench my_rig.json                     prints their rows
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "algorithms/registry.h"
#include "cli/command_line.h"

namespace {

struct ConstantDelaySettings {
  simbench::Nanoseconds delay = simbench::from_ms(40);
  void bind(simbench::ParameterBinder& parameters) {
    parameters.number("delay_ms", delay, 0, 1000, "from exposure to arrival", "a guess");
  }
};

// A frame was exposed a fixed time before it arrived: no more than that.
class ConstantDelay : public simbench::DeviceTimeEstimator {
 public:
  explicit ConstantDelay(const ConstantDelaySettings& settings) : delay_(settings.delay) {}
  simbench::GlobalTime stamp(const simbench::DeviceSample& sample) override {
    return simbench::GlobalTime(sample.arrival.time_since_epoch() - delay_);
  }

 private:
  simbench::Nanoseconds delay_;
};

struct CristianSettings {
  int questions = 16;
  void bind(simbench::ParameterBinder& parameters) {
    parameters.number("questions", questions, 1, 1000, "how often a slave asks", "a guess");
  }
};

// A host_sync: Cristian's algorithm (Distributed Computing 3, 1989). A slave asks the master for
// the time some times, believes the answer of the shortest round trip, and sets its clock once, as
// if both ways of that had taken the same time.
class Cristian : public simbench::HostSync {
 public:
  explicit Cristian(CristianSettings settings) : questions_(settings.questions) {}

  simbench::Task<void> run_master(simbench::Host& host,
                                  std::vector<simbench::PeerId> slaves) override {
    for (const simbench::PeerId slave : slaves) {
      simbench::MessageChannel& channel = host.open_channel(slave, simbench::Transport::kStream);
      for (int i = 0; i < questions_; ++i) {
        std::optional<simbench::ReceivedMessage> question =
            co_await channel.receive(host.steady_clock().now() + simbench::kIdle);
        if (!question) co_return;
        const simbench::HostTime now = co_await host.clock().now();
        simbench::Bytes answer = bytes_of(now);
        co_await channel.send(std::move(answer));
      }
    }
  }

  simbench::Task<void> run_slave(simbench::Host& host, simbench::PeerId master) override {
    simbench::MessageChannel& channel = host.open_channel(master, simbench::Transport::kStream);
    simbench::Nanoseconds shortest = simbench::Nanoseconds::max();
    simbench::Nanoseconds behind{};
    for (int i = 0; i < questions_; ++i) {
      const simbench::HostTime asked = co_await host.clock().now();
      simbench::Bytes question(1);
      co_await channel.send(std::move(question));
      std::optional<simbench::ReceivedMessage> answer =
          co_await channel.receive(host.steady_clock().now() + simbench::kIdle);
      if (!answer) co_return;
      const simbench::Nanoseconds round_trip = answer->received - asked;
      if (round_trip >= shortest) continue;
      shortest = round_trip;
      behind = time_in(answer->bytes) - (asked + round_trip / 2);
    }
    const simbench::HostTime now = co_await host.clock().now();
    co_await host.clock().set(now + behind);
  }

 private:
  static simbench::Bytes bytes_of(simbench::HostTime time) {
    const simbench::Nanoseconds since = time.time_since_epoch();
    simbench::Bytes bytes(sizeof since);
    std::memcpy(bytes.data(), &since, sizeof since);
    return bytes;
  }
  static simbench::HostTime time_in(const simbench::Bytes& bytes) {
    simbench::Nanoseconds since{};
    std::memcpy(&since, bytes.data(), sizeof since);
    return simbench::HostTime(since);
  }

  int questions_;
};

}  // namespace

int main(int argc, char** argv) {
  simbench::register_algorithm(simbench::with_settings<simbench::DeviceTimeEntry>(
      {.name = "constant_delay",
       .family = "constant_delay",
       .summary = "arrival minus a constant",
       .source = "an example"},
      ConstantDelaySettings{}, simbench::kMake<ConstantDelay>));
  simbench::register_algorithm(simbench::with_settings<simbench::HostSyncEntry>(
      {.name = "cristian",
       .family = "cristian",
       .summary = "sets the clock once, by the fastest answer",
       .source = "Cristian 1989"},
      CristianSettings{}, simbench::kMake<Cristian>));
  return simbench::run_command_line(argc, argv);
}

// simbench with two more algorithms: constant_delay for the stage device_time, and cristian
// for host_sync.
//
//   my_bench list                            shows them among simbench's own
//   my_bench my_rig.json                     prints their rows
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/registry.h"
#include "cli/command_line.h"

namespace {

// A frame was exposed a fixed time before it arrived: no more than that.
class ConstantDelay : public simbench::DeviceTimeEstimator {
 public:
  explicit ConstantDelay(double delay_ms) : delay_(simbench::from_ms(delay_ms)) {}
  simbench::GlobalTime stamp(const simbench::DeviceSample& sample) override {
    return simbench::GlobalTime(sample.arrival.time_since_epoch() - delay_);
  }

 private:
  simbench::Nanoseconds delay_;
};

// A host_sync: Cristian's algorithm (Distributed Computing 3, 1989). A slave asks the master for
// the time some times, believes the answer of the shortest round trip, and sets its clock once, as
// if both ways of that had taken the same time.
class Cristian : public simbench::HostSync {
 public:
  explicit Cristian(int questions) : questions_(questions) {}

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

simbench::HostSyncEntry cristian() {
  return {.info = {.name = "cristian",
                   .family = "cristian",
                   .summary = "sets the clock once, by the fastest answer",
                   .source = "Cristian 1989",
                   .parameters = {{.name = "questions",
                                   .fallback = 16,
                                   .low = 1,
                                   .high = 1000,
                                   .choices = {},
                                   .meaning = "how often a slave asks",
                                   .source = "a guess"}}},
          .make = [](const simbench::Parameters& parameters) {
            return std::make_unique<Cristian>(static_cast<int>(parameters.number("questions")));
          }};
}

}  // namespace

int main(int argc, char** argv) {
  simbench::register_device_time({
      .info = {.name = "constant_delay",
               .family = "constant_delay",
               .summary = "arrival minus a constant",
               .source = "an example",
               .parameters = {{.name = "delay_ms",
                               .fallback = 40,
                               .low = 0,
                               .high = 1000,
                               .choices = {},
                               .meaning = "from exposure to arrival",
                               .source = "a guess"}}},
      .make =
          [](const simbench::Parameters& parameters) {
            return std::make_unique<ConstantDelay>(parameters.number("delay_ms"));
          },
  });
  simbench::register_host_sync(cristian());
  return simbench::run_command_line(argc, argv);
}

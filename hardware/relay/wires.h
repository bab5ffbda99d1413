// The programs' network in the real-network experiment: carries frames from wire to wire after the
// delay of the scenario's network, as the relay does with the nodes' own messages.
//
// Member i of a NetworkSandbox has the address 10.0.0.1 + i at the far end of "wire<i>" (hardware/
// experiment/network_sandbox.h). Each UDP datagram that it sends over IPv4 arrives at the member of
// its destination by a law of its own for the direction (network_law.h); one to a group or to all
// at every other member, by each one's law. Any program's ports and multicasts pass unchanged.
// ARP passes at once. Nothing else passes: no TCP, no IPv6, no fragments, no frames to other
// addresses. UDP checksums, which the sender leaves to its card, are left out.
//
// Delays count from the kernel's receive stamp. Bounded as the relay is. The queue must outlive
// this and not run after it. One thread.
//
// Errors: RelayError from the constructor: no such wire, or no right to open it.
//
//   Wires wires(context, queue, {.wires = {"wire0", "wire1"}, .scenario = &scenario, .seed = 1});
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hardware/relay/delay_queue.h"
#include "hardware/relay/network_law.h"

namespace simbench::hardware {

// Where a frame goes, as far as it is carried.
struct CarriedFrame {
  enum class Kind : std::uint8_t { kArp, kDatagram };
  Kind kind = Kind::kDatagram;
  std::optional<PeerId> to{};  // nothing: all others
};

// Nothing if a frame between `members` members is not carried. The checksum of a datagram that is
// carried is taken out.
std::optional<CarriedFrame> look_at_frame(std::span<std::byte> frame, std::size_t members);

class Wires {
 public:
  struct Settings {
    std::vector<std::string> wires;                 // interfaces, by member
    const scenarios::Scenario* scenario = nullptr;  // only the constructor reads it
    std::uint64_t seed = 1;
  };

  Wires(boost::asio::io_context& context, DelayQueue& queue, const Settings& settings);
  ~Wires();
  Wires(const Wires&) = delete;
  Wires& operator=(const Wires&) = delete;

  void stop();
  // The sums over all directions.
  LawCounts counts() const;
  // What found no room in the queue, or came too fast.
  std::uint64_t dropped() const;

 private:
  class State;
  std::shared_ptr<State> state_;
};

}  // namespace simbench::hardware

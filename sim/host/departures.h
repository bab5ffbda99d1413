// A host's end of the network, as what sends through it knows it: when its messages left the host.
//
// A software stamp is the system clock, on its ticks, when the message leaves the stack; a hardware
// stamp is the card's clock when its last bit passes the card. Stamps of the last 4096 messages are
// kept. One coroutine may wait for each kind of stamp at a time.
//
//   const MessageId id = co_await host.multicast().send(0xE0000181, Bytes(44));
//   const SteadyTime until = host.steady_clock().now() + kStampTimeout;
//   const std::optional<HostTime> left = co_await host.multicast().stamp(id, until);
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "algorithms/ports/host.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/message_stack.h"
#include "sim/network/network.h"

namespace simbench::sim {

class SimHost;

class Departures : protected Endpoint {
 public:
  // `host` must outlive this and this its network's events; `to` names where the messages go.
  Departures(SimHost& host, const std::string& to);

  // Nothing if the host does not stamp, the message did not leave until the deadline, or its stamp
  // is no longer kept.
  Task<std::optional<HostTime>> stamp(MessageId id, SteadyTime deadline);
  Task<std::optional<HardwareTime>> hardware_stamp(MessageId id, SteadyTime deadline);

 protected:
  // What the draws of a message of this end are keyed by.
  virtual MessageKey key_of_sent(MessageId id) const = 0;
  Nanoseconds to_card(MessageId first) final;
  // A message that was cancelled has left a gap before them.
  void on_left(MessageId first, std::size_t count, const HostDeparture& departure) final;

  SimHost& host_;

 private:
  struct Sent {
    bool has_left = false;  // false: the send was cancelled
    HostDeparture departure{};
  };

  bool has_left(MessageId id) const { return id < first_sent_ + sent_.size(); }
  // A message that has left; null if it never did or is no longer kept.
  const Sent* sent(MessageId id) const;
  // What is known of a part of a message's departure, while a coroutine waits for it.
  struct Search {
    MessageId id = 0;
    SteadyTime deadline{};
    TrueTime HostDeparture::*part = nullptr;
    std::optional<TrueTime> at{};  // when it is over, once that is known
    bool is_over = false;          // nothing more is to come; without `at` it did not leave in time
    std::optional<TrueTime> look{};  // when to look again; none: not before something has left
  };
  // Looks at what has left until now.
  void look(Search& search) const;
  // When to look again for what is over at `at`.
  TrueTime next_look(SteadyTime deadline, TrueTime at) const;

  bool stamps_in_kernel_;
  WaitPoint left_;
  WaitPoint passed_;
  MessageId first_sent_ = 0;  // the message of sent_.front()
  std::deque<Sent> sent_;
};

}  // namespace simbench::sim

// When the messages of a channel left the host: the stamps of their departure.
//
// A software stamp is the system clock, on its ticks, when the message leaves the stack; a hardware
// stamp is the card's clock when its last bit passes the card. Stamps of the last 4096 messages are
// kept. One coroutine may wait for each kind of stamp at a time.
//
//   Departures departures(host, "host1");
//   const TrueTime at_card(from_ms(5));
//   departures.on_left(7, 1, at_card);
//   const SteadyTime until = host.steady_clock().now() + kStampTimeout;
//   const std::optional<HostTime> stamp = co_await departures.stamp(7, until);
#ifndef SIMBENCH_SIM_HOST_DEPARTURES_H_
#define SIMBENCH_SIM_HOST_DEPARTURES_H_

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "algorithms/ports/host.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/message_stack.h"

namespace simbench::sim {

class SimHost;

class Departures {
 public:
  // `host` must outlive this; `to` names where the messages go.
  Departures(SimHost& host, const std::string& to);

  // Messages `first` to `first + count - 1` leave the stack now; their last bit passes the card at
  // `passed`. A message that was cancelled has left a gap before them.
  void on_left(MessageId first, std::size_t count, TrueTime passed);
  // Nothing if the host does not stamp, the message did not leave until the deadline, or its stamp
  // is no longer kept.
  Task<std::optional<HostTime>> stamp(MessageId id, SteadyTime deadline);
  // Its noise is drawn for the message of that key.
  Task<std::optional<HardwareTime>> hardware_stamp(MessageId id, MessageKey key,
                                                   SteadyTime deadline);

 private:
  struct Sent {
    bool has_left = false;  // false: the send was cancelled
    HostTime left{};        // the kernel's stamp
    TrueTime passed{};      // when its last bit passes the card
  };

  bool has_left(MessageId id) const { return id < first_sent_ + sent_.size(); }
  // A message that has left; null if it never did or is no longer kept.
  const Sent* sent(MessageId id) const;

  SimHost& host_;
  bool stamps_in_kernel_;
  WaitPoint left_;
  WaitPoint passed_;
  MessageId first_sent_ = 0;  // the message of sent_.front()
  std::deque<Sent> sent_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_HOST_DEPARTURES_H_

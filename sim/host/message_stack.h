// The way of a message through a host: between the calls of its program and its network card.
//
//   send call --transmit--> software stamp --transmit_to_card--> card, hardware stamp --> the wire
//   the wire --> card, hardware stamp --> interrupt --receive--> software stamp --wake_up--> return
//
// Each part takes a time by a law of its own (scenarios::DelayLaw): fixed + Exp or a table of
// quantiles, and rare spikes. A message's draw is keyed by (link, direction, transport, number of
// the message), so more messages change no other's numbers. A share of the law's normal score may
// be common to all that passes that part of the host, a process in true time: what is slow now is
// slow for the next message too.
//
// The interrupt comes with the message, unless
//  - the card moderates: interrupts are interrupt_moderation_us apart at least. The host's other
//    traffic causes interrupts too, as a Poisson process of rate r; as each blocks for T, a message
//    meets a blocked card with probability rT / (1 + rT) and then waits U(0, T);
//  - the processor sleeps: waking it takes sleep_exit_us. It would sleep for sleep_share of the
//    time, a process in true time, but stays awake for awake_us after each message of its own. A
//    client is therefore awake when the answer comes, while its server may have slept: an
//    asymmetry.
// Parts keep the order of messages: none overtakes another on the same host.
//
// One factor exp(N(0, speed_log_sigma)) per host scales all of it but the moderation.
//
// Under /hosts/cpu_load other programs keep every processor busy, which adds parts of its own to
// these. A host's program that has waited for cold_after_ms finds its code and data out of the
// caches: its next send call, or its return from a call that waits, is cold, and what it does
// within that time is warm. A client's request and a server's wake-up are cold, the server's answer
// and the client's wake-up for it warm: their difference does not average out.
//
// Under /hosts/io_load the kernel's work and wake-ups take longer still. Where /hosts/steal takes a
// virtual machine's processor away (steal.h), what would end meanwhile ends when it is back: the
// send call, the software stamps and the wake-up, but not the card's part.
//
// Without /hosts/stack nothing of that takes time. Not modelled: which processor core serves,
// batches that share one pass (NAPI), and the stack's own queue under overload.
//
// Source: docs/reference/host_sync.md section 4; scenario /hosts/stack, /hosts/cpu_load,
// /hosts/io_load and /hosts/steal. Cost:
// some 100 ns a message.
//
//   MessageStack stack(scenario.hosts, seed, 3);
//   const Nanoseconds in_the_call = stack.transmit(now, {direction, id});
//   const Nanoseconds to_card = stack.to_card(left, {direction, id});
//   const TrueTime stamped = stack.receive(at_card, {direction, id});
//   const TrueTime returns = stamped + stack.wake_up(stamped, {direction, id});
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "algorithms/ports/exchange.h"
#include "laws/quantile_table.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/normal_process.h"
#include "sim/engine/random.h"
#include "sim/host/steal.h"

namespace simbench::sim {

// Tells messages apart: direction_of(from, to) and the key of the message on it.
struct MessageKey {
  std::uint64_t direction = 0;
  std::uint64_t message = 0;
};

// The streams of a component's messages, which remember a host's usual directions.
class MessageStreams {
 public:
  MessageStreams(std::uint64_t run_seed, ComponentKey component) : all_(run_seed, component) {}

  RandomStream of(const MessageKey& key) {
    Known& known = known_[(key.direction ^ (key.direction >> 32)) % known_.size()];
    if (known.direction != key.direction) known = {key.direction, all_.of(key.direction)};
    return known.streams.stream(key.message);
  }

 private:
  struct Known {
    std::uint64_t direction = ~std::uint64_t{0};  // nobody's
    KeyedStreams streams{0, ComponentKey("")};
  };
  KeyedStreams all_;
  std::array<Known, 8> known_;
};

// One part of the way.
class DelayProcess {
 public:
  // `law` must outlive this. `name` tells the parts apart, `factor` scales every delay.
  DelayProcess(const scenarios::DelayLaw& law, std::uint64_t run_seed, ComponentKey name,
               PeerId host, double factor);

  // The delay of a message that begins this part at `at`.
  Nanoseconds draw(TrueTime at, const MessageKey& key);

 private:
  // The quantile that the message meets, in (0, 1).
  double quantile(TrueTime at, RandomStream& draw);

  const scenarios::DelayLaw* law_;
  MessageStreams draws_;
  double factor_;
  QuantileTable table_us_;
  std::optional<NormalProcess> common_;
  double common_weight_ = 0;  // in the score of a message, and its own
  double own_weight_ = 1;
};

class MessageStack {
 public:
  // `hosts` must outlive the stack.
  MessageStack(const scenarios::Hosts& hosts, std::uint64_t run_seed, PeerId host);

  // CPU time of a send call that begins at `at`, beside the scenario's send cost.
  Nanoseconds transmit(TrueTime at, const MessageKey& key);
  // From the software transmit stamp at `left` to the card. In order of the calls.
  Nanoseconds to_card(TrueTime left, const MessageKey& key);
  // The software stamp of a message that reached the card at `at`. In order of the calls.
  TrueTime receive(TrueTime at, const MessageKey& key);
  // From the software stamp to the return of a receiver that waits.
  Nanoseconds wake_up(TrueTime stamped, const MessageKey& key);
  // The host's program does something at `at`: it is warm for a while.
  void works(TrueTime at);

 private:
  // What the load of the processors adds.
  struct LoadParts {
    LoadParts(const scenarios::CpuLoad& stated, std::uint64_t run_seed, PeerId host, double factor);
    Nanoseconds cold_after;
    DelayProcess cold_transmit;
    DelayProcess cold_wake_up;
    DelayProcess wake_up;
    DelayProcess receive;
    TrueTime warm_until = TrueTime::min();
  };

  // What the load of the disks adds.
  struct IoParts {
    IoParts(const scenarios::IoLoad& stated, std::uint64_t run_seed, PeerId host);
    DelayProcess receive;
    DelayProcess wake_up;
  };

  struct Parts {
    Parts(const scenarios::Stack& stated, std::uint64_t run_seed, PeerId host, double factor);
    const scenarios::Stack& stated;
    double factor;
    DelayProcess transmit;
    DelayProcess to_card;
    DelayProcess receive;
    DelayProcess wake_up;
    NormalProcess sleepiness;
    TrueTime last_at_card = TrueTime::min();
    TrueTime last_interrupt = TrueTime::min();
    TrueTime last_stamp = TrueTime::min();
    TrueTime awake_until = TrueTime::min();
  };

  // When the card interrupts for a message.
  TrueTime interrupt(TrueTime at, const MessageKey& key);
  bool sleeps(TrueTime at);
  void stay_awake(TrueTime from);

  MessageStreams moderation_;
  bool is_cold(TrueTime at) const { return at >= load_->warm_until; }

  std::optional<Parts> parts_;     // nothing without /hosts/stack
  std::optional<LoadParts> load_;  // nothing without /hosts/cpu_load
  std::optional<IoParts> io_;      // without /hosts/io_load
  std::optional<StolenTime> stolen_;
};

}  // namespace simbench::sim

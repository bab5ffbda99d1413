// Saturating TCP between the messages of the synchronisation: the queues that it keeps in ports.
//
// Problem: a bulk transfer sends until a buffer overflows, so that a message waits behind hundreds
// of frames. How long depends on windows that grow and are cut, for hours. Naive: to simulate each
// frame. At 1 Gbit/s that is 81,000 frames and some 250,000 events a second and connection, for a
// handful of messages between them.
//
// Here windows are real numbers and queues follow them at once (quasi-static). Given the windows,
// the delays of all ports are those with which every connection has its window in flight,
//
//    rate_f * (round trip without queues + delays on the ways of its data and its acknowledgements)
//        = window_f,
//
// no port carries more than it can, and a port that carries less has no queue (a convex problem
// with one solution; F. Kelly and R. Williams, "Fluid model for a network operating under a fair
// bandwidth-sharing policy", Annals of Applied Probability 14, 2004). Ports are solved upstream
// first, so a lone connection queues in its own host.
//
//  - A connection has at most `connection_bytes` in its own host (TCP small queues). Its window
//  does
//    not grow while this holds it back.
//  - Windows grow as CUBIC (RFC 9438: C = 0.4, beta = 0.7, fast convergence, the Reno-friendly
//    region with 0.53 segments per round trip for good, as in Linux) or Reno (RFC 5681 with one
//    segment per round trip), from slow start.
//  - A switch port whose queue has reached its buffer drops as many frames as there are too many,
//    mostly of connections whose window has just grown by a whole segment, and of links as they
//    collide with others. The loser knows a round trip later, and its window falls to 0.7 or 0.5 of
//    what it was within another one (RFC 6937).
//  - A port that pauses its senders (802.3x) drops nothing: its queue stays full, and what is too
//    much waits in their hosts, with all else that they send, until TCP small queues hold it back.
//  - Where connections also wait in other queues, the number of their frames in one fluctuates, and
//    it overflows at a lower mean.
//  - Acknowledgements wait where data do, and take 84 bytes on the line for two segments.
//
// Four constants (who loses, when a port overflows) are a fit to the packet reference.
//
// Left out: timeouts (a connection keeps two segments in flight, where real ones of few segments
// pause for 200 ms while the others fill the queue as well), HyStart, pacing, and the bursts of
// segmentation offload, which fill a port for some frames more or less.
//
// Contract: the model steps on a grid of its own, which no query changes; queries nearly in order
// of time, at most kHistory steps (each a quarter of a round trip at least) behind the newest, else
// they are given the oldest that is known. No allocation after construction.
// Source: tests/sim/traffic/tcp_fluid_slow_test.cc compares it with each packet simulated.
//
//   TcpFluid fluid({{.bytes_per_ns = 0.125}, {.bytes_per_ns = 0.125, .buffer_bytes = 128e3}},
//                  {{.data_ports = {0, 1}, .base_round_trip = from_ms(0.1)}}, {}, seed);
//   const Nanoseconds wait = fluid.delay(1, now);
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/random.h"

namespace simbench::sim {

// A full frame with preamble and gap, an acknowledgement likewise, and the payload of a frame.
inline constexpr double kFullFrameBytes = 1538;
inline constexpr double kAckFrameBytes = 84;
inline constexpr double kSegmentBytes = 1448;

struct FluidPort {
  double bytes_per_ns = 0;
  double buffer_bytes = 0;  // 0: a host's own port, which drops nothing
  bool pauses = false;      // its senders when its buffer is full, in place of dropping
};

struct FluidConnection {
  std::vector<std::size_t> data_ports;  // the own host's, trunks, that to the receiver
  std::vector<std::size_t> ack_ports{};
  scenarios::CongestionControl congestion = scenarios::CongestionControl::kCubic;
  double connection_bytes = 128'000;  // in the own host at most
  Nanoseconds base_round_trip{0};     // without queues
  TrueTime begin{};
  TrueTime end = TrueTime::max();
};

// What other traffic takes of a port.
struct FluidShare {
  std::size_t port = 0;
  double share = 0;
  TrueTime begin{};
  TrueTime end = TrueTime::max();
};

class TcpFluid {
 public:
  static constexpr std::size_t kHistory = 1024;

  // Ports are solved in the order of their numbers: those upstream first.
  TcpFluid(std::vector<FluidPort> ports, std::vector<FluidConnection> connections,
           std::vector<FluidShare> others, std::uint64_t run_seed);

  // How long what comes to the port then waits.
  Nanoseconds delay(std::size_t port, TrueTime at);
  // The share of what comes to the port that is dropped then.
  double loss_share(std::size_t port, TrueTime at);

  // The number of steps until now, for measurements of speed.
  std::uint64_t steps() const { return step_count_; }

 private:
  enum class Phase : std::uint8_t { kIdle, kSlowStart, kOpen, kLost, kRecovering };

  struct Flow {
    double base_ns = 0;
    double limit_segments = 0;  // in the own host
    std::size_t own_port = 0;
    bool is_cubic = true;
    double begin_ns = 0;
    double end_ns = 0;
    Phase phase = Phase::kIdle;
    double window = 0;  // segments
    double in_flight = 0;
    double lost = 0;
    double lost_while_recovering = 0;
    double knows_ns = 0;        // of its loss
    double recovered_ns = 0;    // from knows_ns on
    double knows_later_ns = 0;  // of a loss while it recovers
    double round_trip_ns = 0;
    double per_ns = 0;     // its rate in segments
    double paused_ns = 0;  // what it waits in its host for ports that pause it
    double growth_per_ns = 0;
    bool has_grown = false;  // by a whole segment
    bool is_held_back = false;
    double window_max = 0;
    double friendly_window = 0;
    double k_s = 0;
    double epoch_ns = 0;
  };
  // A connection on a port.
  struct Passer {
    std::size_t flow = 0;
    double weight = 1;       // of its rate there
    bool is_own = false;     // the port of its own host
    std::size_t feeder = 0;  // the port before
  };
  struct Queue {
    std::vector<Passer> passers;
    bool can_queue = true;
    double line_per_ns = 0;  // full frames
    double free_per_ns = 0;  // what others leave
    double full_ns = 0;      // 0: never
    bool pauses = false;     // its senders when it is full
    double delay_ns = 0;     // with what waits in paused senders
    double loss_share = 0;

    // What waits in paused senders.
    double paused_ns() const { return pauses ? std::max(0.0, delay_ns - full_ns) : 0; }
    std::size_t last_loser = 0;
  };

  void add_flow(const FluidConnection& connection);
  void find_queues_that_can_be();
  // The newest step at or before `at`, and how far it is to the next.
  struct Place {
    std::size_t row = 0;
    double share_of_next = 0;
  };
  Place place(TrueTime at);
  std::size_t cell(std::uint64_t step, std::size_t port) const {
    return static_cast<std::size_t>(step % kHistory) * queues_.size() + port;
  }

  void step();
  double step_length_ns() const;
  void change_activity();
  void advance(Flow& flow, double length_ns);
  void advance_loss(Flow& flow);
  void grow(Flow& flow, double length_ns);
  void begin_epoch(Flow& flow);
  void solve(int most_sweeps);
  // What may be in the own hosts holds the connections back.
  void hold_back();
  double solve_queue(std::size_t port);
  double overflow_ns(const Queue& queue) const;
  void drop(std::size_t port, double length_ns);
  std::size_t loser(const Queue& queue);
  void lose(Flow& flow);
  // What a message meets at the port.
  double wait_ns(std::size_t port) const;
  void keep();

  std::vector<Queue> queues_;
  std::vector<Flow> flows_;
  std::vector<FluidShare> others_;
  std::vector<std::pair<std::size_t, std::size_t>> feeds_;  // from port to port
  std::vector<double> changes_ns_;                          // of what is active, ascending
  std::size_t next_change_ = 0;
  RandomStream draws_;
  std::vector<double> fed_per_ns_;  // by feeder
  double now_ns_ = 0;
  std::uint64_t step_count_ = 0;
  std::vector<double> times_ns_;  // of the steps in the history, rings
  std::vector<double> delays_ns_;
  std::vector<double> loss_shares_;
};

}  // namespace simbench::sim

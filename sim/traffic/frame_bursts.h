// Paced streams and random bursts: how long a message waits behind their frames.
//
// Problem: at 900 Mbit/s a message of the synchronisation finds a full frame on the line nine times
// in ten, and behind bursts of 64 kB it waits for half a millisecond. Naive: every frame is an
// event. That costs a hundred thousand events a second for ten messages. A stationary law drawn for
// each message (M/D/1) costs nothing, but two messages in a row do not see the same burst, and
// paced traffic has no such law.
//
// Here the bursts are a process in true time. Those of a paced stream begin at even spaces with a
// random phase; those of a random stream are sampled in cells of true time that have random numbers
// of their own, so that only cells before a message are ever made. The wait of what comes at t is
// the work that its port has left just before t, by Lindley's recursion over the frames that came
// in a window before t (D. V. Lindley, "The theory of queues with a single server", Mathematical
// Proceedings of the Cambridge Philosophical Society 48, 1952).
//
//  - A burst enters its host's queue at once. Frames leave the host one by one at the line's rate,
//    behind those of the host's other streams, and come to the next port when their last bit is
//    out: to trunks, in the order of the way, and to the port of the receiver. A short message
//    directly behind a frame of its own host therefore waits at the switch for a full frame less
//    its own length.
//  - A switch port drops a frame for which its buffer has no room.
//  - Windows: what a port had queued before its window is served while it is idle in the window. A
//    window is doubled until its idle time is as long as the port's queue can get: a burst of each
//    paced stream, and with random ones twice the largest burst and seven mean ones over the idle
//    share, the point that the queue passes once in some million times (exp(-14) for M/D/1); a
//    switch's port at most its buffer, and then the wait is exact. A window ends at kMostFrames
//    frames, which loads above 0.98 or so need; what was queued before that counts as gone.
//  - Asked to carry more than they can, ports are full, and hosts keep at most a second of traffic.
//
// Contract: what is asked changes nothing; the same seed gives the same waits in any order of
// queries. Messages do not delay the frames. Streams are those of Traffic that are not TCP.
// Cost: some 10 ns for each frame in the window; no allocation in steady state.
//
//   FrameBursts bursts(0.125, {{.kind = scenarios::TrafficKind::kPaced, .ports = {0, 1},
//                               .bytes_per_ns = 0.1}}, {0, 128e3}, seed);
//   const Nanoseconds wait = bursts.wait(1, now);
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recording/true_time.h"
#include "scenarios/scenario.h"

namespace simbench::sim {

struct BurstStream {
  scenarios::TrafficKind kind = scenarios::TrafficKind::kPaced;
  std::vector<std::size_t> ports;  // its host's, trunks, that to the receiver
  double bytes_per_ns = 0;         // mean on the line
  double burst_frames = 1;         // paced: each burst, rounded up; random: the least
  double tail_exponent = 1.5;      // random
  TrueTime begin{};
  TrueTime end = TrueTime::max();
};

class FrameBursts {
 public:
  static constexpr std::size_t kMostFrames = 8192;
  static constexpr double kLargestPerLeast = 1000;

  // Every port carries `line_bytes_per_ns`; ports with a buffer of 0 are hosts'.
  FrameBursts(double line_bytes_per_ns, std::vector<BurstStream> streams,
              std::vector<double> buffer_bytes, std::uint64_t run_seed);

  // How long what comes to the port then waits.
  Nanoseconds wait(std::size_t port, TrueTime at);
  // The share that the port cannot carry of what streams that are active then bring to it.
  double overload_share(std::size_t port, TrueTime at) const;
  // The share lost while all streams are active together.
  double overload_share(std::size_t port) const;

 private:
  struct Burst {
    std::int64_t begin_ns = 0;
    double frames = 0;
  };
  struct Cell {
    std::int64_t number = 0;
    bool is_made = false;
    std::vector<Burst> bursts;
  };
  struct Stream {
    BurstStream parameters;
    std::uint64_t number = 0;
    double gap_ns = 0;          // between begins, mean
    double phase_ns = 0;        // paced
    double frames = 1;          // paced: of each burst
    double largest_frames = 1;  // but for one burst in a million
    std::int64_t cell_ns = 0;
    std::vector<Cell> cells;  // random: a ring of those made last
  };
  // Times are before the query (so below 0), in ns.
  struct HostBurst {
    double begin_ns = 0;
    double frames = 0;
    std::size_t stream = 0;
  };
  struct Frame {
    double at_ns = 0;  // its last bit
    std::size_t stream = 0;
  };
  struct BurstPort {
    double buffer_ns = 0;  // 0: a host's
    double load = 0;
    double paced_frames = 0;    // a burst of each paced stream
    double largest_frames = 0;  // of random bursts: the largest, and the mean of the largest kind
    double mean_frames = 0;
    std::vector<std::size_t> streams;
    std::vector<std::size_t> feeders;  // ports before it
    std::vector<HostBurst> bursts;     // reused
    std::vector<Frame> frames;         // reused
  };

  void add_stream(const BurstStream& parameters, std::uint64_t run_seed);
  static double free_share(const BurstPort& port);
  // What a port has queued at most, but for one time in some million.
  double most_work_ns(const BurstPort& port) const;
  double host_work(std::size_t port, std::int64_t at_ns, double frames_from_ns);
  double host_window(BurstPort& port, std::int64_t at_ns, double window_ns, double& idle_ns);
  double switch_work(std::size_t port, std::int64_t at_ns, double window_ns, double& idle_ns);
  void pass_frames(BurstPort& port, double& free_ns, double& idle_ns);
  void append_bursts(Stream& stream, std::size_t index, std::int64_t at_ns, double window_ns,
                     std::vector<HostBurst>& bursts);
  const Cell& cell(Stream& stream, std::int64_t number) const;
  void append_frames(std::size_t from, std::size_t to, std::vector<Frame>& frames) const;
  bool goes(std::size_t stream, std::size_t from, std::size_t to) const;

  double line_bytes_per_ns_;
  double frame_ns_;
  std::uint64_t run_seed_;
  std::vector<Stream> streams_;
  std::vector<BurstPort> ports_;
};

}  // namespace simbench::sim

// Algorithms 1 and 2 of Yoon et al. 2021: the master measures delays with each slave in turn and
// has it set its system clock to the master's time plus those delays.
//
// One pass of a session (docs/reference/paper.md section 4):
//
//   master                               slave
//   READY                          --->
//   n_d x STAMP(clock)             --->  t_l = mean of (toc - tic) around each receive
//                                        t_t = sum over n_c x set(get()) / (2 n_c)
//                                  <---  MEASURED
//   T_m = clock; SET_TIME(T_m)     --->  set(T_m + t_d)
//   T_r = clock on receipt         <---  SLAVE_TIME(T_s = clock)
//   delay = max(T_r - T_m, T_r - T_s)
//
// Passes repeat while delay > T_th; then SUCCESS ends the session. The four algorithms differ in
// t_d alone (all run both measurements, so that they send the same messages; a scenario may still
// draw the load of each pipeline on its own, sim/network/load.h):
// yoon2021_network t_l, yoon2021_time t_t, yoon2021_both t_l + t_t, yoon2021_neither 0.
//
// Defects of the algorithm that are kept (numbers as in docs/reference/paper.md section 4):
//   1. the receives are back to back, so t_l telescopes to the mean spacing of the stamps at the
//      receiver: the sender's occupancy per stamp; the latency cancels ("literal");
//   2. the test never bounds a lead: a slave that is ahead makes T_r - T_s smaller;
//   5. n_d, n_c, T_th and the transport are not published: the parameters' defaults are a fit;
//   6. set(get()) really steps the slave's clock back by part of the call, each time;
//   7. t_t is half of get and set, which need not be the part that matters;
//   8. no rate is estimated: the error grows with the time since the session.
//
// Repairs, without which it cannot run:
//   3. a T_th below the minimum round trip never ends: pass_limit, then GIVE_UP and an outcome that
//      names the smallest round trip seen;
//   4. the printed last message is "ready", which would start another pass: it is SUCCESS;
//   -  every receive has a time limit, so a dead peer or a lost datagram ends the pass, and
//      kSilentPassLimit such passes in a row end the session. Algorithm 2 counts n_d receives: one
//      lost stamp, or one that overtakes READY, loses the pass; a duplicate counts as a stamp. On a
//      network that loses or reorders use the stream.
//
// Latency estimate "intended": the paper describes t_l as "the average time taken for the
// transmission of n_d data packets". One-way times cannot be measured between clocks that are not
// yet set, so the slave requests each stamp (REQUEST) and t_l is half the mean round trip on its
// own steady clock:
//
//   n_d times:  tic = steady; send REQUEST; receive STAMP; toc = steady;  t_l += (toc - tic) / 2
//
// This adds one message per stamp and needs no other clock. Nothing telescopes: what remains is
// half of the difference between the two directions (latency, send occupancy, wake-up), which no
// two-way protocol can measure.
//
// Time limits count from the peer's last message, on the steady clock. The slave's coroutine ends
// on SUCCESS or GIVE_UP, or when the master has been silent for kSlavePatience silence limits.
// run_master returns when every slave's outcome has been reported; it reports an exchange a pass
// with t1 = T_m, t3 = T_s, t4 = T_r (t2 does not exist here). The slave reports t_l, t_t, t_d and
// the mean durations of its gets and sets once a pass, after SLAVE_TIME has left, so that reporting
// delays no message (Host::report_delays). The steady clock is read once more between each get and
// set for that, which takes a real host tens of nanoseconds.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithms/parameter_binder.h"
#include "algorithms/ports/host_sync.h"

namespace simbench {

struct Yoon2021Settings {
  bool add_network_delay = true;         // t_l is part of t_d
  bool add_time_delay = true;            // t_t is part of t_d
  std::uint32_t stamps = 100;            // n_d
  std::uint32_t clock_calls = 100;       // n_c
  Nanoseconds threshold = from_ms(100);  // T_th
  // Pace of the stamps. Literal: stamp i leaves no sooner than i + 1 intervals after READY.
  // Intended: the slave pauses that long before each request.
  Nanoseconds send_interval{0};
  std::uint32_t pass_limit = 200;
  Nanoseconds session_gap = from_ms(1000);  // pause between the sessions of a group
  std::uint32_t parallel_sessions = 1;      // groups the slaves are dealt into
  bool ask_for_stamps = false;              // latency estimate "intended"
  Transport transport = Transport::kStream;
  Nanoseconds receive_timeout = from_ms(5000);  // must cover the slave's n_c clock calls
  Nanoseconds turn_timeout = from_ms(86.4e6);   // how long a slave waits for its first READY

  void bind(ParameterBinder& parameters);
};

// How long a side waits for the other's next message before the other counts as silent.
constexpr Nanoseconds silence_limit(const Yoon2021Settings& settings) {
  return settings.receive_timeout + settings.send_interval;
}

class Yoon2021 : public HostSync {
 public:
  // Passes without an answer, in a row, after which a slave counts as unreachable.
  static constexpr std::uint32_t kSilentPassLimit = 5;
  // How many silence limits a slave waits for its master within a session.
  static constexpr int kSlavePatience = 4;

  explicit Yoon2021(Yoon2021Settings settings) : settings_(settings) {}
  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override;
  Task<void> run_slave(Host& host, PeerId master) override;

 private:
  Yoon2021Settings settings_;
};

}  // namespace simbench

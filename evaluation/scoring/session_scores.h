// The delays of the sessions of Algorithms 1 and 2, as the recording has them: what each slave
// measured and added in the last pass of its session (SessionDelays), and what its messages took.
//
// The paper explains the order of its rows by these: it says that sending and receiving take longer
// than reading and setting the clock (Yoon et al. 2021, section 4.2, claim C11 of claims.h). t_l
// and t_t are the program's own estimates of the two, with their defects (docs/reference/paper.md
// section 4). The duration of a message needs no estimate: the master's T_r - T_m of the last pass
// has two messages, a set and a get of the slave, whose mean durations the slave reports, so
//
//   message = (T_r - T_m - set - get) / 2
//
// from before a message is sent until its receiver has it, the sender's occupancy and the wake-up
// included: the mean of both directions. It needs neither truth nor equal clocks. Up to half of the
// master's own get of T_m is in it, and it is as coarse as the master's clock, whose steps (1 ms in
// the fitted worlds) cancel in the mean over slaves.
//
// A seed has the means over the slaves that reported a pass; NaN without any. Memory: per host.
//
//   SessionScores sessions(/*hosts=*/6);
//   sessions.add(event);
//   sessions.add_to(seed_score);
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "evaluation/scoring/results.h"
#include "recording/recording.h"

namespace simbench::evaluation {

class SessionScores {
 public:
  explicit SessionScores(std::size_t hosts) : slaves_(hosts) {}

  // Delays and the master's exchanges; other events change nothing.
  void add(const RecordingEvent& event);
  // Sets `sessions` and the values from t_l_ms to message_time_ms.
  void add_to(SeedScore& score) const;

 private:
  struct Slave {
    std::optional<SessionDelays> last;
    double round_trip_ms = kNan;  // T_r - T_m of the newest exchange
  };
  std::vector<Slave> slaves_;  // by host
};

}  // namespace simbench::evaluation

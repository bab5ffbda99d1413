// What a host synchronisation reports: its exchanges, the delays that a slave measured and added,
// and how each slave's session ended; and what a capture alignment does.
//
// A recording holds the exchanges (Host::report_exchange), so that other estimators can be run on
// them afterwards. Stamps that an algorithm does not have are absent.
//
// Convention (RFC 5905 section 8): t1 leaves the client, t2 reaches the server, t3 leaves the
// server, t4 reaches the client; t1 and t4 on the client's clock, t2 and t3 on the server's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "algorithms/ports/time.h"

namespace simbench {

using PeerId = std::uint32_t;  // a host of the rig, by index; 0 is the master

struct Exchange {
  PeerId peer = 0;
  std::optional<HostTime> t1{};
  std::optional<HostTime> t2{};
  std::optional<HostTime> t3{};
  std::optional<HostTime> t4{};
  // A stamp among them is no reading of the system clock that encloses the message's way: a card's
  // that was translated, a reading that was predicted from others, a departure that was read after
  // the send call. Good for estimates; a proof needs to know how far it may be off.
  bool is_estimated = false;
};

// What a slave measured in one pass of a session of Algorithms 1 and 2 (host_sync/yoon2021/), and
// what it added to the master's time. The last pass of a session is the one that counts.
struct SessionDelays {
  PeerId slave = 0;
  std::uint32_t pass = 0;  // of the loop of T_th, from 1
  SteadyTime begin{};      // the slave, which measures on its steady clock, has READY
  SteadyTime end{};        // it has set its clock to T_m + t_d
  Nanoseconds t_l{0};      // network synchronisation delay
  Nanoseconds t_t{0};      // time synchronisation delay: half of a get and a set
  Nanoseconds t_d{0};      // what it added
  Nanoseconds get{0};      // mean duration of a call that reads the system clock
  Nanoseconds set{0};      // and of one that sets it
};

// How the synchronisation of one slave ended.
struct SyncOutcome {
  PeerId slave = 0;
  bool synchronised = false;
  std::uint32_t passes = 0;
  std::string message;  // empty, or why it failed and what would help
};

// A real program of a host (host_sync by programs, docs/your_program.md) ended before its work was
// done. From then on the host's clock is its own, so no number of the run is the program's.
struct ProgramFailure {
  PeerId host = 0;
  std::string program{};     // "chronyd"
  Nanoseconds at{0};         // true time since the run began
  std::string how{};         // "exited with status 1"
  std::string last_words{};  // the last line of its output; empty: it said nothing
  std::string log{};         // the file that has its output; empty: nobody kept it
};

// What a capture alignment thinks it has reached with a camera (capture_alignment.h). The newest
// report of a camera counts.
struct AlignmentReport {
  std::uint32_t camera = 0;
  bool aligned = false;
  std::uint32_t controls = 0;  // that were sent to it until now
  std::string message{};       // empty, or why it is not aligned and what would help
};

}  // namespace simbench

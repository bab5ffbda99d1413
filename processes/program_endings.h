// What it means for a host that its real programs end.
//
//   a program ends by itself, and not with status 0   the host has failed, whatever else runs
//   with status 0, and others of the host still run   nothing: a helper has done its work
//   with status 0, the last of a slave's              it has done its work if the clock was set or
//                                                     steered until then, by any of them (a
//                                                     one-shot client, `chronyd -q`); else the
//                                                     host has failed, and that says so
//   with status 0, the last of the master's           no failure: a master need not set its clock.
//                                                     A note says that nobody serves from then on
//
// A host fails once, by the first of its programs. One that has done its work is synchronised from
// then on, though its clock is its own again.
//
//   ProgramEndings endings(host, /*programs=*/2);
//   endings.add({.program = "chronyd", .how = "exited with status 1", .status = 1},
//               {.at = from_ms(250), .log = "logs/0_chronyd.log"}, /*clock_was_set=*/false);
//   for (const std::string& note : endings.notes()) print(note);
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/ports/host.h"
#include "processes/child.h"

namespace simbench::processes {

// When a program ended, since the run began, and the file that has its output; empty: none.
struct EndPlace {
  Nanoseconds at{0};
  std::string log{};
};

class ProgramEndings {
 public:
  // Reports to the host, which must outlive this. `programs`: how many of them run.
  ProgramEndings(Host& host, std::size_t programs) : host_(host), running_(programs) {}

  // Another one has ended by itself.
  void add(ProgramEnd end, const EndPlace& place, bool clock_was_set);
  // What the run should say besides, a line each.
  const std::vector<std::string>& notes() const { return notes_; }
  // The host's failure, if it has failed.
  const std::optional<ProgramFailure>& failure() const { return failure_; }

 private:
  void fail(const ProgramEnd& end, const EndPlace& place);

  Host& host_;
  std::size_t running_;
  std::optional<ProgramFailure> failure_;
  std::vector<std::string> notes_;
};

}  // namespace simbench::processes

// The nodes' journals, joined to one recording.
//
// A HostJournal takes a journal's text as it is fetched, in pieces that may end anywhere, and turns
// whole lines into events. play_in_order() hands the events of all hosts to a sink: frames in order
// of arrival on their hosts' system clocks, which are synchronised. The order of each host is kept,
// even where its clock is stepped back; other events come as early as that order allows.
//
// A line that is no event is counted and left out (damaged()). Memory: the events. Complexity of
// the merge: n log h.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "recording/event.h"

namespace simbench::hardware {

class HostJournal {
 public:
  void append(std::string_view text);

  std::uint64_t bytes() const { return bytes_; }  // taken so far: the next offset to fetch
  const std::vector<KeptEvent>& events() const { return events_; }
  const std::vector<std::string>& notes() const { return notes_; }
  std::uint64_t damaged() const { return damaged_; }
  std::uint64_t frames() const { return frames_; }

  // How many periods a camera's stream has covered, by its frame counters: from its first frame to
  // its last; one whose counter restarts goes on from there. 0: no frame.
  std::int64_t covered(std::uint32_t camera, StreamKind stream) const;

 private:
  struct Counters {
    std::uint32_t last = 0;
    std::int64_t covered = 0;
  };

  void take(std::string_view line);

  std::string rest_;  // the beginning of a line
  std::uint64_t bytes_ = 0;
  std::vector<KeptEvent> events_;
  std::vector<std::string> notes_;
  std::uint64_t damaged_ = 0;
  std::uint64_t frames_ = 0;
  std::map<std::pair<std::uint32_t, StreamKind>, Counters> counters_;
};

void play_in_order(const std::vector<HostJournal>& journals, RecordingSink& sink);

}  // namespace simbench::hardware

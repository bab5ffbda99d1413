// A command of the user's that hears of events: a mail, a lamp, a restart.
//
// It is run by the shell, once for each event, one after another, with the event as a line of JSON
// in SIMBENCH_EVENT and its kind, subject and text in SIMBENCH_EVENT_KIND, _SUBJECT and _TEXT. It
// never holds up the watch: what waits beyond kMostWaiting events is dropped and counted.
//
//   Hook hook("logger \"$SIMBENCH_EVENT_TEXT\"");
//   hook.tell(event);
//   hook.look();          // starts the next one, if the last has ended
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

#include "watch/watch_event.h"

namespace simbench::watch {

inline constexpr std::size_t kMostWaiting = 100;

class Hook {
 public:
  // Empty: nothing is run.
  explicit Hook(std::string command);
  ~Hook();
  Hook(const Hook&) = delete;
  Hook& operator=(const Hook&) = delete;

  void tell(const WatchEvent& event);
  void look();
  // Waits until all have ended.
  void finish();

  std::uint64_t failed() const { return failed_; }    // that ended with another status than 0
  std::uint64_t dropped() const { return dropped_; }  // events

 private:
  void start(const WatchEvent& event);

  std::string command_;
  std::deque<WatchEvent> waiting_;
  pid_t running_ = 0;
  std::uint64_t failed_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace simbench::watch

// What a watch says, as it happens: something is wrong from here on, or is over.
//
// JSON, a line each, with the time of the machine beside that of the data:
//   {"event": "slipped", "subject": "camera front", "at_s": 1234.5, "alarm": true, "text": "..."}
//
// Kinds: those of rig_watch.h and clock_watch.h; "beyond_limit" of a clock that is judged by
// masks; "stands_still", "gone" and "unreadable" of a file.
// An event that is no alarm closes the alarm of the same kind and subject, if one is open.
#pragma once

#include <string>

#include "reports/text/json_node.h"

namespace simbench::watch {

struct WatchEvent {
  std::string kind{};
  std::string subject{};  // "camera front", "clock of hostA", "/var/log/rig.csv"
  double at_s = 0;        // of the data's own time
  bool is_alarm = true;   // false: it is over
  std::string text{};     // a sentence without its point
};

inline reports::Json event_json(const WatchEvent& event) {
  return {{"event", event.kind},
          {"subject", event.subject},
          {"at_s", event.at_s},
          {"alarm", event.is_alarm},
          {"text", event.text}};
}

}  // namespace simbench::watch

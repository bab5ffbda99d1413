// All that is watched, and what is said of it: alarms with since when, cameras, clocks.
//
// A monitor asks its sources (grown_stamps.h) when it is told to, feeds RigWatch and ClockWatch,
// and keeps which alarms are open. An alarm that nothing closes (a slip, a step) stays open for
// kRecentS. A source that does not grow for kStallS, vanishes, or cannot be read is an alarm, too;
// these alone need the time of the machine, which poll() is told.
//
// The snapshot is all that a view needs; the terminal, the page and the metrics show the same:
//
//   {"status": "alarm" | "in order" | "nothing yet", "text", "since_s", "now_s", "polls",
//    "alarms": [{"kind", "subject", "text", "since_s"}], "events": [the last kKeptEvents],
//    "cameras": [{"camera", "host", "stream", "rate_hz", "phase_ms", "moved_ms", "scatter_ms",
//      "frames", "lost", "lost_share", "slips", "state"}],
//    "clocks": [{"subject", "file", "error_ms", "max_te_ms", "rms_te_ms", "steps", "samples"}],
//    "diagnosis": null or {"lead", "lines"} of what is kept (kDiagnoseS apart)}
//
// Times are seconds since the watch began, of the machine's steady clock, but for those of events,
// which are of the data's own time.
//
// Memory: that of the watches; nothing grows with time.
//
//   Monitor monitor({.recordings = {"rig.csv"}, .clock_logs = {{"hostA", "tracking.log"}}});
//   for (const WatchEvent& event : monitor.poll(now_s)) print(event.text);
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/stability/masks.h"
#include "recording/recording_columns.h"
#include "reports/text/json_node.h"
#include "watch/clock_watch.h"
#include "watch/grown_stamps.h"
#include "watch/rig_watch.h"
#include "watch/watch_event.h"

namespace simbench::watch {

inline constexpr double kStallS = 5;
inline constexpr double kRecentS = 60;
inline constexpr double kDiagnoseS = 30;
inline constexpr double kJudgeS = 10;
inline constexpr std::size_t kKeptEvents = 50;

// "-": standard input.
struct WatchedLog {
  std::string host{};       // empty: the file's name
  std::string path;         // or the command
  bool is_command = false;  // that prints one (pipe_text.h)
};

struct WatchOptions {
  std::vector<std::string> recordings{};  // CSV, and folders that `simbench record` writes
  std::optional<RecordingColumns> columns{};
  std::vector<WatchedLog> clock_logs{};
  evaluation::ClockLogOptions clock{};
  std::optional<double> clock_limit_ms{};
  // By which the last kKeptErrors of each clock are judged, kJudgeS apart.
  std::vector<evaluation::ClockMask> clock_masks{};
  double clock_stall_s = 300;  // logs are written seldom
};

class Monitor {
 public:
  explicit Monitor(const WatchOptions& options);

  // What has happened since the last call. `now_s`: any steady clock of the machine.
  std::vector<WatchEvent> poll(double now_s);
  bool has_alarm() const { return !alarms_.empty(); }
  // Whether there ever was one.
  bool had_alarm() const { return had_alarm_; }
  reports::Json snapshot() const;

  const RigWatch& rig() const { return rig_; }

 private:
  struct Alarm {
    WatchEvent event;
    double since_s = 0;
    bool closes = true;  // else it ends after kRecentS
  };
  // A file that is watched, whatever is in it.
  struct Source {
    std::string path;
    double stall_s = 0;
    double grew_s = 0;
    bool has_grown = false;
    bool is_there = true;
    bool stands_still = false;
    std::string problem{};
  };
  struct Clock {
    GrownClock grown;
    ClockWatch watch;
    Source source;
    std::vector<bool> is_beyond{};  // by mask
  };
  struct Recording {
    GrownFrames grown;
    Source source;
  };

  void poll_recording(Recording& recording);
  void poll_clock(Clock& clock);
  void look_at_source(const GrownState& found, bool has_grown, Source& source);
  void keep(const WatchEvent& event);
  void end_old_alarms();
  void diagnose();
  void judge(Clock& clock);
  void judge_clocks();
  void tell(WatchEvent event);

  double now_s_ = 0;
  double begin_s_ = evaluation::kNan;
  double since_s_ = 0;  // of the present status
  std::uint64_t polls_ = 0;
  RigWatch rig_;
  std::vector<std::unique_ptr<Recording>> recordings_;
  std::vector<std::unique_ptr<Clock>> clocks_;
  std::vector<Alarm> alarms_;
  bool had_alarm_ = false;
  std::deque<WatchEvent> events_;
  std::vector<WatchEvent> news_;
  std::vector<evaluation::ClockMask> masks_;
  double judged_s_ = 0;
  double diagnosed_s_ = 0;
  reports::Json diagnosis_;
};

}  // namespace simbench::watch

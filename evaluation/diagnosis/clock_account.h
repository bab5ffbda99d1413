// Logs of the hosts' clocks beside a recording: what of its spread the clocks are, and what not.
//
// Answers "PTP and phc2sys look good, and the maps are blurry" and "both hosts locked, the frames
// not aligned". Logs are given to hosts: by the name that is said for them; to the only host; by a
// host's name in the log's series or file name. They are placed on the arrivals' time scale
// (logged_clock.h), their steps are matched with jumps of the arrivals (camera_delays.h), and their
// errors with the slow part of the delays (clock_explanation.h) and with the spread of the cameras
// at a pulse (spread_budget.h), of each camera against the first one of its kind of stream.
//
// A host with logs of ptp4l and of phc2sys has the sum of both errors: network card against master,
// system clock against network card. Among other logs of one host, the one with most points during
// the recording is taken.
//
// Another program sets a clock if its log has three steps of equal size (10 %) that lead away from
// zero, which no servo does, or three slews away from it at more than 200 ppm. Equal are two thirds
// of all such steps or more. Steps that do not last for three points must be five, and three times
// as large as what counts as large (logged_clock.h): outliers of a noisy log are not.
//
// Nothing is refused: what does not fit (a log of another day, a host without a log) is a finding
// that says what is still shown. Pure and deterministic; complexity O(n log n) in frames and
// points.
//
//   const ClockAccount account = clock_account(recorded.streams, logs);
//   for (const ClockFinding& finding : account.findings) print(finding.text);
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "evaluation/diagnosis/camera_delays.h"
#include "evaluation/diagnosis/clock_explanation.h"
#include "evaluation/diagnosis/logged_clock.h"
#include "evaluation/diagnosis/spread_budget.h"
#include "recording/recorded_streams.h"

namespace simbench::evaluation {

// A jump of the arrivals on one host, of all cameras that have it within a second and 20 %.
struct HostJump {
  std::string host{};
  DelayJump jump{};                    // median of the cameras'; the earliest time
  std::vector<std::string> cameras{};  // each once
  std::size_t streams = 0;             // of the host's
  std::size_t all_streams = 0;
};

// A change in a log and the jump of the arrivals that it is.
struct MatchedStep {
  std::size_t log = 0;     // in ClockAccount::logs
  std::size_t change = 0;  // in LoggedClock::changes
  std::size_t jump = 0;    // in ClockAccount::jumps
};

// A stream of a camera, and what it has of the logs.
struct ClockedCamera {
  std::string camera{};
  std::string host{};
  std::string stream{};
  TimeRange steady{};        // of those that camera_delays() has
  TimeRange arrivals{};      // of all frames; NaN without any
  bool is_usable = false;    // camera_delays() has it
  bool shows_clock = false;  // its stamps are not its host's
  bool shares_time = false;  // with a placed log of its host
  double smallest_jump_ms = kNan;
};

struct ClockFinding {
  // "log_of_another_day", "log_in_local_time", "daylight_saving", "log_from_boot",
  // "log_placed_by_steps", "host_without_log", "log_of_no_host", "no_common_time",
  //     "log_of_summaries", "log_too_coarse", "unusable_stamps", "host_clock_step", "unseen_step",
  //     "host_clock_slew",
  // "unexplained_jump", "another_program", "clocks_explain", "clocks_do_not_explain",
  // "locked_but_apart", "spread_by_clocks"
  std::string kind{};
  std::string text{};  // a sentence
  std::string host{};  // empty: of several or none
  double harm = 0;     // 0 to 1: how far it spoils the alignment, or what can be said of it
};

struct ClockAccount {
  double zero_s = kNan;  // the first arrival: times in texts count from it
  std::vector<ClockedCamera> cameras{};
  std::vector<LoggedClock> logs{};  // in the order given
  std::vector<HostJump> jumps{};
  std::vector<MatchedStep> matches{};
  std::vector<ClockExplanation> explanations{};
  std::vector<SpreadBudget> budgets{};
  std::vector<ClockFinding> findings{};  // the most harmful first
};

struct ClockAccountOptions {
  // The exposure length of each frame, by stream and frame; empty, or empty for a stream: unknown.
  std::vector<std::vector<double>> exposures_ms{};
};

ClockAccount clock_account(const std::vector<RecordedStream>& streams,
                           std::span<const HostLog> logs, const ClockAccountOptions& options = {});

// The findings of an account without them (clock_findings.cc).
std::vector<ClockFinding> clock_findings(const ClockAccount& account);

// The largest error of a host's clock by its logs from the one time to the other, those of a chain
// added; NaN without a log.
double host_within_s(const ClockAccount& account, const std::string& host, double begin_s,
                     double end_s);

// "2024-09-03 10:32:22 UTC"; of times that do not count from 1970 "12.3 s".
std::string clock_time_text(double time_s);

}  // namespace simbench::evaluation

// Does the synchronisation of a rig work, and what is wrong with it? An answer from recorded
// stamps.
//
// Takes the recordings that `simbench replay` reads. They hold no truth; the answer rests on these
// facts. Cameras that start each frame with a common trigger have the same frame period in one
// time, whatever their own clocks do; free-running cameras differ by tens of ppm, so that their
// phases drift apart. Stamps that count from one epoch can be compared as they are, so that a
// constant between cameras shows, too. And a camera's frame counter counts exposures.
//
// Streams (stream_facts.h): each by itself. Scales (stamp_scale.h): what its stamps count.
//
// Groups (sync_group.cc): the cameras that have one kind of stream follow one trigger if their
// periods agree within the fits' uncertainty (so far that it happens to one group in a thousand
// whose cameras do have one period), also at a whole multiple of the common period. The time they
// are compared in is that of the stamps, if all count from one epoch (or boot) and run at one rate
// against the arrivals, else that of the arrivals: of cameras on one host by their differences,
// which a slewed clock leaves alone (common_mode.h). The largest set that agrees is the standard
// for the others. It is of cameras whose periods are known well enough for the verdict "works"; if
// there is none, and some disagree all the same, of any. The verdict "works" needs a resolution of
// 5 ppm: free-running cameras rarely agree that well, and two of them by chance once in ten.
// Cameras of several hosts that are compared by arrivals can differ because the hosts' clocks do;
// stamps cannot tell these cases apart.
//
// Offsets: a phase is the place of a camera's frames within the common period, relative to the
// first camera of the standard (one without phase steps, if there is one). By stamps, it is an
// offset of the exposures as the cameras have them, and one beyond kOffsetShare of a period (and
// three times the scatter) is named; by arrivals it contains the delays, and is not judged.
//
// Clocks (clock_account.h): logs of the hosts' clocks beside the recording, if they are given.
//
// Findings (findings.h): the faults by harm; the worst one is the headline.
//
// What too few frames leave undefined is NaN. Complexity: O(n log n) in the frames of a stream.
// Source: docs/reference/users.md section 1, docs/reference/d455.md sections 2 and 4.
//
//   Diagnosis d = diagnose(reader.take(), {.rate_hz = 30});
//   print(d.verdict.status, d.verdict.reason);
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/diagnosis/clock_account.h"
#include "evaluation/diagnosis/stamp_scale.h"
#include "evaluation/diagnosis/stream_facts.h"
#include "evaluation/diagnosis/stream_pair.h"
#include "evaluation/statistics/statistics.h"
#include "recording/recorded_streams.h"

namespace simbench::evaluation {

inline constexpr double kOffsetShare = 0.02;

enum class Follows : std::uint8_t {
  kTrigger,    // the same period as the others
  kOwnClock,   // a period of its own: free-running
  kOtherRate,  // no whole multiple of the others' period
  kHostOrOwn,  // a period of its own, but also the only camera of its host (or as all there)
  kUnknown,    // too few frames
};

// From here on the phase was this.
struct PhaseSegment {
  double from_s = 0;  // after the stream's first arrival
  double phase_ms = 0;
};

// One camera compared with the others of its group.
struct Standing {
  Follows follows = Follows::kUnknown;
  int period_multiple = 1;            // of the common period: 2 is half the rate
  double rate_ppm = kNan;             // period against the common one
  double rate_sd_ppm = kNan;          // of the difference
  double moves_ms_per_minute = kNan;  // its phase, against the standard's
  double phase_ms =
      kNan;  // of its last segment, relative to the reference camera; within half a period
  std::vector<PhaseSegment> segments{};  // more than one: its phase steps
  bool is_offset = false;                // the phase is a constant offset worth a name
};

enum class SyncStatus : std::uint8_t {
  kWorks,
  kWorksWithOffset,  // one period, but a constant between the exposures
  kSlips,            // one period, but phases that step
  kDoesNotWork,
  kCannotBeTold
};

struct GroupVerdict {
  std::string stream;
  SyncStatus status = SyncStatus::kCannotBeTold;
  std::string reason;
  double period_ms = kNan;              // common, in the time they are compared in
  double resolution_ppm = kNan;         // of periods; at least that of stamps, 0.02 ppm
  bool by_stamps = false;               // compared by stamps of one clock, not by arrivals
  double spread_ms = kNan;              // by stamps: from the earliest phase to the latest
  std::optional<std::size_t> standard;  // the reference camera: its place among the group's
};

struct GroupMember {
  std::string camera;
  std::string host;
  const StreamFacts* facts = nullptr;
  const StampScale* scale = nullptr;
  Standing* standing = nullptr;  // filled in
};

// `expected_period_ms`: the trigger's nominal period; nothing: that of most cameras.
GroupVerdict judge_group(std::string stream, std::span<const GroupMember> members,
                         std::optional<double> expected_period_ms);

struct DiagnoseOptions {
  std::optional<double> rate_hz =
      std::nullopt;                   // nominal, of the trigger; nothing: that of the cameras
  bool one_host = false;              // one clock stamped all arrivals; ignores the files' hosts
  std::vector<HostLog> clock_logs{};  // of the hosts' clocks (clock_account.h)
};

// One stream of one camera.
struct CameraDiagnosis {
  std::string camera;
  std::string host;
  std::string stream;
  StreamFacts facts;
  StampScale scale;
  Standing standing;
};

enum class Harm : std::uint8_t {
  kNote,     // no fault, but worth knowing
  kMinor,    // some frames
  kSerious,  // many frames, or stamps that need a correction
  kFatal,    // frames that belong together cannot be found by these stamps
  kStamps    // stamps are not what they seem, and all else rests on them
};

enum class FindingCertainty : std::uint8_t { kCertain, kLikely, kPossible };

// A fault or a noteworthy fact.
struct Finding {
  std::string camera;
  std::string stream;
  std::string kind;      // one of a fixed set, for programs: "free_running", "lost_frames", ...
  std::string text;      // cause and evidence, with the camera's name
  std::string advice{};  // what to do; may be empty
  Harm harm = Harm::kNote;
  FindingCertainty certainty = FindingCertainty::kCertain;
  bool in_verdict = false;  // the group's verdict says the same
};

struct Diagnosis {
  std::vector<CameraDiagnosis> cameras;
  std::vector<GroupVerdict> groups;      // one per kind of stream; depth first
  std::vector<PairDiagnosis> pairs;      // of two streams of one camera
  std::vector<Finding> findings;         // the most harmful first
  GroupVerdict verdict;                  // that of the first group
  ClockAccount clocks;                   // without logs: empty
  std::vector<std::string> cannot_know;  // from stamps alone
};

// "camera front"; a name that says so itself alone: "camera11".
std::string called_camera(const std::string& name);

Diagnosis diagnose(const std::vector<RecordedStream>& streams, const DiagnoseOptions& options);

}  // namespace simbench::evaluation

// Does the hardware synchronisation of a rig work? An answer from recorded stamps.
//
// Takes the recordings that `simbench replay` reads. They hold no truth; the answer rests on two
// facts. Cameras that start each frame with a common trigger have the same frame period in *host*
// time, whatever their own clocks do; free-running cameras differ by tens of ppm, so that their
// phases drift apart. And a camera's frame counter counts exposures: a gap in it is frames lost
// after the camera, a period without a count was never exposed.
//
// Streams (diagnose_stream.cc): a lasting change between arrivals and sensor stamps is a jump, of
// whole periods (the camera's stamps slipped) or of any length (a clock was set). Arrivals are
// compared with jumps taken out. The first 5 s of recordings of 20 s and more are discarded, since
// cameras are unsteady there; the account of frames alone covers them too (frame_account.h).
//
// Groups (diagnose_group.cc): the cameras that have one kind of stream follow one trigger if their
// periods in host time agree within the fits' uncertainty (four standard deviations), also at a
// whole multiple of the common period. The largest set that agrees is the standard for the others.
// It is of cameras whose periods are known well enough for the verdict "works"; if there is none,
// and some disagree all the same, of any. The verdict "works" needs a resolution of 5 ppm:
// free-running cameras rarely agree that well, and two of them by chance once in ten. Periods are
// compared between cameras whose arrivals were stamped by one clock. Those of different hosts can
// differ because the hosts' clocks do; stamps cannot tell these cases apart.
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

#include "evaluation/frames/frame_account.h"
#include "evaluation/statistics/statistics.h"
#include "recording/recorded_streams.h"

namespace simbench::evaluation {

// A lasting change of (arrival - sensor stamp).
struct StampJump {
  std::size_t frame = 0;  // the first one after it; of StreamFacts::arrivals_ms
  double at_s = 0;        // after the stream's first arrival
  double step_ms = 0;     // positive: stamps fell behind the arrivals
  int periods = 0;        // 0: no whole number of them
};

// A time in which many frames came late.
struct DelayBurst {
  double at_s = 0;  // after the stream's first arrival
  double for_s = 0;
  std::int64_t late = 0;  // frames
  double most_ms = 0;     // later than usual
};

struct StreamFacts {
  double first_arrival_s = kNan;
  double last_arrival_s = kNan;
  double longest_gap_s = kNan;  // between two arrivals
  double gap_at_s = kNan;       // its begin, after the first arrival
  // On the camera's clock.
  double period_ms = kNan;           // of a frame
  double interval_jitter_ms = kNan;  // standard deviation from whole periods
  double on_grid_share = kNan;       // of intervals within a tenth of whole periods
  double drift_ppm = kNan;           // (host rate / device rate - 1) 1e6, from first to last frame
  // On the host's clock.
  double host_period_ms = kNan;
  double host_period_sd_ppm = kNan;  // standard deviation of that, relative
  // Events.
  FrameAccount account;              // of all frames, the first seconds too
  std::int64_t repeated_stamps = 0;  // frames with the stamp of the frame before
  std::int64_t backward_stamps = 0;
  std::int64_t backward_arrivals = 0;
  std::int64_t future_stamps = 0;  // frames that arrived earlier than their stamp allows
  double future_ms = 0;            // by how much, at most
  std::int64_t wraps = 0;          // of the 32-bit microsecond register
  bool global_time = false;        // stamps count from 1970: they are no camera's
  bool one_clock = false;          // arrivals are the stamps (camera_statistics.h)
  // The recording says these two: RecordedStream has what they mean.
  bool counted = true;
  bool stamped_by_host = false;
  double least_delay_ms = kNan;  // of arrivals after stamps, if a host made those; 1 % are below
  std::vector<StampJump> jumps;
  std::vector<DelayBurst> bursts;
  // Arrivals with jumps taken out, and the period each belongs to; for comparisons of phase.
  std::vector<double> arrivals_ms;
  std::vector<std::int64_t> periods;

  double span_s() const { return last_arrival_s - first_arrival_s; }
};

// Frames as recorded, not unwrapped, in order of delivery.
StreamFacts stream_facts(const RecordedStream& stream);

// Two streams of one camera compared, such as depth and colour.
//
// Both have stamps of the camera's one clock. Each frame of the second stream is compared with the
// nearest of the first; offsets are continued beyond half a period, so that a free-running stream
// shows as a steady drift.
struct PairDiagnosis {
  std::string camera;
  std::string stream;
  std::string against;
  double offset_ms = kNan;  // mean; later is positive
  double spread_ms = kNan;  // sd about the movement
  double moves_ms_per_minute = kNan;
  bool runs_free = false;
};

// Both as recorded; offset and drift are NaN with fewer than two frames in either.
PairDiagnosis compare_streams(std::span<const StampedFrame> frames,
                              std::span<const StampedFrame> against);

enum class Follows : std::uint8_t {
  kTrigger,    // the same period as the others
  kOwnClock,   // a period of its own: free-running
  kOtherRate,  // no whole multiple of the others' period
  kHostOrOwn,  // a period of its own, but also the only camera of its host (or as all there)
  kUnknown,    // too few frames
};

// One camera compared with the others of its group.
struct Standing {
  Follows follows = Follows::kUnknown;
  int period_multiple = 1;            // of the common period: 2 is half the rate
  double rate_ppm = kNan;             // period against the common one
  double rate_sd_ppm = kNan;          // of the difference
  double moves_ms_per_minute = kNan;  // its phase, against the standard's
  double phase_ms = kNan;  // of the arrivals, relative to the first camera of the standard
};

enum class SyncStatus : std::uint8_t { kWorks, kDoesNotWork, kCannotBeTold };

struct GroupVerdict {
  std::string stream;
  SyncStatus status = SyncStatus::kCannotBeTold;
  std::string reason;
  double period_ms = kNan;              // common, in host time
  double resolution_ppm = kNan;         // of periods; at least that of stamps, 0.02 ppm
  std::optional<std::size_t> standard;  // the first camera that has the common period
};

struct GroupMember {
  std::string camera;
  std::string host;
  const StreamFacts* facts = nullptr;
  Standing* standing = nullptr;  // filled in
};

// `expected_period_ms`: the trigger's nominal period; nothing: that of most cameras.
GroupVerdict judge_group(std::string stream, std::span<const GroupMember> members,
                         std::optional<double> expected_period_ms);

struct DiagnoseOptions {
  std::optional<double> rate_hz =
      std::nullopt;       // nominal, of the trigger; nothing: that of the cameras
  bool one_host = false;  // one clock stamped all arrivals; ignores the files' hosts
};

// One stream of one camera.
struct CameraDiagnosis {
  std::string camera;
  std::string host;
  std::string stream;
  StreamFacts facts;
  Standing standing;
};

// A fault or a noteworthy fact, in words.
struct Finding {
  std::string camera;
  std::string stream;
  std::string kind;  // one of a fixed set, for programs: "free_running", "lost_frames", ...
  std::string text;  // with the camera's name
};

struct Diagnosis {
  std::vector<CameraDiagnosis> cameras;
  std::vector<GroupVerdict> groups;  // one per kind of stream; depth first
  std::vector<PairDiagnosis> pairs;  // of two streams of one camera
  std::vector<Finding> findings;
  GroupVerdict verdict;                  // that of the first group
  std::vector<std::string> cannot_know;  // from stamps alone
};

// "camera front"; a name that says so itself alone: "camera11".
std::string called_camera(const std::string& name);

Diagnosis diagnose(const std::vector<RecordedStream>& streams, const DiagnoseOptions& options);

}  // namespace simbench::evaluation

// Do the cameras that have one kind of stream follow one trigger? (evaluation/diagnosis/diagnose.h)
//
// Cameras follow if their periods in host time agree within the fits' uncertainty (four standard
// deviations), also at a whole multiple of the common period. The largest set that agrees is the
// standard for the others. The verdict "works" needs a resolution of 5 ppm: free-running cameras
// rarely agree that well, and two of them by chance once in ten.
#ifndef SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_GROUP_H_
#define SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_GROUP_H_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/diagnosis/diagnose_stream.h"

namespace simbench::evaluation {

enum class Follows : std::uint8_t {
  kTrigger,    // the same period as the others
  kOwnClock,   // a period of its own: free-running
  kOtherRate,  // no whole multiple of the others' period
  kHostOrOwn,  // a period of its own, but also the only camera of its host (or as all there)
  kUnknown,    // too few frames
};

// How one camera stands to the others of its group.
struct Standing {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  Follows follows = Follows::kUnknown;
  int period_multiple = 1;                // of the common period: 2 is half the rate
  double rate_ppm = kUnknown;             // period against the common one
  double rate_sd_ppm = kUnknown;          // of the difference
  double moves_ms_per_minute = kUnknown;  // its phase, against the standard's
  double phase_ms = kUnknown;  // of the arrivals, against the first camera of the standard
};

enum class SyncStatus : std::uint8_t { kWorks, kDoesNotWork, kCannotBeTold };

struct GroupVerdict {
  std::string stream;
  SyncStatus status = SyncStatus::kCannotBeTold;
  std::string reason;
  double period_ms = std::numeric_limits<double>::quiet_NaN();  // common, in host time
  double resolution_ppm = std::numeric_limits<double>::quiet_NaN();
  std::optional<std::size_t> standard;  // the first camera that has the common period
};

struct GroupMember {
  std::string camera;
  std::string host;
  const StreamFacts* facts = nullptr;
  Standing* standing = nullptr;  // filled in
};

// `expected_period_ms`: what the trigger should have; nothing: that of most cameras.
GroupVerdict judge_group(std::string stream, std::span<const GroupMember> members,
                         std::optional<double> expected_period_ms);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_GROUP_H_

// Is the hardware synchronisation of a rig working at all? An answer from its recorded stamps.
//
// Takes the recordings that `simbench replay` reads. There is no truth in them; what follows rests
// on two facts. A camera that starts each frame with a common trigger has the same frame period as
// the others in *host* time, whatever its own clock does; cameras that run free differ by tens of
// ppm, so that their phases drift apart. And a camera's frame counter counts exposures: frames that
// the counter knows were lost after the camera, periods that it does not know were never exposed.
//
// Periods in host time are compared between cameras whose arrivals were stamped by one clock. Those
// of different hosts can differ because the hosts' clocks do: then the stamps cannot tell.
//
// The steps: diagnose_stream.h (streams of one camera), diagnose_group.h (the cameras that have
// a kind of stream), and findings in words.
// What too few frames leave undefined is NaN. Complexity: O(n log n) in the frames of a stream.
//
// Source: docs/reference/users.md section 1, docs/reference/d455.md sections 2 and 4.
//
//   Diagnosis d = diagnose(reader.take(), {.rate_hz = 30});
//   print(d.verdict.status, d.verdict.reason);
#ifndef SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_H_
#define SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/diagnosis/diagnose_group.h"
#include "evaluation/diagnosis/diagnose_stream.h"
#include "recording/rs_csv.h"

namespace simbench::evaluation {

struct DiagnoseOptions {
  std::optional<double> rate_hz =
      std::nullopt;       // that the trigger should have; nothing: that of the others
  bool one_host = false;  // one clock stamped all arrivals, whatever the files say
};

// One stream of one camera.
struct CameraDiagnosis {
  std::string camera;
  std::string host;
  std::string stream;
  StreamFacts facts;
  Standing standing;
};

// What someone should know, in words.
struct Finding {
  std::string camera;  // empty: about all
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

Diagnosis diagnose(const std::vector<CameraStream>& streams, const DiagnoseOptions& options);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_H_

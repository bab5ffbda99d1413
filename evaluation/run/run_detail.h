// One run of one pipeline at one seed, with the details that figures need.
//
// It has the capture behind a score: every frame with its stamps and its truth, every gathered set,
// the host clocks before, during and after synchronisation. evaluate() scores the same run: same
// recording, same score.
//
// Units: milliseconds. Times on the hosts' scale (`backend` to `reference`) count from `zero`, the
// same for all cameras of a run, so that a double holds them to about a picosecond; device times
// count from the zero of the camera's own register; true times from true zero (true_time.h). A
// value that does not exist (no truth, no stamp) is NaN.
//
// Cost: the run and one or two more estimators; 150 bytes per frame of the first kDetailCameras
// cameras. Frames of other cameras are scored, but not kept.
//
//   const PipelineChoice choice = choose_pipelines(scenario, {"yoon2021_both"}).front();
//   const auto source = sim::make_simulation(scenario);
//   const RunDetail run = run_detail(scenario, choice, /*seed=*/1, *source);
//   run.cameras[0].frames.front().global_ms;
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "evaluation/run/pipeline_choice.h"
#include "evaluation/scoring/results.h"
#include "recording/recording.h"
#include "recording/world_observer.h"
#include "scenarios/choices.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

// The number of cameras (and hosts), from the first on, that are kept in detail.
inline constexpr std::size_t kDetailCameras = 18;

struct FrameDetail {
  std::uint32_t counter = 0;
  std::int64_t pulse = -1;  // that exposed it; -1: none, or unknown
  bool evaluated = false;   // of a scored pulse
  bool in_warm_up = false;  // before the first scored pulse
  double sensor_ms = 0;     // device clock, unwrapped
  double frame_ms = 0;      // device clock, unwrapped
  double backend_ms = 0;    // host's system clock, from zero
  double arrival_ms = 0;    // the same
  double global_ms = kNan;  // by the pipeline, from zero; none in the warm-up
  // By the same estimator, started with the camera's first frame, as in Fig. 7b. For a relative
  // estimator only differences are meaningful.
  double from_start_ms = kNan;
  double online_ms = kNan;          // by regression_30, from zero; none in the warm-up
  double offline_ms = kNan;         // by regression_offline, from zero; none in the warm-up
  double reference_ms = kNan;       // master's clock at mid-exposure, from zero: the truth
  double own_host_ms = kNan;        // own host's clock at mid-exposure, from zero: the truth
  double exposure_start_ms = kNan;  // true time
  double exposure_end_ms = kNan;    // true time

  double mid_exposure_ms() const { return (exposure_start_ms + exposure_end_ms) / 2; }
};

// A frame of the stream that is not scored, such as colour beside depth.
struct OtherFrame {
  double sensor_ms = 0;             // device clock, unwrapped: the one of FrameDetail::sensor_ms
  double exposure_start_ms = kNan;  // true time
  double exposure_end_ms = kNan;    // true time
};

struct CameraDetail {
  std::uint32_t host = 0;
  std::vector<FrameDetail> frames;  // of the scored stream, in order of delivery
  std::vector<OtherFrame> others;   // of the other stream, likewise
};

// A frame that was taken and never arrived: observed in a simulated world, else derived from gaps
// of the frame counters, and then without pulse and time.
struct LostFrame {
  std::uint32_t camera = 0;
  std::uint32_t counter = 0;
  std::int64_t pulse = -1;
  FrameFate fate = FrameFate::kLostInCamera;
  double mid_exposure_ms = kNan;  // true time
};

// A set that gathering emitted and that counts (set_counter.h).
struct SetDetail {
  struct Member {
    std::uint32_t camera = 0;
    std::size_t frame = 0;  // index into CameraDetail::frames
  };
  std::vector<Member> members;  // of cameras kept in detail
  std::int64_t pulse = -1;      // of most members (with a tie the smallest)
  bool complete = false;        // no source is missing
  bool pure = false;            // all members of one pulse
  double range_ms = 0;          // of the members' stamps
};

// System clocks minus the master's at one instant.
struct ClockErrors {
  double at_ms = 0;               // true time
  std::vector<double> errors_ms;  // by host, the first kDetailCameras; [0] is 0
};

struct RunDetail {
  std::string scenario;
  std::string pipeline;
  std::uint64_t seed = 0;
  StreamKind stream = StreamKind::kDepth;  // the scored one
  scenarios::SyncMode sync_mode = scenarios::SyncMode::kGenlock;
  std::shared_ptr<const CodedPulses> pulses_code{};  // null: the trigger has no code
  double frame_rate_hz = 0;
  std::size_t camera_count = 0;  // of the rig; `cameras` has the first of them
  std::size_t host_count = 0;
  std::int64_t first_pulse = 0;  // evaluated: [first_pulse, first_pulse + pulses)
  std::int64_t pulses = 0;
  double gathering_interval_ms = 0;  // T_int
  bool has_truth = false;
  bool has_pulses = false;  // the pulse of some frame is known
  bool service = false;     // host_sync continues during the capture
  // True time; NaN where the world was not observed (a real rig) or there is none.
  double world_start_ms = kNan;
  double sync_end_ms = kNan;  // only if the synchronisation ends
  double capture_start_ms = kNan;
  double evaluated_start_ms = kNan;  // first scored exposure
  double capture_end_ms = kNan;      // last exposure
  HostTime zero{};                   // of the stamps on the hosts' scale

  std::vector<CameraDetail> cameras;
  std::vector<LostFrame> lost;
  std::vector<SetDetail> sets;      // in order of emission
  std::vector<ClockErrors> clocks;  // in order of time; also at the evaluated pulses
  SeedScore score;                  // as evaluate() gives it, with pulses
};

// Throws what a job of evaluate() throws, without its context.
RunDetail run_detail(const scenarios::Scenario& scenario, const PipelineChoice& choice,
                     std::uint64_t seed, RecordingSource& source);

}  // namespace simbench::evaluation

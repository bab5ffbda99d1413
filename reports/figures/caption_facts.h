// What one run shows, in numbers and in words: the statements of its figures' captions.
//
// A caption states no cause and no comparison that is not computed here from that very run.
//
// A global stamp less its pulse's reference (figure_parts.h) has three parts, which add up to it:
//
//   exposure   the mid-exposure on the master's clock, less the reference
//   clock      the own host's clock less the master's, at mid-exposure
//   delay      the stamp less the own host's clock at mid-exposure: the delivery, as device_time
//              has it
//
// They need truth. Units: milliseconds; NaN for what no frame has. Complexity: O(frames).
//
//   const std::vector<StampsOfHost> hosts = stamps_of_hosts(run, kept_cameras(run));
//   const double by_clocks = hosts[1].mean.clock_ms - hosts[0].mean.clock_ms;
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/run/run_detail.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

struct StampParts {
  double exposure_ms = 0;
  double clock_ms = 0;
  double delay_ms = 0;

  double stamp_ms() const { return exposure_ms + clock_ms + delay_ms; }
};

// Means over the evaluated frames of a host's cameras.
struct StampsOfHost {
  std::uint32_t host = 0;
  StampParts mean;
  double exposure_length_ms = 0;
};

// The numbers of all kept cameras.
std::vector<std::size_t> kept_cameras(const evaluation::RunDetail& run);

// In order of the hosts; those without an evaluated frame of these cameras are left out. Empty
// without truth.
std::vector<StampsOfHost> stamps_of_hosts(const evaluation::RunDetail& run,
                                          std::span<const std::size_t> cameras);

// The mean over pulses and hosts of the range of a host's stamps; NaN where no host has two.
double range_in_hosts_ms(const evaluation::RunDetail& run, std::span<const std::size_t> cameras);

// How far apart the stamps of one host and those of the farthest two hosts are, and what the
// distance consists of. Begins with a blank.
std::string distance_text(const evaluation::RunDetail& run, std::span<const std::size_t> cameras);

// How a stamp's intervals between consecutive frames after the warm-up vary.
struct IntervalFacts {
  double deviation_ms = evaluation::kNan;  // standard deviation
  std::size_t intervals = 0;
  std::size_t jumps = 0;  // longer than the nominal one by more than kJumpPeriods
};
inline constexpr double kJumpPeriods = 0.1;  // of the frame period
IntervalFacts interval_facts(const evaluation::RunDetail& run, std::size_t camera,
                             double evaluation::FrameDetail::*stamp);

// Whether a capture without this stamp has another one in its place: the arrival in that of the
// back-end stamp, the sensor stamp in that of the frame stamp.
bool is_copy(const evaluation::CameraDetail& camera, double evaluation::FrameDetail::*stamp);

// The facts of the four stamps of a camera. Begins with a blank, like all texts here.
std::string intervals_text(const evaluation::RunDetail& run, std::size_t camera);

// The mean over pulses of the range of these cameras' stamps, and the largest, in the first `most`
// pulses or frames after the warm-up that all of them have. NaN of a single camera.
struct RangeFacts {
  double mean_ms = evaluation::kNan;
  double largest_ms = evaluation::kNan;
};
RangeFacts range_facts(const evaluation::RunDetail& run, std::span<const std::size_t> cameras,
                       double evaluation::FrameDetail::*stamp, std::size_t most);

// How far apart the sensor and the arrival stamps of a pulse are, in the first frames.
std::string ranges_text(const evaluation::RunDetail& run, std::span<const std::size_t> cameras);

// How far eq. (1) online and offline differ, and how late both are.
std::string online_offline_text(const evaluation::RunDetail& run,
                                std::span<const std::size_t> cameras);

// Which pipeline the paper's Fig. 5 has, if the run is not of it.
std::string before_synchronisation_note(const evaluation::RunDetail& run);

// Whether intervals over time (s) vary more before kUnsteadySeconds than later, as the paper's do:
// the standard deviation of all curves before and after. The first kSettledSeconds do not count,
// until a regression over 30 frames has them all at 15 fps. A gap counts nothing.
struct SteadyFacts {
  double before_ms = evaluation::kNan;
  double after_ms = evaluation::kNan;
  bool is_unsteady() const { return before_ms > kUnsteadyFactor * after_ms; }
  static constexpr double kUnsteadyFactor = 2;
};
inline constexpr double kSettledSeconds = 2;
inline constexpr double kUnsteadySeconds = 5;
SteadyFacts steady_facts(std::span<const FigureSeries> intervals);
std::string steady_text(const SteadyFacts& facts);

// The frames of which ranges_text() speaks, and which Fig. 3 draws.
inline constexpr std::size_t kFramesOfStamps = 60;  // more are not distinguishable

// A signed duration: "+1.18 ms".
std::string signed_time_text(double ms);

}  // namespace simbench::reports

// The results of a reconstruction experiment as plain data: Table 4 over seeds, and the cost of a
// millisecond of desynchronisation.
//
// A reprojection error is the distance, in the world's frame, between a vertex of the reconstructed
// mesh and the point of a depth map at the pixel where that vertex is seen. All errors of all frame
// sets of one seed make one distribution, whose mean, standard deviation, median and 95 %
// quantile are that seed's; over seeds there are series of those. A seed without any error (no set
// could be reconstructed) has NaN.
//
// Units: cm for errors, ms for times. Source: section 4.4 of the paper, Table 4.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/scoring/results.h"
#include "scenarios/scenario.h"

namespace simbench::reconstruction {

inline constexpr double kNoError = std::numeric_limits<double>::quiet_NaN();

struct ErrorSummary {
  double mean_cm = kNoError;
  double std_cm = kNoError;
  double median_cm = kNoError;
  double p95_cm = kNoError;
  std::int64_t count = 0;  // of (vertex, depth map) pairs
};

// One pipeline at one seed.
struct SeedReprojection {
  std::uint64_t seed = 0;
  ErrorSummary errors;
  double desync_ms = kNoError;      // mean over sets of the range of true mid-exposures
  std::int64_t sets = 0;            // that were reconstructed
  std::int64_t failed_sets = 0;     // that were not: too little of the subject was seen
  std::int64_t missing_frames = 0;  // of cameras that had none for a set, over all sets
  bool gathered = false;  // the pipeline's own gathering emitted at least one complete set
};

struct ReprojectionRow {
  std::string pipeline;
  std::string host_sync;
  std::string capture_alignment{};  // empty: none
  std::string device_time;
  std::string gathering;
  std::vector<SeedReprojection> seeds;
  std::optional<scenarios::PublishedReprojection> published;
  std::vector<std::string> notes{};

  // Series over the seeds that have errors.
  evaluation::Series mean_cm() const;
  evaluation::Series std_cm() const;
  evaluation::Series median_cm() const;
  evaluation::Series p95_cm() const;
  evaluation::Series desync_ms() const;
};

// The error with hosts apart by a known amount: exposures of a host's cameras coincide, hosts are
// spread over `desync_ms` (desync_pattern.h).
struct CurvePoint {
  double speed_m_per_s = 0;  // walking speed at the sped-up script (of one without walking: 0)
  double speed_factor = 1;   // of the scenario's script
  double desync_ms = 0;
  std::vector<double> mean_cm;  // by seed
  std::vector<double> std_cm;
};

// The speed of the subject at which a row, with its own exposures, has its published mean error.
struct SpeedNeeded {
  std::string pipeline;  // whose published mean it is
  double desync_ms = 0;  // the median of its row
  double published_mean_cm = 0;
  std::vector<CurvePoint> points;  // the row over speed; that of factor 1 is the row itself
  // Where the median mean error first passes it; nothing: not up to the last point.
  std::optional<double> speed_m_per_s;
};

struct ReconstructionResults {
  scenarios::Scenario scenario;
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 0;
  std::int64_t frames = 0;  // requested sets of each seed
  std::vector<ReprojectionRow> rows;
  std::vector<CurvePoint> curve;  // by speed, then by desynchronisation; empty: not requested
  std::optional<SpeedNeeded> speed_needed;  // of the row with the largest published mean
  std::vector<std::string> notes;           // about the subject, such as a mesh with holes
  double wall_s = 0;                        // wall-clock time; /performance
  double seconds_per_set = 0;               // mean, of one thread
};

}  // namespace simbench::reconstruction

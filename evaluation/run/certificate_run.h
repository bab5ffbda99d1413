// Certificates of the sets that pipelines gather, over seeds of a world or captures of a recording.
//
// Each pipeline's capture is scored as for a table (PipelineScorer), its evidence kept, and each of
// its complete and partial sets certified (certify.h). A row has the sets of all captures together.
//
//   CertificateOptions options{.seeds = 4, .within_ms = 0.5};
//   const CertificateRun run = certify_pipelines(
//       scenario, [&] { return make_simulation(scenario); }, options, nullptr);
//   for (const CertificateRow& row : run.rows) use(row.certified_ms(0.95));
//
// In simulation the truth is compared: `frames_outside` counts frames of pairs whose true
// difference their interval does not hold, which an assumption that is wrong and did not contradict
// the rest can make.
//
// Errors: what evaluate() throws; a capture that fails is a row's problem. Order and values do not
// depend on the number of threads. Memory: a row's sets, 8 bytes each, 72 bytes a pair that is
// kept, and a capture's evidence for each thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/certificates/assumptions.h"
#include "evaluation/certificates/certify.h"
#include "evaluation/run/evaluate.h"
#include "scenarios/derivation.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

struct HostExchangeLog {
  std::uint32_t host = 0;
  ExchangeLog log{};
};

struct CertificateOptions {
  std::vector<std::string> pipelines{};
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 1;
  unsigned jobs = 0;
  const std::atomic<bool>* cancel = nullptr;
  Horizon horizon = Horizon::kWhole;
  double within_ms = 1;
  bool keep_pairs = false;  // CertificateRow::pairs
  Assumptions assumptions{};
  // What programs on hosts logged, of a recording of one capture.
  std::vector<HostExchangeLog> logs{};
  std::map<std::string, std::uint32_t> host_of_address{};  // of servers that are hosts of the rig
};

// The tie that was the widest of its set's, over the sets in which it was.
struct WeakTie {
  LinkKind kind = LinkKind::kCamera;
  std::uint32_t first = 0;  // the camera and its host, or two hosts
  std::uint32_t second = 0;
  std::size_t sets = 0;
  double width_ms = 0;  // mean; infinite: nothing ties the two
  double age_s = 0;     // mean time to the nearest reading; infinite: there is none
  // What the two clocks may drift apart in that time, as a share of the width.
  double drift_share = 0;
};

// Two frames of a set, and how much later the second was exposed.
struct CertifiedPair {
  std::uint64_t seed = 0;
  std::size_t set = 0;  // of the capture, in the order of their emission
  std::uint32_t first_camera = 0, second_camera = 0;
  DeviceTime first_sensor{}, second_sensor{};  // unwrapped
  double least_ms = 0, most_ms = 0;            // surely; infinite: unknown
  std::optional<double> truth_ms{};
};

// A capture whose facts contradict each other.
struct ContradictedCapture {
  std::uint64_t seed = 0;
  double before_ms = 0;              // Contradiction::before
  std::vector<std::string> chain{};  // a line for each fact
  double possible_ppm = 0;           // rates that explain it; 0: none does
};

struct CertificateRow {
  std::string pipeline;
  std::string problem{};  // why there is nothing; empty: nothing is wrong
  std::uint64_t captures = 0;
  std::vector<ContradictedCapture> contradicted{};
  std::vector<double> apart_ms{};  // of sets of two frames or more, ascending; infinite: unknown
  std::vector<CertifiedPair> pairs{};
  std::size_t within = 0;           // sets within CertificateOptions::within_ms
  std::size_t impossible_sets = 0;  // that no pulses of a common trigger explain
  std::size_t due_pulses = 0;       // that all cameras were to expose; 0: unknown
  std::size_t lone_frames = 0;      // sets of one frame, which say nothing
  std::size_t frames = 0;           // of the sets, whose bounds the truth could break
  std::size_t frames_outside = 0;
  EvidenceCounts counts{};
  std::vector<WeakTie> weakest{};  // the most frequent first

  // Quantile p of the sets' bounds; NaN without sets.
  double certified_ms(double p) const;
  double share_within() const;
};

struct CertificateRun {
  std::string scenario;
  scenarios::Derivation derivation{};  // of that scenario
  CertificateOptions options;
  std::vector<CertificateRow> rows;
};

CertificateRun certify_pipelines(const scenarios::Scenario& scenario,
                                 const SourceFactory& make_source,
                                 const CertificateOptions& options, const Progress& progress);

}  // namespace simbench::evaluation

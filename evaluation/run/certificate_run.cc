#include "evaluation/run/certificate_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <tuple>
#include <utility>

#include "evaluation/certificates/certified_scoring.h"
#include "evaluation/certificates/contradiction.h"
#include "evaluation/certificates/frontier.h"
#include "evaluation/run/jobs.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

// When the clocks were read: of each camera by polls, of each host by messages.
class Readings {
 public:
  explicit Readings(const CaptureEvidence& evidence)
      : layout_(evidence.layout()),
        of_camera_(layout_.cameras.size()),
        of_host_(layout_.hosts + evidence.outside_clocks().size()) {
    for (const ClockPollEvidence& poll : evidence.polls()) {
      of_camera_[poll.camera].push_back(nanoseconds_of(poll.device));
    }
    for (const HostMessage& message : evidence.messages()) {
      of_host_[message.from].push_back(nanoseconds_of(message.sent));
      of_host_[message.to].push_back(nanoseconds_of(message.received));
    }
    for (auto* const all : {&of_camera_, &of_host_}) {
      for (std::vector<std::int64_t>& times : *all) std::ranges::sort(times);
    }
  }

  // From a frame to the nearest reading of the tie.
  double age_s(const WeakLink& tie, const FrameEvidence& frame) const {
    if (tie.kind == LinkKind::kCamera) {
      return nearest_s(of_camera_[tie.first], nanoseconds_of(frame.sensor));
    }
    const std::int64_t arrival = nanoseconds_of(frame.arrival);
    return nearest_s(of_host_[frame_host_is_first(tie, frame) ? tie.first : tie.second], arrival);
  }

 private:
  bool frame_host_is_first(const WeakLink& tie, const FrameEvidence& frame) const {
    return layout_.cameras[frame.camera].host == tie.first;
  }

  static double nearest_s(const std::vector<std::int64_t>& times, std::int64_t at) {
    const auto after = std::ranges::lower_bound(times, at);
    double nearest = kUnknown;
    if (after != times.end()) nearest = static_cast<double>(*after - at) * 1e-9;
    if (after != times.begin()) {
      nearest = std::min(nearest, static_cast<double>(at - *(after - 1)) * 1e-9);
    }
    return nearest;
  }

  const RigLayout& layout_;
  std::vector<std::vector<std::int64_t>> of_camera_;
  std::vector<std::vector<std::int64_t>> of_host_;
};

std::string instant_text(const CaptureEvidence& evidence, const ClockPoint& point) {
  return fmt::format("{} at {:.6f} s", evidence.name_of(point.clock), to_seconds(point.local));
}

// "message: sent by host 2 at 12.345678 s, received by host 0 at 45.678901 s".
std::string fact_text(const CaptureEvidence& evidence, const FactOrder& order,
                      const ClockFact& fact) {
  const std::string before = instant_text(evidence, order.points()[fact.to]);
  const std::string after = instant_text(evidence, order.points()[fact.from]);
  switch (fact.kind) {
    case FactKind::kMessage:
      return fmt::format("a message sent by {} was received by {}", before, after);
    case FactKind::kPulse:
      return order.points()[fact.to].clock < order.hosts()
                 ? fmt::format("{}, the assumed lateness taken off, was before the pulse of {}",
                               before, after)
                 : fmt::format("a pulse of {} had been seen by {}", before, after);
    case FactKind::kPollRequest:
      return fmt::format("{} asked for the clock, which read no more than {}", before, after);
    case FactKind::kPollReply:
      return fmt::format("a clock that read {} had been read by {}", before, after);
    case FactKind::kArrival:
      return fmt::format("a frame exposed by {} had arrived at {}", before, after);
  }
  return {};
}

ContradictedCapture contradicted(std::uint64_t seed, const CaptureEvidence& evidence,
                                 const FactOrder& order, std::uint32_t closing) {
  const Contradiction proof = contradiction_of(order, closing);
  ContradictedCapture found{.seed = seed, .before_ms = to_ms(proof.before)};
  for (const std::uint32_t fact : proof.facts) {
    found.chain.push_back(fact_text(evidence, order, order.facts()[fact]));
  }
  found.possible_ppm = possible_rate_ppm(evidence).value_or(0);
  return found;
}

using TieKey = std::tuple<LinkKind, std::uint32_t, std::uint32_t>;
struct TieSums {
  std::size_t sets = 0;
  double width_ms = 0;
  double age_s = 0;
};

// What a capture adds to its row.
struct CapturePart {
  std::string problem{};
  std::vector<ContradictedCapture> contradicted{};
  std::vector<double> apart_ms{};
  std::vector<CertifiedPair> pairs{};
  std::size_t impossible_sets = 0, lone_frames = 0, due_pulses = 0;
  std::size_t frames = 0, frames_outside = 0;
  EvidenceCounts counts{};
  std::map<TieKey, TieSums> ties{};
};

void add_sets(const CertifiedCapture& found, const std::vector<EvidenceSet>& sets,
              const CaptureEvidence& evidence, CapturePart& part) {
  const Readings readings(evidence);
  part.impossible_sets = found.impossible_sets;
  const std::vector<double> bounds_ms = certified_bounds_ms(found, sets);
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const SetCertificate& set = found.sets[i];
    if (std::isnan(bounds_ms[i])) {
      ++part.lone_frames;
      continue;
    }
    part.apart_ms.push_back(bounds_ms[i]);
    part.frames_outside += set.frames_outside;
    part.frames += set.frames_judged;
    const WeakLink& tie = set.weakest;
    TieSums& sums = part.ties[{tie.kind, tie.first, tie.second}];
    const auto age_of = [&](std::size_t member) {
      return readings.age_s(tie, evidence.frames()[sets[i][member]]);
    };
    ++sums.sets;
    sums.width_ms += bound_ms(tie.width);
    sums.age_s += tie.kind == LinkKind::kCamera
                      ? age_of(evidence.frames()[sets[i][set.widest.first]].camera == tie.first
                                   ? set.widest.first
                                   : set.widest.second)
                      : std::max(age_of(set.widest.first), age_of(set.widest.second));
  }
}

double bound_of(Picoseconds bound, double unknown_ms) {
  return ClockGraph::is_bounded(std::chrono::abs(bound)) ? to_ms(bound) : unknown_ms;
}

CertifiedPair pair_of(const CaptureEvidence& evidence, const EvidenceSet& frames,
                      const PairInterval& pair) {
  const FrameEvidence& first = evidence.frames()[frames[pair.first]];
  const FrameEvidence& second = evidence.frames()[frames[pair.second]];
  CertifiedPair found{.first_camera = first.camera,
                      .second_camera = second.camera,
                      .first_sensor = first.sensor,
                      .second_sensor = second.sensor,
                      .least_ms = bound_of(pair.least, -kUnknown),
                      .most_ms = bound_of(pair.most, kUnknown)};
  if (first.truth && second.truth) found.truth_ms = to_ms(*second.truth - *first.truth);
  return found;
}

CapturePart certify_capture(const scenarios::Scenario& scenario, const PipelineChoice& choice,
                            std::uint64_t seed, RecordingSource& source,
                            const CertificateOptions& options) {
  CapturePart part;
  const ScorerSetup setup = scorer_setup(scenario, choice);
  PipelineScorer scorer(setup);
  CertifiedScoring both(scorer, options.assumptions, setup.stream);
  const CaptureEvidence& evidence = both.evidence();
  try {
    const SeedScore score = score_run(source, choice, seed, scorer, both);
    part.due_pulses = static_cast<std::size_t>(score.sets.due_pulses);
    if (!score.program_failures.empty()) part.problem = score.program_failures.front().how;
  } catch (const RecordingFailed& failure) {
    part.problem = failure.what();
    return part;
  }
  for (const HostExchangeLog& each : options.logs) {
    both.add(each.host, each.log, options.host_of_address);
  }
  part.counts = evidence.counts();
  const std::vector<EvidenceSet> sets = both.sets();
  PairVisitor keep;
  if (options.keep_pairs) {
    keep = [&](std::size_t set, const PairInterval& pair) {
      CertifiedPair& kept = part.pairs.emplace_back(pair_of(evidence, sets[set], pair));
      kept.seed = seed;
      kept.set = set;
    };
  }
  try {
    const FactOrder order(evidence);
    const CertifiedCapture found = certify(evidence, order, sets, options.horizon, keep);
    if (found.contradiction) {
      part.contradicted = {contradicted(seed, evidence, order, *found.contradiction)};
    } else {
      add_sets(found, sets, evidence, part);
    }
  } catch (const NotCertifiable& problem) {
    part.problem = problem.what();
  }
  std::ranges::stable_sort(part.pairs, {}, &CertifiedPair::set);
  return part;
}

std::vector<WeakTie> ties_of(const std::map<TieKey, TieSums>& sums,
                             const Assumptions& assumptions) {
  std::vector<WeakTie> ties;
  for (const auto& [key, sum] : sums) {
    const auto sets = static_cast<double>(sum.sets);
    WeakTie& tie = ties.emplace_back();
    std::tie(tie.kind, tie.first, tie.second) = key;
    tie.sets = sum.sets;
    tie.width_ms = sum.width_ms / sets;
    tie.age_s = sum.age_s / sets;
    const double rates_ppm =
        assumptions.host_rate_ppm +
        (tie.kind == LinkKind::kHosts ? assumptions.host_rate_ppm : assumptions.camera_rate_ppm);
    // Either way, hence twice.
    tie.drift_share = std::min(1.0, 2 * rates_ppm * 1e-3 * tie.age_s / tie.width_ms);
  }
  std::ranges::stable_sort(ties, std::ranges::greater{}, &WeakTie::sets);
  return ties;
}

CertificateRow row_of(const std::string& pipeline, std::span<CapturePart> parts,
                      const CertificateOptions& options) {
  CertificateRow row{.pipeline = pipeline};
  std::map<TieKey, TieSums> ties;
  for (CapturePart& part : parts) {
    if (!part.problem.empty()) {
      row.problem = part.problem;
      continue;
    }
    ++row.captures;
    std::ranges::move(part.contradicted, std::back_inserter(row.contradicted));
    std::ranges::copy(part.apart_ms, std::back_inserter(row.apart_ms));
    std::ranges::move(part.pairs, std::back_inserter(row.pairs));
    row.impossible_sets += part.impossible_sets;
    row.lone_frames += part.lone_frames;
    row.due_pulses += part.due_pulses;
    row.frames += part.frames;
    row.frames_outside += part.frames_outside;
    row.counts += part.counts;
    for (const auto& [key, sum] : part.ties) {
      TieSums& all = ties[key];
      all.sets += sum.sets;
      all.width_ms += sum.width_ms;
      all.age_s += sum.age_s;
    }
  }
  std::ranges::sort(row.apart_ms);
  row.within = static_cast<std::size_t>(std::ranges::upper_bound(row.apart_ms, options.within_ms) -
                                        row.apart_ms.begin());
  row.weakest = ties_of(ties, options.assumptions);
  return row;
}

}  // namespace

double CertificateRow::certified_ms(double p) const { return quantile_of_bounds(apart_ms, p); }

double CertificateRow::share_within() const {
  if (apart_ms.empty()) return kNan;
  return static_cast<double>(within) / static_cast<double>(apart_ms.size());
}

CertificateRun certify_pipelines(const scenarios::Scenario& scenario,
                                 const SourceFactory& make_source,
                                 const CertificateOptions& options, const Progress& progress) {
  check_certifiable(scenario);
  const std::vector<PipelineChoice> choices = choose_pipelines(scenario, options.pipelines);
  std::vector<CapturePart> parts(choices.size() * options.seeds);
  std::mutex mutex;
  std::uint64_t done = 0;
  const auto make_worker = [&]() -> Job {
    const std::shared_ptr<RecordingSource> source = make_source();
    return [&, source](std::size_t job) {
      const PipelineChoice& choice = choices[job / options.seeds];
      const std::uint64_t seed = options.first_seed + job % options.seeds;
      run_named({scenario.name, choice.pipeline.name, seed},
                [&] { parts[job] = certify_capture(scenario, choice, seed, *source, options); });
      const std::scoped_lock lock(mutex);
      if (progress) progress(++done, parts.size());
    };
  };
  if (!run_jobs_with_workers(parts.size(), {.threads = options.jobs, .cancel = options.cancel},
                             make_worker)) {
    throw RecordingCancelled();
  }
  CertificateRun run{
      .scenario = scenario.name, .derivation = scenario.derivation, .options = options, .rows = {}};
  for (std::size_t i = 0; i < choices.size(); ++i) {
    run.rows.push_back(row_of(choices[i].pipeline.name,
                              std::span(parts).subspan(i * options.seeds, options.seeds), options));
  }
  return run;
}

}  // namespace simbench::evaluation

#include "evaluation/certificates/certified_scoring.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>

#include "evaluation/certificates/fact_order.h"
#include "evaluation/certificates/frontier.h"
#include "evaluation/statistics/statistics.h"
#include "scenarios/document.h"

namespace simbench::evaluation {

void check_certifiable(const scenarios::Scenario& scenario) {
  constexpr std::int64_t kMostClocks = 1000;
  const std::int64_t clocks = scenario.hosts.count + scenario.cameras.count;
  if (clocks <= kMostClocks) return;
  throw scenarios::InputError(
      fmt::format("certificates: found {} hosts and {} cameras, allowed: {} together, since the "
                  "work grows with "
                  "the cube of their number; certify a part of the rig",
                  scenario.hosts.count, scenario.cameras.count, kMostClocks));
}

CertifiedScoring::CertifiedScoring(PipelineScorer& scorer, const Assumptions& assumptions,
                                   StreamKind stream)
    : scorer_(scorer), evidence_(assumptions, stream) {
  scorer_.watch(collected_);
}

void CertifiedScoring::on_start(const RigLayout& layout) {
  scorer_.on_start(layout);
  evidence_.on_start(layout);
}

void CertifiedScoring::on_frames(std::span<const FrameRecord> frames,
                                 std::span<const FrameTruth> truths) {
  scorer_.on_frames(frames, truths);
  evidence_.on_frames(frames, truths);
}

void CertifiedScoring::on_event(const RecordingEvent& event) {
  scorer_.on_event(event);
  evidence_.on_event(event);
}

void CertifiedScoring::SetCollector::on_set(std::span<const GatherFrame> set, bool /*complete*/,
                                            GlobalTime /*now*/) {
  std::vector<Member>& members = sets.emplace_back();
  for (const GatherFrame& frame : set) members.emplace_back(frame.source, frame.sensor);
}

std::vector<EvidenceSet> CertifiedScoring::sets() const {
  std::multimap<SetCollector::Member, std::size_t> free;
  for (std::size_t i = 0; i < evidence_.frames().size(); ++i) {
    const FrameEvidence& frame = evidence_.frames()[i];
    free.emplace_hint(free.end(), SetCollector::Member(frame.camera, frame.sensor), i);
  }
  std::vector<EvidenceSet> sets;
  for (const auto& members : collected_.sets) {
    EvidenceSet& set = sets.emplace_back();
    for (const SetCollector::Member& member : members) {
      const auto found = free.find(member);
      if (found == free.end()) continue;
      set.push_back(found->second);
      free.erase(found);
    }
  }
  return sets;
}

std::vector<double> CertifiedScoring::bounds_ms() const {
  const std::vector<EvidenceSet> gathered = sets();
  try {
    const FactOrder order(evidence_);
    const CertifiedCapture found = certify(evidence_, order, gathered, Horizon::kWhole);
    if (found.contradiction) return {};
    return certified_bounds_ms(found, gathered);
  } catch (const NotCertifiable&) {
    return {};
  }
}

void CertifiedScoring::add_to(SeedScore& score) const {
  constexpr double kShare = 0.95;
  std::vector<double> apart_ms = bounds_ms();
  std::erase_if(apart_ms, [](double bound) { return std::isnan(bound); });
  std::ranges::sort(apart_ms);
  const double certified_ms = quantile_of_bounds(apart_ms, kShare);
  if (std::isfinite(certified_ms)) score.certified_ms = certified_ms;
}

double bound_ms(Picoseconds apart) {
  return ClockGraph::is_bounded(apart) ? to_ms(apart) : std::numeric_limits<double>::infinity();
}

std::vector<double> certified_bounds_ms(const CertifiedCapture& found,
                                        std::span<const EvidenceSet> sets) {
  std::vector<double> bounds;
  bounds.reserve(sets.size());
  for (std::size_t i = 0; i < sets.size(); ++i) {
    bounds.push_back(sets[i].size() < 2 ? kNan : bound_ms(found.sets[i].apart));
  }
  return bounds;
}

double quantile_of_bounds(const std::vector<double>& apart_ms, double p) {
  if (apart_ms.empty()) return kNan;
  // Between two unknown ones there is no interpolation.
  const double above =
      apart_ms[static_cast<std::size_t>(std::ceil(p * static_cast<double>(apart_ms.size() - 1)))];
  return std::isinf(above) ? above : quantile_of_sorted(apart_ms, p);
}

}  // namespace simbench::evaluation

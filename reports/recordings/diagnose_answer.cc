#include "reports/recordings/diagnose_answer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "recording/counted.h"
#include "reports/recordings/diagnose_report.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::CameraDiagnosis;
using evaluation::Diagnosis;
using evaluation::Finding;
using evaluation::Follows;
using evaluation::GroupVerdict;
using evaluation::Harm;
using evaluation::SyncStatus;

std::string verdict_sentence(const GroupVerdict& verdict) {
  return fmt::format(
      "{}: hardware sync {}{}{}.", verdict.stream, sync_status_text(verdict.status),
      verdict.status == SyncStatus::kDoesNotWork || verdict.status == SyncStatus::kCannotBeTold
          ? ", because "
          : ": ",
      verdict.reason);
}

std::string streams_sentences(const Diagnosis& diagnosis) {
  std::vector<std::string> sentences;
  for (std::size_t i = 1; i < diagnosis.groups.size(); ++i) {
    sentences.push_back(verdict_sentence(diagnosis.groups[i]));
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

bool drifts(const CameraDiagnosis& camera) {
  return camera.standing.follows == Follows::kOwnClock ||
         camera.standing.follows == Follows::kHostOrOwn;
}

// The camera of the first stream that moves most, and how soon it is a frame off.
std::string drift_sentence(const Diagnosis& diagnosis) {
  const CameraDiagnosis* fastest = nullptr;
  const auto speed = [](const CameraDiagnosis& camera) {
    return std::abs(camera.standing.moves_ms_per_minute);
  };
  for (const CameraDiagnosis& camera : diagnosis.cameras) {
    if (camera.stream != diagnosis.verdict.stream || !drifts(camera) || !(speed(camera) > 0)) {
      continue;
    }
    if (fastest == nullptr || speed(camera) > speed(*fastest)) fastest = &camera;
  }
  if (fastest == nullptr) return "";
  return fmt::format(
      "{} drifts most: {} a minute against the common period, a whole frame within {} "
      "minutes.",
      capitalised(evaluation::called_camera(fastest->camera)),
      time_text(fastest->standing.moves_ms_per_minute),
      number_text(diagnosis.verdict.period_ms / speed(*fastest)));
}

bool slips(const CameraDiagnosis& camera) {
  return std::ranges::any_of(camera.facts.jumps,
                             [](const auto& jump) { return jump.periods != 0; });
}

// A count over all cameras, and the camera with the most of it.
struct Counted {
  std::int64_t all = 0;
  std::string most_of{};  // "camera front"

  Counted(const Diagnosis& diagnosis, std::int64_t evaluation::FrameAccount::*count) {
    std::int64_t most = 0;
    for (const CameraDiagnosis& camera : diagnosis.cameras) {
      const std::int64_t found = camera.facts.account.*count;
      all += found;
      if (found > most) most_of = evaluation::called_camera(camera.camera);
      most = std::max(most, found);
    }
  }
  std::string text(std::string_view thing) const {
    return all == 1 ? fmt::format("1 {} is", thing)
                    : fmt::format("{} {}s are", count_text(all), thing);
  }
};

// Who lost frames, and where periods have none; empty without any.
std::string missing_text(const Diagnosis& diagnosis) {
  const Counted lost(diagnosis, &evaluation::FrameAccount::lost);
  const Counted unexposed(diagnosis, &evaluation::FrameAccount::never_exposed);
  const Counted unknown(diagnosis, &evaluation::FrameAccount::unknown);
  std::vector<std::string> parts;
  if (lost.all > 0) {
    parts.push_back(fmt::format("{} lost, most by {}", lost.text("frame"), lost.most_of));
  }
  if (unexposed.all > 0) {
    parts.push_back(fmt::format("{} without a frame, most of {}: never exposed",
                                unexposed.text("period"), unexposed.most_of));
  }
  if (unknown.all > 0) {
    parts.push_back(fmt::format("{} without a frame, most of {}: lost or never exposed",
                                unknown.text("period"), unknown.most_of));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

std::string slips_sentence(const Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const CameraDiagnosis& camera : diagnosis.cameras) {
    if (slips(camera)) names.push_back(fmt::format("{} ({})", camera.camera, camera.stream));
  }
  return (names.empty()
              ? std::string("No camera's stamps slip by whole frames")
              : fmt::format("The stamps of {} slip by whole frames", fmt::join(names, ", "))) +
         (missing_text(diagnosis).empty() ? "; no frame is missing." : ".");
}

// The worst that the verdict does not say itself.
const Finding* worst_beside_verdict(const Diagnosis& diagnosis) {
  const auto found = std::ranges::find_if(diagnosis.findings, [](const Finding& finding) {
    return !finding.in_verdict && finding.harm >= Harm::kSerious;
  });
  return found == diagnosis.findings.end() ? nullptr : &*found;
}

// What is wrong first, by harm: a finding, then the verdict, or the other way round.
std::string headline(const Diagnosis& diagnosis) {
  const std::string verdict = verdict_sentence(diagnosis.verdict);
  const std::string missing = missing_text(diagnosis);
  const std::string but = missing.empty() ? "" : fmt::format(" But {}.", missing);
  const Finding* worst = worst_beside_verdict(diagnosis);
  if (worst == nullptr) return verdict + but;
  const bool of_frames = worst->kind == "lost_frames" || worst->kind == "missing_frames" ||
                         worst->kind == "skipped_pulses";
  const auto of_verdict = std::ranges::find(diagnosis.findings, true, &Finding::in_verdict);
  const bool verdict_first =
      of_verdict != diagnosis.findings.end() && of_verdict->harm >= worst->harm;
  const std::string fault = capitalised(worst->text) + ".";
  return (verdict_first ? verdict + " " + fault : fault + " " + verdict) + (of_frames ? "" : but);
}

std::string resolution_sentence(const GroupVerdict& verdict) {
  if (std::isnan(verdict.resolution_ppm)) return "";
  constexpr double kMsPerMinutePerPpm = 0.06;
  return fmt::format(
      "These stamps show frame periods to {} ppm: cameras that drift apart by less than {} a "
      "minute look synchronised.",
      number_text(verdict.resolution_ppm), time_text(verdict.resolution_ppm * kMsPerMinutePerPpm));
}

// What each unknown is about, without its explanation.
std::string unknown_sentence(const std::vector<std::string>& unknowns) {
  std::vector<std::string> subjects;
  subjects.reserve(unknowns.size());
  for (const std::string& unknown : unknowns) {
    subjects.push_back(unknown.substr(0, unknown.find(':')));
  }
  if (subjects.empty()) return "";
  return fmt::format("Stamps alone cannot show {}.", fmt::join(subjects, ", nor "));
}

}  // namespace

AnswerText diagnose_answer(const Diagnosis& diagnosis) {
  if (diagnosis.groups.empty()) return {.lead = "There is no camera."};
  AnswerText answer{.lead = headline(diagnosis)};
  answer.add("Streams", streams_sentences(diagnosis));
  answer.add("Drift", drift_sentence(diagnosis));
  answer.add("Slips", slips_sentence(diagnosis));
  answer.add("Can tell", resolution_sentence(diagnosis.verdict));
  answer.add("Cannot tell", unknown_sentence(diagnosis.cannot_know));
  return answer;
}

}  // namespace simbench::reports

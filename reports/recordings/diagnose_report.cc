#include "reports/recordings/diagnose_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "recording/version.h"
#include "reports/recordings/clock_account_report.h"
#include "reports/recordings/diagnose_answer.h"
#include "reports/recordings/diagnose_figure.h"
#include "reports/text/answer_json.h"
#include "reports/text/json_node.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::CameraDiagnosis;
using evaluation::Diagnosis;
using evaluation::Finding;
using evaluation::FindingCertainty;
using evaluation::Follows;
using evaluation::GroupVerdict;
using evaluation::Harm;
using evaluation::PairDiagnosis;
using evaluation::ScaleKind;
using evaluation::SyncStatus;

constexpr std::size_t kMovesColumn = 7;  // of the cameras' table

const char* status_name(SyncStatus status) {
  switch (status) {
    case SyncStatus::kWorks:
      return "works";
    case SyncStatus::kWorksWithOffset:
      return "works_with_offset";
    case SyncStatus::kSlips:
      return "slips";
    case SyncStatus::kDoesNotWork:
      return "does_not_work";
    case SyncStatus::kCannotBeTold:
      break;
  }
  return "cannot_be_told";
}

const char* harm_name(Harm harm) {
  switch (harm) {
    case Harm::kStamps:
      return "stamps";
    case Harm::kFatal:
      return "fatal";
    case Harm::kSerious:
      return "serious";
    case Harm::kMinor:
      return "minor";
    case Harm::kNote:
      break;
  }
  return "note";
}

const char* certainty_name(FindingCertainty certainty) {
  switch (certainty) {
    case FindingCertainty::kCertain:
      return "certain";
    case FindingCertainty::kLikely:
      return "likely";
    case FindingCertainty::kPossible:
      break;
  }
  return "possible";
}

// Cause and evidence, how sure, what to do.
std::string finding_text(const Finding& finding) {
  std::string text = finding.text;
  if (finding.certainty != FindingCertainty::kCertain) {
    text += fmt::format(" ({})", certainty_name(finding.certainty));
  }
  return finding.advice.empty() ? text : fmt::format("{}. To do: {}", text, finding.advice);
}

const char* scale_name(ScaleKind kind) {
  switch (kind) {
    case ScaleKind::kUnixTime:
      return "arrivals";
    case ScaleKind::kShifted:
      return "shifted";
    case ScaleKind::kAhead:
      return "ahead";
    case ScaleKind::kBehind:
      return "behind";
    case ScaleKind::kOwnClock:
      break;
  }
  return "own_clock";
}

const char* follows_text(Follows follows) {
  switch (follows) {
    case Follows::kTrigger:
      return "the trigger";
    case Follows::kOwnClock:
      return "its own clock";
    case Follows::kOtherRate:
      return "another rate";
    case Follows::kHostOrOwn:
      return "its own or its host's clock";
    case Follows::kUnknown:
      break;
  }
  return "unknown";
}

const char* follows_name(Follows follows) {
  switch (follows) {
    case Follows::kTrigger:
      return "trigger";
    case Follows::kOwnClock:
      return "own_clock";
    case Follows::kOtherRate:
      return "other_rate";
    case Follows::kHostOrOwn:
      return "host_or_own";
    case Follows::kUnknown:
      break;
  }
  return "unknown";
}

// How a camera's phase moves.
Sparkline phase_sparkline(const CameraDiagnosis& camera, const Diagnosis& diagnosis) {
  const auto group = std::ranges::find(diagnosis.groups, camera.stream, &GroupVerdict::stream);
  if (group == diagnosis.groups.end()) return {};
  return {.kind = Sparkline::Kind::kSeries,
          .values = block_medians(phase_series(camera, group->period_ms)).y,
          .words = fmt::format("phase of {} over the recording: {} ms a minute", camera.camera,
                               number_text(camera.standing.moves_ms_per_minute))};
}

Table cameras_table(const Diagnosis& diagnosis) {
  Table table({{"camera", Align::kLeft},
               {"host", Align::kLeft},
               {"stream", Align::kLeft},
               {"frames"},
               {"rate\nHz"},
               {"follows", Align::kLeft},
               {"against the\nothers ppm"},
               {"moves ms\na minute"},
               {"phase\nms"},
               {"intervals\nsd ms"},
               {"lost\nframes"},
               {"never\nexposed"},
               {"unknown"},
               {"jumps"}},
              3);
  for (const CameraDiagnosis& camera : diagnosis.cameras) {
    const evaluation::StreamFacts& facts = camera.facts;
    const evaluation::Standing& standing = camera.standing;
    table.add({camera.camera, camera.host, camera.stream, count_text(facts.account.delivered),
               decimals_text(1000 / facts.host_period.period_ms, 3), follows_text(standing.follows),
               number_text(standing.rate_ppm), number_text(standing.moves_ms_per_minute),
               number_text(standing.phase_ms), number_text(facts.interval_jitter_ms),
               count_text(facts.account.lost), count_text(facts.account.never_exposed),
               count_text(facts.account.unknown),
               count_text(static_cast<std::int64_t>(facts.jumps.size()))});
    table.sparklines[kMovesColumn].push_back(phase_sparkline(camera, diagnosis));
  }
  return table;
}

Table pairs_table(const Diagnosis& diagnosis) {
  Table table({{"camera", Align::kLeft},
               {"stream", Align::kLeft},
               {"against", Align::kLeft},
               {"offset\nms"},
               {"spread\nms"},
               {"moves ms\na minute"},
               {.header = "is", .align = Align::kLeft, .is_verdict = true}},
              2);
  for (const PairDiagnosis& pair : diagnosis.pairs) {
    const char* const is = std::isnan(pair.offset_ms) ? "unknown"
                           : pair.runs_free           ? "free-running"
                                                      : "in step";
    table.add({pair.camera, pair.stream, pair.against, number_text(pair.offset_ms),
               number_text(pair.spread_ms), number_text(pair.moves_ms_per_minute), is});
  }
  return table;
}

Json verdict_json(const GroupVerdict& verdict) {
  return {{"stream", verdict.stream},
          {"status", status_name(verdict.status)},
          {"reason", verdict.reason},
          {"period_ms", verdict.period_ms},
          {"by_stamps", verdict.by_stamps},
          {"spread_ms", verdict.spread_ms},
          {"resolution_ppm", verdict.resolution_ppm}};
}

Json camera_json(const CameraDiagnosis& camera) {
  const evaluation::StreamFacts& facts = camera.facts;
  const evaluation::Standing& standing = camera.standing;
  Json jumps = Json::array();
  for (const evaluation::StampJump& jump : facts.jumps) {
    jumps.push_back({{"at_s", jump.at_s}, {"step_ms", jump.step_ms}, {"periods", jump.periods}});
  }
  Json segments = Json::array();
  for (const evaluation::PhaseSegment& segment : standing.segments) {
    segments.push_back({{"from_s", segment.from_s}, {"phase_ms", segment.phase_ms}});
  }
  return {{"camera", camera.camera},
          {"host", camera.host},
          {"stream", camera.stream},
          {"frames", facts.account.delivered},
          {"span_s", facts.span_s()},
          {"rate_hz", 1000 / facts.host_period.period_ms},
          {"period_ms", facts.period_ms},
          {"follows", follows_name(standing.follows)},
          {"period_multiple", standing.period_multiple},
          {"rate_ppm", standing.rate_ppm},
          {"rate_sd_ppm", standing.rate_sd_ppm},
          {"moves_ms_per_minute", standing.moves_ms_per_minute},
          {"phase_ms", standing.phase_ms},
          {"segments", segments},
          {"scale", scale_name(camera.scale.kind)},
          {"scale_shift_s", camera.scale.shift_s},
          {"delay_ms", camera.scale.delay_ms},
          {"delay_scatter_ms", facts.delay.scatter_ms},
          {"stamped_on_arrival", facts.stamped_on_arrival},
          {"exposure_ms", facts.columns.exposure_ms.middle},
          {"missing_share", facts.missing_share()},
          {"interval_jitter_ms", facts.interval_jitter_ms},
          {"on_grid_share", facts.on_grid_share},
          {"lost_frames", facts.account.lost},
          {"never_exposed_frames", facts.account.never_exposed},
          {"unknown_frames", facts.account.unknown},
          {"counter_restarts", facts.account.counter_restarts},
          {"counter_jumps", facts.account.counter_jumps},
          {"global_time", facts.global_time},
          {"backward_stamps", facts.backward_stamps},
          {"backward_arrivals", facts.backward_arrivals},
          {"future_stamps", facts.future_stamps},
          {"wraps", facts.wraps},
          {"longest_gap_s", facts.longest_gap_s},
          {"jumps", jumps}};
}

}  // namespace

const char* sync_status_text(SyncStatus status) {
  switch (status) {
    case SyncStatus::kWorks:
      return "works";
    case SyncStatus::kWorksWithOffset:
      return "works, with a constant offset";
    case SyncStatus::kSlips:
      return "slips";
    case SyncStatus::kDoesNotWork:
      return "does not work";
    case SyncStatus::kCannotBeTold:
      break;
  }
  return "cannot be determined";
}

Document diagnose_document(const Diagnosis& diagnosis) {
  Document document{.head = paragraphs(diagnose_answer(diagnosis))};
  std::vector<Block>& blocks = document.blocks;
  blocks.push_back({.heading = "The cameras", .table = cameras_table(diagnosis)});
  if (!diagnosis.pairs.empty()) {
    blocks.push_back(
        {.heading = "Streams of one camera against each other", .table = pairs_table(diagnosis)});
  }
  Block findings{.heading = "Findings"};
  for (const Finding& finding : diagnosis.findings) {
    findings.items.push_back(finding_text(finding));
  }
  if (findings.items.empty()) findings.items = {"none"};
  blocks.push_back(std::move(findings));
  for (Block& block : clock_account_blocks(diagnosis.clocks)) blocks.push_back(std::move(block));
  blocks.push_back({.heading = "What stamps alone cannot show", .items = diagnosis.cannot_know});
  blocks.push_back(
      {.heading = "How to read it",
       .items = {
           "follows: the trigger, if its frame period in host time is that of the others; "
           "free-running cameras differ by tens of ppm. phase: of the arrivals (of the stamps, "
           "where all are of one clock), relative to a camera that follows.",
           "intervals: deviation of the stamps from whole periods. lost: counted by the "
           "camera, never arrived. skipped: periods without a frame that its counter did not "
           "count."}});
  return document;
}

std::string diagnose_json(const Diagnosis& diagnosis, const std::vector<std::string>& files) {
  Json root = {{"schema_version", 1},
               {"version", version()},
               {"commit", commit()},
               {"files", files},
               {"answer", answer_json(diagnose_answer(diagnosis))},
               {"verdict", verdict_json(diagnosis.verdict)},
               {"streams", Json::array()},
               {"cameras", Json::array()},
               {"pairs", Json::array()},
               {"clocks", clock_account_json(diagnosis.clocks)},
               {"findings", Json::array()},
               {"cannot_know", diagnosis.cannot_know}};
  for (const GroupVerdict& group : diagnosis.groups) root["streams"].push_back(verdict_json(group));
  for (const CameraDiagnosis& camera : diagnosis.cameras) {
    root["cameras"].push_back(camera_json(camera));
  }
  for (const PairDiagnosis& pair : diagnosis.pairs) {
    root["pairs"].push_back({{"camera", pair.camera},
                             {"stream", pair.stream},
                             {"against", pair.against},
                             {"offset_ms", pair.offset_ms},
                             {"spread_ms", pair.spread_ms},
                             {"moves_ms_per_minute", pair.moves_ms_per_minute},
                             {"runs_free", pair.runs_free}});
  }
  for (const Finding& finding : diagnosis.findings) {
    root["findings"].push_back({{"camera", finding.camera},
                                {"stream", finding.stream},
                                {"kind", finding.kind},
                                {"harm", harm_name(finding.harm)},
                                {"certainty", certainty_name(finding.certainty)},
                                {"text", finding.text},
                                {"advice", finding.advice}});
  }
  // A file may name its cameras in bytes that are no UTF-8.
  return file_text(root);
}

}  // namespace simbench::reports

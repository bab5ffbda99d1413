#include "reports/certificates/certificate_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "recording/counted.h"
#include "recording/text_fields.h"
#include "reports/results/csv.h"
#include "reports/results/json.h"
#include "reports/text/answer_json.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::CertificateRow;
using evaluation::CertificateRun;
using evaluation::ContradictedCapture;
using evaluation::LinkKind;
using evaluation::WeakTie;

constexpr std::size_t kShownTies = 3;

std::string certified_text(double ms) { return std::isinf(ms) ? "unknown" : time_text(ms); }

std::string tie_name(const WeakTie& tie) {
  return tie.kind == LinkKind::kCamera ? fmt::format("camera {} to host {}", tie.first, tie.second)
                                       : fmt::format("host {} to host {}", tie.first, tie.second);
}

// What a tie is so wide for, and what would help.
std::string cure_text(const CertificateRow& row, const WeakTie& tie) {
  const bool is_camera = tie.kind == LinkKind::kCamera;
  if (!is_camera && std::isinf(tie.width_ms) && row.counts.estimated_exchanges > 0) {
    return "stamps that a host_sync estimated prove nothing: state --estimated-stamp-ms, or use a "
           "host_sync with the kernel's stamps";
  }
  if (!is_camera && std::isinf(tie.width_ms) && row.counts.unused_pulses > 0) {
    return "pulses prove nothing until it is known how late hosts see them: state --pulse-late-us";
  }
  if (std::isinf(tie.width_ms)) {
    return is_camera ? "nothing bounds it from both sides: record polls of the camera's clock"
                     : "no messages went both ways: record a host_sync that exchanges them";
  }
  if (tie.drift_share > 0.5) {
    return fmt::format("the nearest reading is {} away: {} more often", time_text(tie.age_s * 1e3),
                       is_camera ? "poll" : "exchange");
  }
  return fmt::format("its quickest {} count: {}", is_camera ? "polls" : "messages",
                     is_camera ? "poll over a quicker way, or state a least delay"
                               : "stamp in the kernel, or state a least delay");
}

std::string tie_text(const WeakTie& tie) {
  return std::isinf(tie.width_ms) ? tie_name(tie)
                                  : fmt::format("{}: {}", tie_name(tie), time_text(tie.width_ms));
}

std::string outside_text(const CertificateRow& row) {
  if (row.frames == 0) return "-";
  return fmt::format("{} of {}", row.frames_outside, row.frames);
}

// Whether pulses were due of which there is no set.
bool lacks_sets(const CertificateRow& row) { return row.apart_ms.size() < row.due_pulses; }

std::string sets_text(const CertificateRow& row) {
  const std::string sets = fmt::format("{}", row.apart_ms.size());
  return lacks_sets(row) ? fmt::format("{} of {}", sets, row.due_pulses) : sets;
}

Block certified_rows_block(const CertificateRun& run) {
  const std::vector<Field<CertificateRow>> fields = {
      pipeline_field<CertificateRow>(),
      {{"sets"}, sets_text},
      {{"certified\nmedian"},
       [](const auto& row) { return certified_text(row.certified_ms(0.5)); }},
      {{"certified\n95 %"}, [](const auto& row) { return certified_text(row.certified_ms(0.95)); }},
      {{"certified\nall"}, [](const auto& row) { return certified_text(row.certified_ms(1)); }},
      {{fmt::format("within\n{}", time_text(run.options.within_ms))},
       [](const auto& row) { return share_text(row.share_within()); }},
      {{"truth\noutside"}, outside_text},
      {{"captures\ncontradicted"},
       [](const auto& row) {
         return fmt::format("{} of {}", row.contradicted.size(), row.captures);
       }},
      {{"weakest tie", Align::kLeft}, [](const auto& row) {
         return row.weakest.empty() ? std::string("-") : tie_text(row.weakest.front());
       }}};
  return {.heading = "Certificates",
          .table = table_of(fields, run.rows),
          .prose = {
              "Certified: no two frames of a set were exposed further apart, whatever the delays "
              "were, if what is assumed holds; the least such bound that follows from the "
              "recording. Truth outside: frames of the sets whose true difference to another of "
              "their set is beyond its interval, which a wrong assumption can make. Contradicted: "
              "captures whose facts contradict each other. Sets: of two frames or more, of the "
              "pulses that all cameras were to expose where there are fewer."}};
}

Block ties_block(const CertificateRun& run) {
  Block block{.heading = "What ties the widest pairs"};
  for (const CertificateRow& row : run.rows) {
    for (std::size_t i = 0; i < std::min(kShownTies, row.weakest.size()); ++i) {
      const WeakTie& tie = row.weakest[i];
      block.items.push_back(fmt::format("{}: {}, in {} of {} sets; {}", row.pipeline, tie_text(tie),
                                        tie.sets, row.apart_ms.size(), cure_text(row, tie)));
    }
  }
  return block;
}

std::string possible_text(const ContradictedCapture& capture) {
  if (capture.possible_ppm == 0) {
    return "no rates up to 1000 ppm explain it: a stamp or a least delay is wrong";
  }
  return fmt::format("with rates of +-{:g} ppm nothing contradicts", capture.possible_ppm);
}

std::optional<Block> contradictions_block(const CertificateRun& run) {
  Block block{.heading = "Contradictions", .is_warning = true};
  for (const CertificateRow& row : run.rows) {
    if (row.contradicted.empty()) continue;
    const ContradictedCapture& first = row.contradicted.front();
    block.items.push_back(fmt::format("{}, seed {}: a chain of facts ends {} before it began; {}",
                                      row.pipeline, first.seed, time_text(first.before_ms),
                                      possible_text(first)));
    for (const std::string& fact : first.chain) block.items.push_back("  " + fact);
  }
  if (block.items.empty()) return std::nullopt;
  return block;
}

std::optional<Block> problems_block(const CertificateRun& run) {
  Block block{.heading = "Left out", .is_warning = true};
  for (const CertificateRow& row : run.rows) {
    if (!row.problem.empty()) {
      block.items.push_back(fmt::format("{}: {}", row.pipeline, row.problem));
      continue;
    }
    if (row.counts.estimated_exchanges > 0) {
      block.items.push_back(fmt::format(
          "{}: {} with stamps that its host_sync estimated; --estimated-stamp-ms states their "
          "error and lets them count",
          row.pipeline,
          counted(static_cast<std::uint64_t>(row.counts.estimated_exchanges), "exchange")));
    }
    if (row.counts.unused_pulses > 0) {
      block.items.push_back(fmt::format(
          "{}: {}; --pulse-late-us states how late hosts see them at most and lets them count",
          row.pipeline, counted(static_cast<std::uint64_t>(row.counts.unused_pulses), "pulse")));
    }
    if (row.counts.logged_outside > 0) {
      block.items.push_back(
          fmt::format("{}: {} of the logs from before or after the capture", row.pipeline,
                      counted(static_cast<std::uint64_t>(row.counts.logged_outside), "reading")));
    }
    if (row.lone_frames > 0) {
      block.items.push_back(
          fmt::format("{}: {} of one frame, which nothing is apart from", row.pipeline,
                      counted(static_cast<std::uint64_t>(row.lone_frames), "set")));
    }
    if (row.impossible_sets > 0) {
      block.items.push_back(
          fmt::format("{}: no pulses of one trigger explain {}", row.pipeline,
                      counted(static_cast<std::uint64_t>(row.impossible_sets), "set")));
    }
  }
  if (block.items.empty()) return std::nullopt;
  return block;
}

Block assumed_block(const CertificateRun& run) {
  Block block{.heading = "What is assumed"};
  for (const auto& line : evaluation::described(run.options.assumptions)) {
    block.items.push_back(fmt::format("{} = {:g}: {}", line.name, line.value, line.means));
  }
  if (run.options.horizon == evaluation::Horizon::kCausal) {
    block.prose.emplace_back("Each set knows only what came before its last exposure (--causal).");
  }
  return block;
}

// The row with the smallest bound for 95 % of its sets; null if none is bounded.
const CertificateRow* best_of(const CertificateRun& run) {
  const CertificateRow* best = nullptr;
  for (const CertificateRow& row : run.rows) {
    const double certified = row.certified_ms(0.95);
    if (!std::isfinite(certified)) continue;
    if (best == nullptr || certified < best->certified_ms(0.95)) best = &row;
  }
  return best;
}

std::string truth_text(const CertificateRun& run) {
  std::size_t frames = 0, outside = 0;
  for (const CertificateRow& row : run.rows) {
    frames += row.frames;
    outside += row.frames_outside;
  }
  if (frames == 0) return {};
  if (outside == 0)
    return fmt::format("it lies within for all {} frames that have a bound.", frames);
  return fmt::format(
      "it lies outside for {} of {} frames that have a bound: an assumption is wrong there, and "
      "nothing in the recording contradicts it.",
      outside, frames);
}

std::string contradicted_text(const CertificateRun& run) {
  std::size_t captures = 0;
  for (const CertificateRow& row : run.rows) captures += row.contradicted.size();
  if (captures == 0) return {};
  return fmt::format(
      "{} {} no certificates: what is recorded contradicts what is assumed; see below.",
      counted(static_cast<std::uint64_t>(captures), "capture"), captures == 1 ? "has" : "have");
}

// Why no row has a bound.
std::string nothing_text(const CertificateRun& run) {
  const bool is_contradicted = std::ranges::all_of(run.rows, [](const CertificateRow& row) {
    return !row.contradicted.empty() && row.contradicted.size() == row.captures;
  });
  return is_contradicted ? "Nothing is certified: what is assumed contradicts every recording."
                         : "Nothing is certified: no pipeline's recording bounds how far the "
                           "frames of its sets are apart.";
}

Json finite_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json tie_json(const WeakTie& tie) {
  return {{"tie", tie.kind == LinkKind::kCamera ? "camera" : "hosts"},
          {"first", tie.first},
          {"second", tie.second},
          {"sets", tie.sets},
          {"width_ms", finite_json(tie.width_ms)},
          {"age_s", finite_json(tie.age_s)},
          {"drift_share", finite_json(tie.drift_share)}};
}

Json certified_row_json(const CertificateRow& row) {
  Json json = {{"pipeline", row.pipeline},
               {"problem", row.problem.empty() ? Json(nullptr) : Json(row.problem)},
               {"captures", row.captures},
               {"sets", row.apart_ms.size()},
               {"due_pulses", row.due_pulses == 0 ? Json(nullptr) : Json(row.due_pulses)},
               {"certified_ms",
                {{"p50", finite_json(row.certified_ms(0.5))},
                 {"p95", finite_json(row.certified_ms(0.95))},
                 {"max", finite_json(row.certified_ms(1))}}},
               {"within", row.within},
               {"within_share", finite_json(row.share_within())},
               {"messages", row.counts.messages},
               {"unusable_messages", row.counts.unusable_messages},
               {"estimated_exchanges", row.counts.estimated_exchanges},
               {"polls", row.counts.polls},
               {"pulses", row.counts.pulses},
               {"unused_pulses", row.counts.unused_pulses},
               {"logged_outside", row.counts.logged_outside},
               {"frames", row.frames == 0 ? Json(nullptr) : Json(row.frames)},
               {"truth_outside", row.frames == 0 ? Json(nullptr) : Json(row.frames_outside)},
               {"impossible_sets", row.impossible_sets},
               {"lone_frames", row.lone_frames}};
  json["weakest"] = Json::array();
  for (const WeakTie& tie : row.weakest) json["weakest"].push_back(tie_json(tie));
  json["contradicted"] = Json::array();
  for (const ContradictedCapture& capture : row.contradicted) {
    json["contradicted"].push_back(
        {{"seed", capture.seed},
         {"before_ms", capture.before_ms},
         {"chain", capture.chain},
         {"possible_ppm", capture.possible_ppm == 0 ? Json(nullptr) : Json(capture.possible_ppm)}});
  }
  return json;
}

}  // namespace

AnswerText certificate_answer(const CertificateRun& run) {
  AnswerText answer;
  const CertificateRow* const best = best_of(run);
  if (best == nullptr) {
    answer.lead = nothing_text(run);
  } else {
    answer.lead = fmt::format(
        "{}: in 95 % of its sets no two frames were exposed more than {} "
        "apart, whatever the delays were.",
        best->pipeline, time_text(best->certified_ms(0.95)));
    const WeakTie& tie = best->weakest.front();
    answer.add("Weakest", fmt::format("{}; {}.", tie_text(tie), cure_text(*best, tie)));
    if (lacks_sets(*best)) {
      answer.add("Missing", fmt::format("it has sets of {} of {} pulses due; of the others nothing "
                                        "is certified.",
                                        best->apart_ms.size(), best->due_pulses));
    }
  }
  answer.add("Truth", truth_text(run));
  answer.add("Contradictions", contradicted_text(run));
  return answer;
}

Document certificate_document(const CertificateRun& run) {
  Document document{.title = fmt::format("{}: {}", scenarios::named(run.scenario, run.derivation),
                                         counted_seeds(run.options.first_seed, run.options.seeds))};
  document.head = paragraphs(certificate_answer(run));
  std::ranges::move(scenarios::derivation_lines(run.derivation), std::back_inserter(document.head));
  document.blocks.push_back(certified_rows_block(run));
  add(contradictions_block(run), document.blocks);
  add(problems_block(run), document.blocks);
  document.blocks.push_back(ties_block(run));
  document.blocks.push_back(assumed_block(run));
  return document;
}

std::string pairs_csv(const CertificateRun& run) {
  std::string text =
      "pipeline,seed,set,first_camera,first_sensor_us,second_camera,second_sensor_us,least_ms,"
      "most_ms,truth_ms";
  const LineEnds ends(run.derivation);
  text += ends.header;
  constexpr std::int64_t kNanosecondsAMicrosecond = 1000;
  const auto us = [](DeviceTime sensor) {
    return nanoseconds_of(sensor) / kNanosecondsAMicrosecond;
  };
  for (const CertificateRow& row : run.rows) {
    const std::string pipeline = csv_cell(row.pipeline);
    for (const evaluation::CertifiedPair& pair : row.pairs) {
      text += fmt::format("{},{},{},{},{},{},{},{},{},{}{}", pipeline, pair.seed, pair.set,
                          pair.first_camera, us(pair.first_sensor), pair.second_camera,
                          us(pair.second_sensor), csv_cell(pair.least_ms), csv_cell(pair.most_ms),
                          pair.truth_ms ? csv_cell(*pair.truth_ms) : "", ends.line);
    }
  }
  return text;
}

Json certificate_json(const CertificateRun& run) {
  Json root = new_document();
  root["answer"] = answer_json(certificate_answer(run));
  root["scenario"] = run.scenario;
  state_derivation(run.derivation, root);
  root["seeds"] = {{"first", run.options.first_seed}, {"count", run.options.seeds}};
  root["horizon"] = run.options.horizon == evaluation::Horizon::kWhole ? "whole" : "causal";
  root["within_ms"] = run.options.within_ms;
  root["assumptions"] = Json::object();
  for (const auto& line : evaluation::described(run.options.assumptions)) {
    root["assumptions"][line.name] = line.value;
  }
  root["rows"] = Json::array();
  for (const CertificateRow& row : run.rows) root["rows"].push_back(certified_row_json(row));
  return root;
}

}  // namespace simbench::reports

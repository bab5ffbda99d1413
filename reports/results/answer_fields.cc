#include "reports/results/answer_fields.h"

#include <cmath>

#include "reports/results/lever_text.h"
#include "reports/text/answer_json.h"

namespace simbench::reports {
namespace {

using evaluation::Answer;
using evaluation::ComparedRow;
using evaluation::Row;

Json next_json(const Answer& answer) {
  if (!answer.next) return nullptr;
  const evaluation::Estimate& ratio = answer.next->to_best.ratio;
  return {{"pipeline", answer.next->row->pipeline},
          {"times", ratio.value},
          {"times_interval",
           std::isnan(ratio.low) ? Json() : Json(Json::array({ratio.low, ratio.high}))}};
}

Json pulses_json(const Row* best) {
  if (best == nullptr || !best->verified() || best->sets.due_pulses == 0) return nullptr;
  const evaluation::SetCounts& counts = best->sets;
  return {{"due", counts.due_pulses},
          {"exposed", counts.exposed_pulses},
          {"delivered", counts.complete_pulses},
          {"whole", counts.pure},
          {"sets", counts.emitted},
          {"mixed_sets", counts.emitted - counts.pure}};
}

}  // namespace

Json answer_with_fields(const Answer& answer, const AnswerText& text,
                        const evaluation::Levers* levers) {
  Json all = answer_json(text);
  all["ranked_by"] = evaluation::ranked_metric(answer.ranked_by).id;
  all["ranked"] = answer.ranked;
  all["best"] = answer.best != nullptr ? Json(answer.best->pipeline) : Json();
  all["not_told_apart"] = Json::array();
  for (const ComparedRow& each : answer.not_told_apart) {
    all["not_told_apart"].push_back(each.row->pipeline);
  }
  all["too_few_seeds"] = answer.seeds_needed > 0;
  all["seeds_needed"] = answer.seeds_needed > 0 ? Json(answer.seeds_needed) : Json();
  all["next"] = next_json(answer);
  all["failed"] = Json::array();
  for (const evaluation::FailedRow& each : answer.failed) {
    all["failed"].push_back({{"pipeline", each.row->pipeline}, {"reason", each.reason}});
  }
  all["limit"] = nullptr;
  if (answer.limit) {
    all["limit"] = {{"pipeline", answer.limit->row->pipeline}, {"times", answer.times_limit}};
  }
  all["known_within"] = answer.known_within ? Json(*answer.known_within) : Json();
  all["pulses"] = pulses_json(answer.best);
  all["levers"] = levers == nullptr ? Json() : levers_json(*levers, answer.ranked_by);
  all["levers_seeds"] = levers == nullptr ? Json() : Json(levers->seeds);
  return all;
}

}  // namespace simbench::reports

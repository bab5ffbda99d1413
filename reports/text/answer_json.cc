#include "reports/text/answer_json.h"

namespace simbench::reports {

Json answer_json(const AnswerText& answer) {
  if (answer.lead.empty()) return nullptr;
  Json all = {{"lead", answer.lead}, {"lines", Json::array()}};
  for (const AnswerPoint& point : answer.points) {
    all["lines"].push_back({{"label", point.label}, {"text", point.text}});
  }
  return all;
}

}  // namespace simbench::reports

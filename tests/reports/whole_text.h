// All sentences of an answer in a row, without the labels: for tests of what it says.
#pragma once

#include <string>

#include "reports/text/answer_text.h"

namespace simbench::reports {

inline std::string whole_text(const AnswerText& answer) {
  std::string text = answer.lead;
  for (const AnswerPoint& point : answer.points) text.append(" ").append(point.text);
  return text;
}

}  // namespace simbench::reports

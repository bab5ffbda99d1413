#include "reports/text/answer_text.h"

#include <fmt/format.h>

#include <utility>

#include "reports/text/escaped_text.h"

namespace simbench::reports {

void AnswerText::add(std::string label, std::string text) {
  if (!text.empty()) points.push_back({std::move(label), std::move(text)});
}

std::vector<std::string> paragraphs(const AnswerText& answer) {
  if (answer.lead.empty()) return {};
  std::string text = answer.lead;
  for (const AnswerPoint& point : answer.points) text.append(" ").append(point.text);
  return {std::move(text)};
}

std::string html(const AnswerText& answer) {
  if (answer.lead.empty()) return "";
  std::string points;
  for (const AnswerPoint& point : answer.points) {
    points += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", html_escaped(point.label),
                          html_escaped(point.text));
  }
  if (!points.empty()) points = fmt::format("<dl>\n{}</dl>\n", points);
  return fmt::format("<section class=\"answer\" aria-label=\"Answer\">\n<p>{}</p>\n{}</section>\n",
                     html_escaped(answer.lead), points);
}

}  // namespace simbench::reports

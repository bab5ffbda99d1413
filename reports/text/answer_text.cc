#include "reports/text/answer_text.h"

#include <fmt/format.h>

#include <utility>

#include "recording/counted.h"
#include "reports/text/escaped_text.h"

namespace simbench::reports {

std::string few_seeds_text(std::size_t seeds, std::string_view whose) {
  return fmt::format("{}{} {} little about other worlds", counted(seeds, "seed"), whose,
                     seeds == 1 ? "says" : "say");
}

void AnswerText::add(std::string label, std::string text) {
  if (!text.empty()) points.push_back({std::move(label), std::move(text)});
}

std::vector<std::string> paragraphs(const AnswerText& answer) {
  if (answer.lead.empty()) return {};
  std::vector<std::string> lines = {answer.lead};
  for (const AnswerPoint& point : answer.points) {
    lines.push_back(fmt::format("{}: {}", point.label, point.text));
  }
  return lines;
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

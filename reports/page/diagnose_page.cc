#include "reports/page/diagnose_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "reports/archive/archive.h"
#include "reports/page/html_page.h"
#include "reports/recordings/diagnose_answer.h"
#include "reports/recordings/diagnose_figure.h"
#include "reports/recordings/diagnose_report.h"

namespace simbench::reports {

std::string diagnose_html(const DiagnosePage& page) {
  const std::string inputs = fmt::format("{}", fmt::join(page.inputs, ", "));
  const Figure figure = diagnose_figure(page.diagnosis);
  const HtmlArticle article = {
      .name = inputs,
      .heading = inputs,
      .answer = diagnose_answer(page.diagnosis),
      .lead_figures = {figure.id},
      .body = html(diagnose_document(page.diagnosis).blocks),
      .reproduce =
          fmt::format("<dl>\n{}</dl>\n", html_command("All of this", simbench_line(page.command)))};
  return html_page({.title = fmt::format("simbench diagnose {}", inputs),
                    .subtitle = "does the hardware sync of this rig work",
                    .main = html_article(article),
                    .data = {figures_json({figure})}});
}

}  // namespace simbench::reports

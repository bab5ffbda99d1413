#include "reports/paper/paper_page.h"

#include <fmt/format.h>

#include <utility>

#include "recording/version.h"
#include "reports/page/html_page.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

constexpr const char* kPaper =
    "Yoon, Jang, Huh, Kang and Lee, Multiple Sensor Synchronization with the RealSense RGB-D "
    "Camera, Sensors 2021, 21(18), 6276, doi 10.3390/s21186276.";

std::string about_paper(const PaperResults& results) {
  const evaluation::Results& seeds = results.at_15_fps.results;
  return html_paragraph("summary", kPaper) +
         html_paragraph("provenance", fmt::format("{} of each rate, simbench {} ({})",
                                                  counted_seeds(seeds.first_seed, seeds.seed_count),
                                                  version(), commit()));
}

ReportFront front_of(const PaperPage& page) {
  const std::vector<Block> blocks = paper_document(page.results).blocks;
  const std::vector<Block> tables(blocks.begin(), blocks.begin() + 2);
  const std::vector<Block> rest(blocks.begin() + 2, blocks.end());
  return {
      .article = {.name = "the paper",
                  .heading = "Yoon et al. 2021",
                  .answer = paper_answer(page.results),
                  .summary = html(tables),
                  .about = about_paper(page.results),
                  .body = html(rest),
                  .has_more_figures = !page.results.figures.empty(),
                  .reproduce = fmt::format(
                      "<dl>\n{}</dl>\n", html_command("All of this", simbench_line(page.command)))},
      .figures = page.results.figures,
      .title = "simbench paper",
      .subtitle = "what the paper measured, beside what is printed"};
}

}  // namespace

std::string paper_html(PaperPage page) {
  ReportFront front = front_of(page);
  return html_report({.archives = std::move(page.archives),
                      .command = std::move(page.command),
                      .front = std::move(front)});
}

}  // namespace simbench::reports

#include "reports/page/sweep_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "recording/version.h"
#include "reports/archive/archive.h"
#include "reports/page/html_page.h"
#include "reports/sweep/sweep_parts.h"
#include "reports/text/json_node.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

// "/hosts/count=2,4+/cameras/count=6,12", as --sweep takes it.
std::string axis_text(const evaluation::SweepAxis& axis) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < axis.pointers.size(); ++i) {
    parts.push_back(fmt::format("{}={}", axis.pointers[i], fmt::join(axis.values[i], ",")));
  }
  return fmt::format("{}", fmt::join(parts, "+"));
}

std::string repeating_line(const evaluation::SweepPlan& plan) {
  std::vector<std::string> words = {"simbench", "sweep", "--scenario", "FILE"};
  for (const evaluation::SweepAxis& axis : plan.axes) {
    words.insert(words.end(), {"--sweep", axis_text(axis)});
  }
  if (of_clocks(plan)) {
    words.insert(words.end(), {"--clocks", "--from-s", std::to_string(plan.clock_period.from_s),
                               "--duration-s", std::to_string(plan.clock_period.duration_s)});
  }
  words.insert(words.end(), {"--pipelines", fmt::format("{}", fmt::join(plan.pipelines, ",")),
                             "--seeds", std::to_string(plan.seeds), "--first-seed",
                             std::to_string(plan.first_seed), "--output", "DIR"});
  return shell_line(words);
}

std::string about_sweep(const evaluation::SweepPlan& plan) {
  std::string about;
  for (const std::string& line : scenarios::derivation_lines(plan.derivation)) {
    about += html_paragraph("provenance", line);
  }
  return about +
         html_paragraph("provenance", fmt::format("{} at each point, simbench {} ({})",
                                                  counted_seeds(plan.first_seed, plan.seeds),
                                                  version(), commit()));
}

}  // namespace

std::string sweep_html(const SweepPage& page) {
  const evaluation::SweepPlan& plan = page.plan;
  const HtmlArticle article = {
      .name = plan.scenario,
      .heading = scenarios::named(plan.scenario, plan.derivation),
      .answer = page.answer,
      .lead_figures = {page.figures.front().id},
      .about = about_sweep(plan),
      .body = html(page.blocks),
      .has_more_figures = page.figures.size() > 1,
      .reproduce =
          fmt::format("<dl>\n{}</dl>\n", html_command("All of this", repeating_line(plan))) +
          html_scenario("Saved to a file, it is the FILE of the command above.",
                        Json::parse(plan.scenario_json).dump(2))};
  return html_page({.title = fmt::format("simbench sweep {}", plan.scenario),
                    .subtitle = "how do these pipelines respond to what is varied",
                    .main = html_article(article),
                    .data = {figures_json(page.figures)}});
}

}  // namespace simbench::reports

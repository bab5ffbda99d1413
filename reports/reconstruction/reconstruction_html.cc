#include "reports/reconstruction/reconstruction_html.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "reconstruction/paint.h"
#include "recording/version.h"
#include "reports/page/html_columns.h"
#include "reports/page/html_figures.h"
#include "reports/page/html_page.h"
#include "reports/reconstruction/reconstruction_figure.h"
#include "reports/reconstruction/reconstruction_text.h"
#include "reports/text/html_text.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using reconstruction::ReconstructionResults;
using reconstruction::ReprojectionRow;
using reconstruction::SeedReprojection;
using scenarios::PublishedReprojection;
using HtmlAlign = HtmlTable::Align;

std::string section(std::string_view heading, const std::string& content) {
  return fmt::format("<section>\n<h3>{}</h3>\n{}</section>\n", html_escaped(heading), content);
}

std::string html_total(const ReprojectionRow& row, std::int64_t SeedReprojection::*member) {
  std::int64_t sum = 0;
  for (const SeedReprojection& seed : row.seeds) sum += seed.*member;
  return count_text(sum);
}

std::string html_table_4(const ReconstructionResults& results) {
  HtmlTable table("Reprojection error", {{"pipeline", HtmlAlign::kLeft},
                                         {"mean error, cm"},
                                         {"published mean, cm"},
                                         {"standard deviation, cm"},
                                         {"published standard deviation, cm"},
                                         {"median, cm"},
                                         {"95 %, cm"}});
  for (const ReprojectionRow& row : results.rows) {
    table.add({row.pipeline, cm_text(row.mean_cm()),
               published_text(row.published, &PublishedReprojection::mean_cm, row.mean_cm()),
               cm_text(row.std_cm()),
               published_text(row.published, &PublishedReprojection::std_cm, row.std_cm()),
               cm_text(row.median_cm().median), cm_text(row.p95_cm().median)});
  }
  return table.html();
}

std::string html_sets_table(const ReconstructionResults& results) {
  HtmlTable table("How it came about", {{"pipeline", HtmlAlign::kLeft},
                                        {"desynchronisation, ms"},
                                        {"seeds without a gathered set"},
                                        {"sets"},
                                        {"failed"},
                                        {"missing frames"}});
  for (const ReprojectionRow& row : results.rows) {
    table.add({row.pipeline, ms_text(row.desync_ms()), share_text(no_gathered_set_share(row)),
               html_total(row, &SeedReprojection::sets),
               html_total(row, &SeedReprojection::failed_sets),
               html_total(row, &SeedReprojection::missing_frames)});
  }
  return table.html();
}

std::string error_section(const ReconstructionResults& results) {
  std::string text = html_table_4(results) + html_sets_table(results);
  std::string legend = fmt::format("{} {}", kErrorLegend, kDesyncLegend);
  if (const auto ratio = published_ratio(results.rows)) {
    text += html_paragraph("summary", ratio_sentence(*ratio));
    legend += fmt::format(" {}", kPublishedLegend);
  }
  if (results.speed_needed)
    text += html_paragraph("summary", speed_sentence(*results.speed_needed));
  return section("Reprojection error", text + html_paragraph("legend", legend));
}

std::string css_colour(double error_m) {
  const Eigen::Vector3f colour = reconstruction::error_colour(error_m);
  const auto part = [](float value) { return std::lround(value * 255); };
  return fmt::format("rgb({} {} {})", part(colour.x()), part(colour.y()), part(colour.z()));
}

std::string colour_scale() {
  constexpr int kSteps = 20;
  std::string stops;
  for (int i = 0; i <= kSteps; ++i) {
    stops += fmt::format(", {}", css_colour(reconstruction::kPaintedUpTo * i / kSteps));
  }
  return fmt::format(
      "<div class=\"colour-scale\"><span>0 cm</span><div role=\"img\" aria-label=\"colour of the "
      "error\" style=\"background: linear-gradient(to right{})\"></div><span>{:g} cm and "
      "more</span></div>\n",
      stops, reconstruction::kPaintedUpTo * 100);
}

std::string picture_html(const ReconstructionPicture& picture) {
  const std::string caption = fmt::format(
      "{}: {} ms of desynchronisation, error {} cm ± {} cm", picture.pipeline,
      ms_text(picture.desync_ms), cm_text(picture.errors.mean_cm), cm_text(picture.errors.std_cm));
  return fmt::format(
      "<figure class=\"mesh\"><img src=\"data:image/png;base64,{0}\" alt=\"reconstructed mesh of "
      "{1}\"><figcaption>{1}</figcaption></figure>\n",
      base64(picture.png), html_escaped(caption));
}

// In the order of the table.
std::string pictures_html(const ReconstructionPage& page) {
  if (page.pictures.empty()) return "";
  std::string pictures;
  for (const ReprojectionRow& row : page.results.rows) {
    for (const ReconstructionPicture& picture : page.pictures) {
      if (picture.pipeline == row.pipeline) pictures += picture_html(picture);
    }
  }
  return section("What the reconstruction looks like",
                 fmt::format("<div class=\"meshes\">\n{}</div>\n{}{}", pictures, colour_scale(),
                             html_paragraph("legend",
                                            "One frame set of the first seed each, after the "
                                            "paper's Figure 1: a vertex has the colour of its mean "
                                            "error, grey where no camera sees it.")));
}

std::string limits_html(const ReconstructionResults& results) {
  if (results.curve.empty()) return "";
  HtmlTable table("How good must my synchronisation be", {{"speed", HtmlAlign::kLeft},
                                                          {"floor, cm"},
                                                          {"desynchronisation up to, ms"},
                                                          {"cost there, cm/ms"}});
  for (const SyncLimit& limit : sync_limits(results.curve)) {
    table.add({speed_text(limit.speed_m_per_s, limit.speed_factor), cm_text(limit.floor_cm),
               limit_text(limit), cost_text(limit)});
  }
  return section("How good must my synchronisation be for my subject?",
                 table.html() + html_paragraph("legend", kLimitLegend));
}

std::string stages_html(const ReconstructionResults& results) {
  HtmlTable table("Pipelines", {{"pipeline", HtmlAlign::kLeft},
                                {"host_sync", HtmlAlign::kLeft},
                                {"device_time", HtmlAlign::kLeft},
                                {"gathering", HtmlAlign::kLeft}});
  for (const ReprojectionRow& row : results.rows) {
    table.add({row.pipeline, row.host_sync, row.device_time, row.gathering});
  }
  return section("Pipelines", table.html());
}

std::vector<std::string> html_row_notes(const ReconstructionResults& results) {
  std::vector<std::string> notes;
  for (const ReprojectionRow& row : results.rows) {
    for (const std::string& note : row.notes) {
      notes.push_back(fmt::format("{}: {}", row.pipeline, note));
    }
  }
  return notes;
}

std::string reproduce_html(const ReconstructionPage& page) {
  std::string text =
      fmt::format("<dl>\n{}</dl>\n", html_command("All of this", simbench_line(page.command)));
  if (!page.results.scenario.resolved_json.empty()) {
    text += fmt::format(
        "<details><summary>The resolved scenario</summary>\n<pre class=\"scroll\" "
        "tabindex=\"0\">{}</pre>\n</details>\n",
        html_escaped(page.results.scenario.resolved_json));
  }
  return fmt::format("<section class=\"reproduce\"><h3>How to reproduce it</h3>\n{}</section>\n",
                     text);
}

std::string provenance_line(const ReconstructionResults& results) {
  return fmt::format(
      "{} {} from {} on, {} frame {} each, simbench {} ({}); {:.1f} s, {:.1f} s for "
      "a frame set on one thread",
      results.seeds, results.seeds == 1 ? "seed" : "seeds", results.first_seed, results.frames,
      results.frames == 1 ? "set" : "sets", version(), commit(), results.wall_s,
      results.seconds_per_set);
}

}  // namespace

std::string reconstruction_html(const ReconstructionPage& page) {
  const ReconstructionResults& results = page.results;
  const std::string& name = results.scenario.name;
  const std::string main = fmt::format(
      "<article class=\"archive\" data-archive=\"0\" data-name=\"{0}\">\n<h2>{0}</h2>\n{1}{2}{3}{4}"
      "{5}{6}{7}<h3>Figures</h3>\n<div class=\"figures\"></div>\n{8}{9}</article>\n",
      html_escaped(name), html_paragraph("summary", results.scenario.summary),
      html_paragraph("provenance", provenance_line(results)), error_section(results),
      html_notes(html_row_notes(results)), pictures_html(page), limits_html(results),
      section("What was simulated", html_notes(honest_notes(results))), stages_html(results),
      reproduce_html(page));
  return html_page({.title = fmt::format("simbench reconstruct {}", name),
                    .subtitle = "what desynchronisation costs a reconstruction",
                    .main = main,
                    .data = {figures_json({reconstruction_figure(results)})}});
}

}  // namespace simbench::reports

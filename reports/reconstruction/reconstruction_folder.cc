#include "reports/reconstruction/reconstruction_folder.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "reconstruction/reprojection.h"
#include "recording/version.h"
#include "reports/figures/figure.h"
#include "reports/figures/gnuplot.h"
#include "reports/page/html_page.h"
#include "reports/reconstruction/reconstruction_document.h"
#include "reports/text/escaped_text.h"
#include "reports/text/number_text.h"
#include "reports/text/plain_text.h"

namespace simbench::reports {
namespace {

using reconstruction::ReconstructionResults;
using reconstruction::ReprojectionRow;

std::string section(std::string_view heading, const std::string& content) {
  return fmt::format("<section>\n<h3>{}</h3>\n{}</section>\n", html_escaped(heading), content);
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
  const std::string caption =
      fmt::format("{}: {} ms of desynchronisation, error {} cm ± {} cm", picture.pipeline,
                  desync_text(picture.desync_ms), cm_text(picture.errors.mean_cm),
                  cm_text(picture.errors.std_cm));
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

std::string reproduce_html(const ReconstructionPage& page) {
  std::string text =
      fmt::format("<dl>\n{}</dl>\n", html_command("All of this", simbench_line(page.command)));
  const std::string scenario = page.results.scenario.resolved_json();
  return scenario.empty() ? text : text + html_scenario("", scenario);
}

std::string reconstruction_line(const ReconstructionResults& results) {
  return fmt::format("{}, {} each, simbench {} ({})",
                     counted_seeds(results.first_seed, results.seeds),
                     counted(results.frames, "frame set"), version(), commit());
}

std::string file_name(const std::string& pipeline) {
  std::string name = pipeline;
  for (char& c : name) {
    const bool allowed = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                         (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
    if (!allowed) c = '_';
  }
  if (name.front() == '.') name.front() = '_';
  return name;
}

std::vector<std::string> own_files(const std::map<std::string, std::string>& names) {
  std::vector<std::string> files = {"table.txt", "scenario.json", "curve.csv", "curve.svg",
                                    "report.html"};
  for (const auto& [pipeline, name] : names) {
    files.push_back(name + ".ply");
    files.push_back(name + ".png");
  }
  return files;
}

}  // namespace

std::string reconstruction_html(const ReconstructionPage& page) {
  const ReconstructionResults& results = page.results;
  const std::string& name = results.scenario.name;
  const std::vector<Block> blocks = reconstruction_document(results).blocks;
  const scenarios::Derivation& derivation = results.scenario.derivation;
  std::string about = html_paragraph("summary", results.scenario.summary);
  for (const std::string& line : scenarios::derivation_lines(derivation)) {
    about += html_paragraph("provenance", line);
  }
  about += html_paragraph("provenance", reconstruction_line(results));
  const Figure figure = reconstruction_figure(results);
  const HtmlArticle article = {
      .name = name,
      .heading = scenarios::named(name, derivation),
      .answer = reconstruction_answer(results),
      .lead_figures = {figure.id},
      .summary = html(blocks.front()),
      .about = about,
      .body = pictures_html(page) + html(std::vector<Block>(blocks.begin() + 1, blocks.end())),
      .reproduce = reproduce_html(page)};
  return html_page({.title = fmt::format("simbench reconstruct {}", name),
                    .subtitle = "what desynchronisation costs a reconstruction",
                    .main = html_article(article),
                    .data = {figures_json({figure})}});
}

std::map<std::string, std::string> mesh_names(const scenarios::Scenario& scenario) {
  std::map<std::string, std::string> names;
  std::set<std::string> taken;
  for (const scenarios::Pipeline& pipeline : scenario.pipelines) {
    const std::string name = file_name(pipeline.name);
    std::string unique = name;
    for (int i = 2; !taken.insert(unique).second; ++i) unique = fmt::format("{}_{}", name, i);
    names[pipeline.name] = unique;
  }
  return names;
}

ReconstructionFolder::ReconstructionFolder(const std::string& path,
                                           const scenarios::Scenario& scenario)
    : names_(mesh_names(scenario)), output_(path, own_files(names_)) {}

void ReconstructionFolder::keep(const reconstruction::ShownMesh& mesh) {
  const std::string& name = names_.at(mesh.pipeline);
  const std::string png(mesh.png.begin(), mesh.png.end());
  output_.file(name + ".ply") << mesh.ply;
  output_.file(name + ".png") << png;
  pictures_.push_back(
      {.pipeline = mesh.pipeline, .png = png, .desync_ms = mesh.desync_ms, .errors = mesh.errors});
}

std::string ReconstructionFolder::write(const ReconstructionResults& results,
                                        const Provenance& provenance) {
  const Figure figure = reconstruction_figure(results);
  std::string not_drawn;
  output_.file("manifest.json") << manifest_json(provenance, {{"kind", "reconstruction"}});
  output_.file("scenario.json") << results.scenario.resolved_json();
  {
    const FilePage page;
    output_.file("table.txt") << plain(reconstruction_document(results));
  }
  output_.file("results.json") << reconstruction_json(results);
  if (!figure.panels.empty()) {
    output_.file("curve.csv") << figure_csv(figure);
    std::string svg;
    try {
      svg = drawn_svg(figure);
    } catch (const OutputError& error) {
      not_drawn = fmt::format("curve.svg was not drawn: {}", error.what());
    }
    if (!svg.empty()) output_.file("curve.svg") << svg;
  }
  output_.file("report.html") << reconstruction_html(
      {.results = results, .pictures = pictures_, .command = provenance.command});
  output_.publish();
  return not_drawn;
}

}  // namespace simbench::reports

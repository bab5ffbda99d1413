#include "reports/reconstruction/reconstruction_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "reports/figures/figure_csv.h"
#include "reports/figures/gnuplot.h"
#include "reports/reconstruction/reconstruction_document.h"
#include "reports/reconstruction/reconstruction_json.h"
#include "reports/text/plain_text.h"

namespace simbench::reports {
namespace {

using reconstruction::ReconstructionResults;

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

std::string table_for_file(const ReconstructionResults& results) {
  const FilePage page;
  return plain(reconstruction_document(results));
}

}  // namespace

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
  output_.file("manifest.json") << manifest_json(provenance, R"({"kind": "reconstruction"})");
  output_.file("scenario.json") << results.scenario.resolved_json;
  output_.file("table.txt") << table_for_file(results);
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

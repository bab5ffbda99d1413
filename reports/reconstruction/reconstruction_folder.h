// The folder that `simbench reconstruct -o` writes: Table 4, the meshes and their pictures, the
// curve, the page. It appears whole or not at all (reports/text/output_file.h).
//
//   manifest.json           version, commit, command, start and end
//   scenario.json           the resolved scenario: repeats the experiment
//   table.txt               reports/reconstruction/reconstruction_document.h
//   results.json            reports/reconstruction/reconstruction_document.h
//   PIPELINE.ply, .png      a mesh painted with its errors, and its picture; other characters than
//                           letters, digits, '.', '_' and '-' in the name become '_'
//   curve.csv, curve.svg    reports/reconstruction/reconstruction_document.h; the SVG needs gnuplot
//   report.html             one self-contained file (reports/page/html_page.h): Table 4, the
//                           painted meshes side by side as in the paper's Figure 1, the curve, the
//                           command
//
// keep() writes each mesh while the experiment runs, write() the rest at the end:
//
//   ReconstructionFolder folder("results/table4", scenario);
//   folder.keep(mesh);
//   folder.write(results, provenance);
//
// Errors: OutputError.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "reconstruction/experiment.h"
#include "reconstruction/results.h"
#include "reports/archive/archive.h"
#include "reports/text/output_file.h"

namespace simbench::reports {

struct ReconstructionPicture {
  std::string pipeline;
  std::string png;  // the bytes of the file
  double desync_ms = 0;
  reconstruction::ErrorSummary errors;  // of the shown set
};

struct ReconstructionPage {
  const reconstruction::ReconstructionResults& results;
  const std::vector<ReconstructionPicture>& pictures;  // in any order
  std::vector<std::string> command;                    // argv
};

std::string reconstruction_html(const ReconstructionPage& page);

// Returns the name of each pipeline's files, without an ending, unique in a scenario.
std::map<std::string, std::string> mesh_names(const scenarios::Scenario& scenario);

class ReconstructionFolder {
 public:
  ReconstructionFolder(const std::string& path, const scenarios::Scenario& scenario);

  // Writes the mesh and its picture; only the picture stays in memory. One call at a time.
  void keep(const reconstruction::ShownMesh& mesh);
  // Writes the rest and publishes. Returns why the SVG could not be drawn; empty if it was.
  std::string write(const reconstruction::ReconstructionResults& results,
                    const Provenance& provenance);

 private:
  std::map<std::string, std::string> names_;
  OutputFolder output_;
  std::vector<ReconstructionPicture> pictures_;
};

}  // namespace simbench::reports

// The folder that `simbench reconstruct -o` writes: Table 4, the meshes and their pictures, the
// curve, the page. It appears whole or not at all (reports/text/output_folder.h).
//
//   manifest.json           version, commit, command, start and end
//   scenario.json           the resolved scenario: repeats the experiment
//   table.txt               reports/reconstruction/reconstruction_document.h
//   results.json            reports/reconstruction/reconstruction_json.h
//   PIPELINE.ply, .png      a mesh painted with its errors, and its picture; what is not a letter,
//                           a digit, '.', '_' or '-' in the name of a pipeline becomes '_'
//   curve.csv, curve.svg    reports/reconstruction/reconstruction_document.h; the SVG where there
//                           is a gnuplot
//   report.html             reports/reconstruction/reconstruction_html.h
//
// While the experiment runs keep() writes each mesh, at the end write() the rest:
//
//   ReconstructionFolder folder("results/table4", scenario);
//   folder.keep(mesh);
//   folder.write(results, provenance);
//
// Errors: OutputError.
#ifndef SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_FOLDER_H_
#define SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_FOLDER_H_

#include <map>
#include <string>
#include <vector>

#include "reconstruction/experiment.h"
#include "reports/archive/archive.h"
#include "reports/reconstruction/reconstruction_html.h"
#include "reports/text/output_folder.h"

namespace simbench::reports {

// The name of a pipeline's files, without an ending; no two of a scenario share one.
std::map<std::string, std::string> mesh_names(const scenarios::Scenario& scenario);

class ReconstructionFolder {
 public:
  ReconstructionFolder(const std::string& path, const scenarios::Scenario& scenario);

  // Writes the mesh and its picture; only the picture stays in memory. One call at a time.
  void keep(const reconstruction::ShownMesh& mesh);
  // Writes the rest and publishes. Returns why the SVG could not be drawn; mostly empty.
  std::string write(const reconstruction::ReconstructionResults& results,
                    const Provenance& provenance);

 private:
  std::map<std::string, std::string> names_;
  OutputFolder output_;
  std::vector<ReconstructionPicture> pictures_;
};

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_FOLDER_H_

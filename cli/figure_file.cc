#include "cli/figure_file.h"

#include "scenarios/loader.h"

namespace simbench::cli {

FigureFile::FigureFile(const std::string& path) : path_(path) {
  if (path.empty()) return;
  if (path.ends_with(".pdf")) {
    format_ = reports::PlotFormat::kPdf;
  } else if (!path.ends_with(".svg")) {
    throw scenarios::InputError("--figure: found '" + path +
                                "', allowed: a name that ends in .svg or .pdf");
  }
  file_.emplace(path);
}

void FigureFile::draw(const reports::Figure& figure) const {
  reports::draw(figure, format_, path_);
}

}  // namespace simbench::cli

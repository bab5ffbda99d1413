// The file of --figure: refused before the work if it cannot be written, drawn behind the results.
//
//   const FigureFile file("clocks.svg");
//   if (file) file.draw(reports::Figure{});
#pragma once

#include <optional>
#include <string>

#include "reports/figures/figure.h"
#include "reports/figures/gnuplot.h"
#include "reports/text/output_file.h"

namespace simbench::cli {

class FigureFile {
 public:
  // An empty path: there is no figure. Throws scenarios::InputError for a name that ends in neither
  // .svg nor .pdf, reports::OutputError for a file that cannot be written.
  explicit FigureFile(const std::string& path);
  explicit operator bool() const { return file_.has_value(); }
  // Needs a path. Throws reports::OutputError.
  void draw(const reports::Figure& figure) const;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  reports::PlotFormat format_ = reports::PlotFormat::kSvg;
  std::optional<reports::OutputFile> file_{};
};

}  // namespace simbench::cli

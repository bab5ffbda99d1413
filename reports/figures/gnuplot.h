// Figures on paper: a gnuplot script of a figure, and gnuplot at work on it.
//
// The script holds the data and needs nothing else. Panels stand one above the other, legends
// beside the axes. Series of one colour are one entry of the legend, named by what their labels
// have in common. Colours are those of Okabe and Ito ("Color Universal Design", 2008), which people
// with any colour vision can tell apart; more series than colours differ in their marks and dashes.
// Photographs are text on dark rectangles, the fainter the smaller its share.
//
//   draw(figure, PlotFormat::kPdf, "fig8.pdf");
#ifndef SIMBENCH_REPORTS_FIGURES_GNUPLOT_H_
#define SIMBENCH_REPORTS_FIGURES_GNUPLOT_H_

#include <cstdint>
#include <filesystem>
#include <string>

#include "reports/figures/figure.h"

namespace simbench::reports {

enum class PlotFormat : std::uint8_t { kSvg, kPdf };

// Writes to the file `output` when gnuplot runs it. `figure` has something to draw.
std::string gnuplot_script(const Figure& figure, PlotFormat format, const std::string& output);

// Has gnuplot draw the figure. The file appears whole or not at all. Throws OutputError: no gnuplot
// (saying what to install), gnuplot failed (with its words), the file cannot be written.
void draw(const Figure& figure, PlotFormat format, const std::filesystem::path& output);

// The same as the text of an SVG: for a folder in which nothing of gnuplot's may be left when it is
// killed.
std::string drawn_svg(const Figure& figure);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_FIGURES_GNUPLOT_H_

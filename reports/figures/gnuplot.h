// Figures on paper: the gnuplot script of a figure, and its execution.
//
// The script holds the data and needs nothing else. Panels stand one above the other, legends
// beside the axes. Series of one colour are one entry of the legend, with the common part of their
// labels. Colours are those of Okabe and Ito ("Color Universal Design", 2008), distinct for any
// colour vision; more series than colours differ in their marks and dashes. Photographs are text on
// dark rectangles, the fainter the smaller its share.
//
//   draw(figure, PlotFormat::kPdf, "fig8.pdf");
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "reports/figures/figure.h"

namespace simbench::reports {

enum class PlotFormat : std::uint8_t { kSvg, kPdf };

// Returns the script, which writes the file `output`. `figure` must have something to draw.
std::string gnuplot_script(const Figure& figure, PlotFormat format, const std::string& output);

// Draws the figure with gnuplot. The file appears complete or not at all. Throws OutputError: no
// gnuplot (with the package to install), gnuplot failed (with its message), the file cannot be
// written.
void draw(const Figure& figure, PlotFormat format, const std::filesystem::path& output);

// Returns the text of an SVG, so that a killed gnuplot leaves nothing in the output folder.
std::string drawn_svg(const Figure& figure);

}  // namespace simbench::reports

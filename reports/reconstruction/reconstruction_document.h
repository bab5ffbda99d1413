// A reconstruction experiment for people: the paper's Table 4 over seeds, and how good a
// synchronisation has to be for a subject.
//
// A row for each pipeline with mean and standard deviation of the reprojection error beside the
// published ones; how they came about; the curve of error over desynchronisation; the largest
// desynchronisation that each speed forgives; what is assumed. No line of a table is wider than 100
// columns with pipeline names of up to 21.
//
//   std::cout << plain(reconstruction_document(results));
#ifndef SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_DOCUMENT_H_
#define SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_DOCUMENT_H_

#include <string>
#include <vector>

#include "reconstruction/results.h"
#include "reports/figures/figure.h"
#include "reports/reconstruction/reconstruction_limits.h"
#include "reports/text/block.h"

namespace simbench::reports {

// Its first block is Table 4.
Document reconstruction_document(const reconstruction::ReconstructionResults& results);

// The cells and sentences it is made of.
//
// "2.39"; "-" for NaN.
std::string cm_text(double cm);
// Median and band: "2.39 [1.80, 2.95]".
std::string cm_text(const evaluation::Series& series);
// "6.1 [5.0, 7.2]"; "0.125" needs its digits where a millisecond is much.
std::string ms_text(double ms);
std::string ms_text(const evaluation::Series& series);
// "1.20 m/s", or "x 1.5" where the script does not walk.
std::string speed_text(double speed_m_per_s, double speed_factor);
// "9.70, outside"; "-" without a published value.
std::string published_text(const std::optional<scenarios::PublishedReprojection>& published,
                           double scenarios::PublishedReprojection::*member,
                           const evaluation::Series& simulated);
// The share of seeds for which the pipeline's own gathering emitted no set.
double no_gathered_set_share(const reconstruction::ReprojectionRow& row);
std::string limit_text(const SyncLimit& limit);  // "12.5" or "> 500"
std::string cost_text(const SyncLimit& limit);   // "0.0123"

// "ntp_last_set : yoon2021_both = 3.2 [2.9, 3.9] in the mean error, seed by seed (published 4.05)."
std::string ratio_sentence(const PublishedRatio& ratio);
// Which speed of the subject the largest published mean would need.
std::string speed_sentence(const reconstruction::SpeedNeeded& needed);
// What was simulated and assumed, and what the numbers cannot tell; then what the results note.
std::vector<std::string> honest_notes(const reconstruction::ReconstructionResults& results);

// What a millisecond costs, as a figure (reports/figures/figure.h), which anything that draws
// figures can draw.
//
// One panel: the median mean error over desynchronisation, a curve for each speed of the subject,
// and the published means as lines. A second one, where it was looked for: the error over the
// speed, at the desynchronisation of the row with the largest published mean. With neither there is
// nothing to draw (Figure::absent).

Figure reconstruction_figure(const reconstruction::ReconstructionResults& results);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_DOCUMENT_H_

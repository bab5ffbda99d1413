// The figures that exist, by name: what `simbench figure` and the report offer.
//
//   const FigureEntry* entry = find_figure("fig8");   // "synchronisation"
#ifndef SIMBENCH_REPORTS_FIGURES_FIGURE_CATALOGUE_H_
#define SIMBENCH_REPORTS_FIGURES_FIGURE_CATALOGUE_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace simbench::reports {

// What a figure is of, and so what a reader can switch: a figure of kRun exists once for each
// pipeline and seed, one of kResults once. A few have, beside the one of their scope, one for each
// pipeline (Figure::pipeline says which).
enum class FigureScope : std::uint8_t { kResults, kPipeline, kSeed, kRun };

struct FigureEntry {
  std::string id;
  std::string title;
  std::string paper;                 // "Fig. 9, 10"; empty: of none
  std::vector<std::string> aliases;  // "fig9", "fig10"
  FigureScope scope = FigureScope::kRun;
};

// In the order in which a report shows them.
const std::vector<FigureEntry>& figure_catalogue();

// By id or alias; null if there is none.
const FigureEntry* find_figure(std::string_view name);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_FIGURES_FIGURE_CATALOGUE_H_

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "recording/collected.h"
#include "reports/figures/figure.h"
#include "scenarios/loader.h"

namespace simbench::reports {

const std::vector<FigureEntry>& figure_catalogue() {
  using enum FigureScope;
  static const std::vector<FigureEntry> entries = {
      {"distributions", "Errors over seeds", "", {}, kResults},
      {"frame_errors", "Errors of every frame", "Fig. 9, 10", {"fig9", "fig10"}, kSeed},
      {"synchronisation",
       "Global stamps without and with synchronisation",
       "Fig. 8",
       {"fig8", "fig8a", "fig8b"},
       kSeed},
      {"digital_clocks",
       "A millisecond clock, photographed by six cameras",
       "Fig. 11, 12, 13",
       {"fig11", "fig12", "fig13"},
       kSeed},
      {"host_order", "Clock errors by place in the session", "", {}, kResults},
      {"exposures", "Exposures of the cameras over time", "", {}, kRun},
      {"host_clocks", "Clock errors of the hosts over time", "", {}, kRun},
      {"gathering", "Gathered, dropped and wrongly gathered frames", "", {}, kRun},
      {"stamp_intervals",
       "Intervals of the four stamps",
       "Fig. 2",
       {"fig2", "fig2a", "fig2b", "fig2c", "fig2d"},
       kRun},
      {"stamps",
       "Sensor and arrival stamps of the cameras of one host",
       "Fig. 3",
       {"fig3", "fig3a", "fig3b"},
       kRun},
      {"global_stamps",
       "Global stamps, online and offline",
       "Fig. 4",
       {"fig4", "fig4a", "fig4b"},
       kRun},
      {"hosts", "Global stamps of one host and of two", "Fig. 5", {"fig5", "fig5a", "fig5b"}, kRun},
      {"first_seconds", "The first 10 s of the capture", "Fig. 7 b", {"fig7", "fig7b"}, kRun},
      {"budget", "Error budget", "", {}, kPipeline},
      {"phases", "Phases of the cameras' arrivals over time", "", {}, kRecording},
  };
  return entries;
}

const FigureEntry* find_figure(std::string_view name) {
  for (const FigureEntry& entry : figure_catalogue()) {
    if (entry.id == name) return &entry;
    const std::vector<std::string>& aliases = entry.aliases;
    if (std::find(aliases.begin(), aliases.end(), name) != aliases.end()) return &entry;
  }
  return nullptr;
}

const FigureEntry& figure_named(std::string_view name) {
  if (const FigureEntry* entry = find_figure(name)) return *entry;
  const std::vector<std::string> known = collected(figure_catalogue(), &FigureEntry::id);
  throw scenarios::InputError(
      fmt::format("figure: found '{}', allowed: {}, or the paper's numbers as fig8", name,
                  fmt::join(known, ", ")));
}

}  // namespace simbench::reports

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "recording/collected.h"
#include "reports/figures/figure.h"
#include "reports/figures/figure_parts.h"
#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

constexpr const char* kPaperRig = "18cam_6host_45fps";
constexpr const char* kOneHost = "3cam_1host_30fps";
constexpr const char* kTwoHosts = "6cam_2host_30fps";
constexpr const char* kTwoStreams = "18cam_6host_90fps_full_slave";
constexpr const char* kCodedRig = "18cam_6host_90fps_coded";
constexpr const char* kMethod = "yoon2021_both";

constexpr double kSameRate = 0.01;  // a trigger's rate is off by less than this share

// Returns the figures that one recording is enough for.
std::vector<FigureEntry> entries_of_a_run() {
  using enum FigureScope;
  return {
      {"exposures", "Exposures of the cameras over time", "", {}, kRun, kPaperRig},
      {"host_clocks", "Clock errors of the hosts over time", "", {}, kRun, kPaperRig},
      {"gathering", "Gathered, dropped and wrongly gathered frames", "", {}, kRun, kPaperRig},
      {"pulse", "One pulse, camera by camera", "", {}, kRun, kPaperRig, kMethod},
      {kCodeFigure, "A coded trigger in the cameras' stamps", "", {}, kRun, kCodedRig, "coded"},
      {"stamp_intervals",
       "Intervals of the four stamps",
       "Fig. 2",
       {"fig2", "fig2a", "fig2b", "fig2c", "fig2d"},
       kRun,
       kNominalWorld,
       kMethod},
      {"stamps",
       "Sensor and arrival stamps of the cameras of one host",
       "Fig. 3",
       {"fig3", "fig3a", "fig3b"},
       kRun,
       kOneHost},
      {"global_stamps",
       "Global stamps, online and offline",
       "Fig. 4",
       {"fig4", "fig4a", "fig4b"},
       kRun,
       kOneHost},
      {"hosts",
       "Global stamps of one host and of two",
       "Fig. 5",
       {"fig5", "fig5a", "fig5b"},
       kRun,
       kTwoHosts,
       "ntp_last_set"},
      {"first_seconds",
       "The first 10 s of the capture",
       "Fig. 7 b",
       {"fig7", "fig7b"},
       kRun,
       kNominalWorld,
       kMethod},
      {"budget", "Error budget", "", {}, kPipeline, kPaperRig},
      {"phases", "Phases of the cameras' arrivals over time", "", {}, kRecording},
  };
}

}  // namespace

const std::vector<FigureEntry>& figure_catalogue() {
  using enum FigureScope;
  static const std::vector<FigureEntry> entries = [] {
    std::vector<FigureEntry> all = {
        {"distributions", "Errors over seeds", "", {}, kResults, kPaperRig},
        {"frame_errors",
         "Errors of every frame",
         "Fig. 9, 10",
         {"fig9", "fig10"},
         kSeed,
         kPaperRig,
         "",
         {{"fig9", "Fig. 9", 15, "18cam_6host_15fps"}, {"fig10", "Fig. 10", 45, kPaperRig}}},
        {"synchronisation",
         "Global stamps without and with synchronisation",
         "Fig. 8",
         {"fig8", "fig8a", "fig8b"},
         kSeed,
         kPaperRig},
        {"digital_clocks",
         "A millisecond clock, photographed by six cameras",
         "Fig. 11, 12, 13",
         {"fig11", "fig12", "fig13"},
         kSeed,
         kTwoStreams},
        {"host_order", "Clock errors by place in the session", "", {}, kResults, kPaperRig},
    };
    std::ranges::move(entries_of_a_run(), std::back_inserter(all));
    return all;
  }();
  return entries;
}

const std::vector<PictureOfThePaper>& pictures_of_the_paper() {
  static const std::vector<PictureOfThePaper> pictures = {
      {"Fig. 1",
       {"fig1", "fig1a", "fig1b"},
       "meshes of a person, without and with the method",
       "`simbench reconstruct` makes such meshes (docs/reconstruction.md)"},
      {"Fig. 6",
       {"fig6", "fig6a", "fig6b"},
       "the studio with its 18 cameras, and the wiring of triggers and hosts",
       "docs/reference/paper.md section 1 and docs/rigs.md have them in words, `simbench describe "
       "18cam_6host_45fps` in numbers (/trigger, /hosts, /cameras)"},
      {"Fig. 7 a",
       {"fig7a"},
       "the camera's connector for the trigger",
       "docs/reference/d455.md section 2 has its pins and the pulse; fig7b is drawn"}};
  return pictures;
}

const FigureEntry* find_figure(std::string_view name) {
  for (const FigureEntry& entry : figure_catalogue()) {
    if (entry.id == name || std::ranges::count(entry.aliases, name) > 0) return &entry;
  }
  return nullptr;
}

const FigureEntry& figure_named(std::string_view name) {
  if (const FigureEntry* entry = find_figure(name)) return *entry;
  for (const PictureOfThePaper& picture : pictures_of_the_paper()) {
    if (std::ranges::count(picture.names, name) == 0) continue;
    throw scenarios::InputError(
        fmt::format("figure: found '{}', a picture of the paper ({}) that "
                    "is not drawn from stamps: {}",
                    name, picture.content, picture.place));
  }
  const std::vector<std::string> known = collected(figure_catalogue(), &FigureEntry::id);
  throw scenarios::InputError(
      fmt::format("figure: found '{}', allowed: {}, or the paper's numbers as fig8", name,
                  fmt::join(known, ", ")));
}

namespace {

// The rate that an alias stands for; null if the name is of any rate.
const PaperRate* rate_of(const FigureEntry& entry, std::string_view alias) {
  const auto found = std::ranges::find(entry.rates, alias, &PaperRate::alias);
  return found == entry.rates.end() ? nullptr : &*found;
}

bool is_at(const PaperRate& figure, double rate_hz) {
  return std::abs(rate_hz / figure.rate_hz - 1) <= kSameRate;
}

}  // namespace

const std::string& scenario_of_figure(const FigureEntry& entry, std::string_view name) {
  const PaperRate* const of_alias = rate_of(entry, name);
  return of_alias != nullptr ? of_alias->scenario : entry.scenario;
}

void check_rate(const FigureEntry& entry, std::string_view name, double rate_hz) {
  const PaperRate* const wanted = rate_of(entry, name);
  if (wanted == nullptr || is_at(*wanted, rate_hz)) return;
  std::string others;
  for (const PaperRate& each : entry.rates) {
    if (is_at(each, rate_hz)) others += fmt::format("{} is the paper's at this rate, ", each.alias);
  }
  throw scenarios::InputError(fmt::format(
      "{}: found frames at {:.6g} Hz, allowed: {:g} Hz, as {} has them; {}{} draws any rate", name,
      rate_hz, wanted->rate_hz, wanted->scenario, others, entry.id));
}

std::string paper_numbers(const FigureEntry& entry, double rate_hz) {
  if (entry.rates.empty()) return entry.paper;
  const auto found = std::ranges::find_if(
      entry.rates, [&](const PaperRate& each) { return is_at(each, rate_hz); });
  return found == entry.rates.end() ? "" : found->paper;
}

}  // namespace simbench::reports

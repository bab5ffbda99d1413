// A figure as plain data: what is drawn, not how.
//
// The HTML report draws a figure interactively, `simbench figure` writes it as CSV or has gnuplot
// draw it, tests examine the numbers.
//
// A figure belongs to a part of the results: to all of them, one pipeline, one seed, or one
// pipeline at one seed. Figures with the same id and different scope are alternatives: a reader
// sees one of them and switches. Units stand in the labels of the axes. NaN in y is a gap.
//
//   const FigureEntry* entry = find_figure("fig8");   // "synchronisation"
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/version.h"
#include "scenarios/derivation.h"

namespace simbench::reports {

enum class Mark : std::uint8_t { kPoints, kLine, kMarkedLine, kSteps, kBars };

// One curve, cloud or row of bars of a panel.
struct FigureSeries {
  std::string label;
  Mark mark = Mark::kPoints;
  std::vector<double> x{};  // ascending except for kPoints; for kBars: 0, 1, ... (categories)
  std::vector<double> y{};  // as long as x
  int colour = 0;           // the same number for the same thing throughout a figure
  // The 5-95 % band about y on paper and in CSV, as long as x; empty: none.
  std::vector<double> low{};
  std::vector<double> high{};

  void add(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
  // With a band.
  void add(double at, double value, double from, double to) {
    add(at, value);
    low.push_back(from);
    high.push_back(to);
  }
};

// A line across the panel, such as a published value.
struct FigureLine {
  std::string label;
  bool vertical = false;
  double at = 0;
  int colour = -1;  // of the series that it belongs to; -1: of none
};

// A shaded stretch of the x axis, such as a warm-up.
struct FigureSpan {
  std::string label;
  double from = 0;
  double to = 0;
};

// One pair of axes.
struct FigurePanel {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<FigureSeries> series{};
  std::vector<FigureLine> lines{};
  std::vector<FigureSpan> spans{};
  std::vector<std::string> categories{};  // names on the x axis where bars stand
  bool log_x = false;
  bool log_y = false;
  // The x axis counts trigger pulses: a reader can link to one of them.
  bool x_is_pulse = false;
};

// A clock on a display as one camera sees it: the readings during its exposure, each with its share
// of it (they add up to 1). One reading is a sharp picture, several a ghosted one.
struct PhotographedReading {
  std::string text;  // "00:12.345"
  double share = 0;
};
struct Photograph {
  std::string label;  // of the camera
  std::vector<PhotographedReading> readings;
};
struct PhotographRow {
  std::string label;  // of the pipeline
  std::vector<Photograph> photographs;
};

// Where the numbers of a figure come from, for a reader who has the picture alone.
struct FigureSource {
  std::string scenario{};  // empty: unknown
  scenarios::Derivation derivation{};
  std::string pipeline{};  // empty: the figure itself names several
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 0;
  std::string version = std::string(simbench::version());  // of the program that ran it
  std::string commit = std::string(simbench::commit());
};

// What the paper's figure has and this one has not.
struct FigureLack {
  std::string what;          // "back-end stamps"
  std::string scenario;      // a built-in one that has it
  bool was_recorded = true;  // false: the capture cannot show it, whatever happened
};

struct Figure {
  std::string id;  // "frame_errors", as in `simbench figure`
  std::string title;
  std::string caption;                  // the content and its limits
  std::string paper;                    // the corresponding "Fig. 9, 10" of the paper; empty: none
  std::string pipeline{};               // empty: not of one pipeline
  std::optional<std::uint64_t> seed{};  // nothing: not of one seed
  std::vector<FigurePanel> panels{};
  std::vector<PhotographRow> photographs{};
  std::string absent{};  // the reason if there is nothing to draw; then there are no panels
  std::vector<FigureLack> lacks{};  // also stated in the caption
  FigureSource source{};
};

// The scope of a figure: a figure of kRun exists once for each pipeline and seed, one of kResults
// once. A few exist for each pipeline (Figure::pipeline) besides their scope.
enum class FigureScope : std::uint8_t { kResults, kPipeline, kSeed, kRun, kRecording };

// The figure that a run has only if its trigger has a code.
inline constexpr const char* kCodeFigure = "coded_trigger";

// A number of the paper that is of one frame rate.
struct PaperRate {
  std::string alias;  // "fig9"
  std::string paper;  // "Fig. 9"
  double rate_hz = 0;
  std::string scenario;  // the built-in one that has it
};

struct FigureEntry {
  std::string id;
  std::string title;
  std::string paper;                 // "Fig. 9, 10"; empty: none
  std::vector<std::string> aliases;  // "fig9", "fig10"
  FigureScope scope = FigureScope::kRun;
  // What is drawn where nothing is named: the built-in world that has what the paper's figure
  // shows, and of a figure of one pipeline the paper's. Empty: what the user names.
  std::string scenario{};
  std::string pipeline{};
  std::vector<PaperRate> rates{};  // empty: the paper's figure is of no stated rate
};

// A figure of the paper that no stamps can draw.
struct PictureOfThePaper {
  std::string paper;               // "Fig. 1"
  std::vector<std::string> names;  // that a user may say: "fig1", "fig1a"
  std::string content;
  std::string place;  // where the project has what it shows: a sentence's end
};
const std::vector<PictureOfThePaper>& pictures_of_the_paper();

// "18cam_6host_45fps (changed), yoon2021_both, 2 seeds (1-2), simbench 0.1.0 (1234567)", and the
// first changes of the scenario, if there are any. Nothing if the source is unknown.
std::vector<std::string> source_lines(const FigureSource& source);

// All figures, in the order of a report.
const std::vector<FigureEntry>& figure_catalogue();

// By id or alias; null if there is none.
const FigureEntry* find_figure(std::string_view name);
// The same; throws scenarios::InputError if there is none. A figure of the paper that no stamps can
// draw is refused with the place of the same content.
const FigureEntry& figure_named(std::string_view name);

// The built-in scenario that the figure is drawn of by itself: of an alias that is of one rate,
// that of this rate. Empty: there is none.
const std::string& scenario_of_figure(const FigureEntry& entry, std::string_view name);

// Refuses frames of another rate than the paper's figure of this name has: throws
// scenarios::InputError, which names the right figure. The id itself is of any rate.
void check_rate(const FigureEntry& entry, std::string_view name, double rate_hz);

// The numbers of the paper that the figure at this rate has: "Fig. 9"; empty: none.
std::string paper_numbers(const FigureEntry& entry, double rate_hz);

// Returns a figure as tidy CSV, one line for each point:
//
//   panel,series,x,y
//   Sensor stamp,camera 0,225,22.222
//
// A fifth column "changed" has the changes of a scenario whose world is changed.
//
// A gap has an empty y; on an axis of categories x is the category. A line such as a published
// value is a series of one point without x (or y, if it is vertical), a shaded stretch one of two
// points without y, a band two more series, "LABEL, 5 %" and "LABEL, 95 %". Photographs: the
// pipeline is the panel, the camera the series, the reading x, its share y.
std::string figure_csv(const Figure& figure);

}  // namespace simbench::reports

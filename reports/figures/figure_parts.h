// Shared parts of the makers of figures.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/run/run_detail.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

// The world that has, unlike the fitted ones, jumps of arrivals and an unsteady start.
inline constexpr const char* kNominalWorld = "18cam_6host_45fps_lan";

// Points of a series beyond which it is thinned.
inline constexpr std::size_t kMostPoints = 600;

// An empty figure with the id's title and place in the paper.
Figure catalogued(std::string_view id);
// An empty figure that names one run.
Figure of_run(std::string_view id, const evaluation::RunDetail& run);
// The figure with nothing to draw, and the reason.
Figure absent(Figure figure, std::string why);

// Returns it with nothing to draw, since only a simulated world knows `what`; the reason has the
// command that records it.
Figure without_truth(Figure figure, std::string_view what);
// The figure, of whose caption this is the last statement so far.
void add_lack(Figure& figure, FigureLack lack);

// An empty panel.
FigurePanel panel(std::string title, std::string x_label, std::string y_label);
FigureSeries series(std::string label, Mark mark, int colour);
// Whether the y values need a logarithmic axis: none is negative, and those above zero span more
// than a factor of 50.
bool is_wide(const FigurePanel& panel);

// Adds a stretch of the x axis in seconds, from where the panel begins; nothing if an end is
// unknown.
void add_span(std::string label, double from_ms, double to_ms, double panel_from_ms,
              FigurePanel& panel);

// Makes the y axis of a wide panel logarithmic. Zeros are then gaps, and curves of zeros alone are
// left out.
void choose_scale(FigurePanel& panel);
inline constexpr const char* kLogNote =
    " Errors of exactly zero do not appear on logarithmic axes.";

// The quantile function of a metric's values, as the tables have it
// (evaluation/statistics/statistics.h): in ascending order over the share of seeds in percent.
// Nothing if no value exists.
std::optional<FigureSeries> quantile_curve(std::vector<double> values, std::string label,
                                           int colour);

// "host 1, camera 3"; "camera 3" where there is one host.
std::string camera_label(const evaluation::RunDetail& run, std::size_t camera);
// The first kept cameras of a host, at most `most`.
std::vector<std::size_t> cameras_of_host(const evaluation::RunDetail& run, std::size_t host,
                                         std::size_t most);
// A note if the rig has more cameras than are drawn; else empty. Begins with a blank.
std::string camera_note(const evaluation::RunDetail& run);

// The x axis of a camera's stamps: the pulse, or the number of the frame if no pulse exposed them.
std::string frame_axis(const evaluation::RunDetail& run);
double frame_position(const evaluation::RunDetail& run, const evaluation::CameraDetail& camera,
                      std::size_t frame);

// The reference of the stamps of one pulse; see run_figures.h.
class CommonReference {
 public:
  // `stamp`: the stamp whose median is the reference without truth.
  CommonReference(const evaluation::RunDetail& run, double evaluation::FrameDetail::*stamp);
  // NaN where there is none.
  double of(const evaluation::FrameDetail& frame) const;

 private:
  bool by_pulse_;
  std::int64_t first_pulse_;
  std::vector<double> by_row_;
};

// The evaluated stamps of one camera less the reference.
FigureSeries stamp_series(const evaluation::RunDetail& run, std::size_t camera,
                          double evaluation::FrameDetail::*stamp, const CommonReference& reference,
                          int colour);
// The label of its y axis, and an addition to the caption, which begins with a blank.
std::string reference_axis(const evaluation::RunDetail& run);
std::string truth_note(const evaluation::RunDetail& run);

// Thinning of long series: fewer points, the same picture.
//
// The series is divided into buckets of equally many points. Kept are the smallest and the largest
// of each, in their order, and the first and the last of all: a spike stays, however short. A gap
// (NaN) between two kept points stays a gap.
//
//   figure.panels[0].series.push_back(thinned(std::move(dense), 1000));

// Returns at most `most` (at least 8) points. A shorter series stays as it is. O(n).
FigureSeries thinned(FigureSeries series, std::size_t most);

}  // namespace simbench::reports

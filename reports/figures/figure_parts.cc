#include "reports/figures/figure_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/statistics.h"
#include "reports/figures/figure.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

// A bucket gives two points, and each may be followed by a gap.
constexpr std::size_t kPointsOfABucket = 4;

// The indices to keep, in order, without gaps: of each bucket the first smallest and the first
// largest value.
std::vector<std::size_t> extremes(const std::vector<double>& y, std::size_t buckets) {
  std::vector<std::size_t> kept = {0};
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    const std::size_t begin = y.size() * bucket / buckets;
    const std::size_t end = y.size() * (bucket + 1) / buckets;
    std::size_t least = end;
    std::size_t greatest = end;
    for (std::size_t i = begin; i < end; ++i) {
      if (std::isnan(y[i])) continue;
      if (least == end || y[i] < y[least]) least = i;
      if (greatest == end || y[i] > y[greatest]) greatest = i;
    }
    if (least == end) continue;
    const auto [first, second] = std::minmax(least, greatest);
    if (first != kept.back()) kept.push_back(first);
    if (second != kept.back()) kept.push_back(second);
  }
  if (kept.back() != y.size() - 1) kept.push_back(y.size() - 1);
  return kept;
}

// The upper-middle one, as in RMDV.
double middle_of(std::vector<double> values) {
  if (values.empty()) return evaluation::kNan;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

FigureSeries thinned(FigureSeries series, std::size_t most) {
  SIMBENCH_ASSERT(most >= 8, "room for the ends, a bucket and gaps");
  SIMBENCH_ASSERT(series.x.size() == series.y.size(), "a y for every x");
  SIMBENCH_ASSERT(series.low.empty() && series.high.empty(), "long series have no band");
  if (series.x.size() <= most) return series;
  // The first and the last point are additional to those of the buckets, each with a gap.
  const std::vector<std::size_t> kept =
      extremes(series.y, (most - kPointsOfABucket) / kPointsOfABucket);
  FigureSeries thin = {.label = std::move(series.label), .mark = series.mark};
  thin.colour = series.colour;
  std::size_t next = 0;  // the first unchecked index
  for (const std::size_t index : kept) {
    for (; next < index && !std::isnan(series.y[next]); ++next) {
    }
    if (next < index) {
      thin.add(series.x[next], series.y[next]);
    }
    thin.add(series.x[index], series.y[index]);
    next = index + 1;
  }
  return thin;
}

using evaluation::CameraDetail;
using evaluation::FrameDetail;
using evaluation::RunDetail;

Figure catalogued(std::string_view id) {
  const FigureEntry* entry = find_figure(id);
  SIMBENCH_ASSERT(entry != nullptr, "a figure of the catalogue");
  Figure figure;
  figure.id = entry->id;
  figure.title = entry->title;
  figure.paper = entry->paper;
  return figure;
}

std::vector<std::string> source_lines(const FigureSource& source) {
  constexpr std::size_t kMostChanges = 6;
  if (source.scenario.empty()) return {};
  std::string line = scenarios::named(source.scenario, source.derivation);
  if (!source.pipeline.empty()) line += ", " + source.pipeline;
  line += fmt::format(", {}, simbench {} ({})", counted_seeds(source.first_seed, source.seeds),
                      source.version, source.commit);
  const std::string changed = scenarios::changed_text(source.derivation, kMostChanges);
  return changed.empty() ? std::vector{line} : std::vector{line, changed};
}

Figure of_run(std::string_view id, const RunDetail& run) {
  Figure figure = catalogued(id);
  figure.pipeline = run.pipeline;
  figure.seed = run.seed;
  return figure;
}

Figure absent(Figure figure, std::string why) {
  figure.panels.clear();
  figure.photographs.clear();
  figure.absent = std::move(why);
  return figure;
}

Figure without_truth(Figure figure, std::string_view what) {
  return absent(std::move(figure),
                fmt::format("The capture has no {}, which only a simulated world knows; `simbench "
                            "record --scenario 18cam_6host_45fps -o DIR` records one that has.",
                            what));
}

void add_lack(Figure& figure, FigureLack lack) {
  figure.caption +=
      fmt::format(" The paper's figure also has {}, as {} has.", lack.what, lack.scenario);
  figure.lacks.push_back(std::move(lack));
}

FigurePanel panel(std::string title, std::string x_label, std::string y_label) {
  FigurePanel made;
  made.title = std::move(title);
  made.x_label = std::move(x_label);
  made.y_label = std::move(y_label);
  return made;
}

bool is_wide(const FigurePanel& panel) {
  constexpr double kLogSpan = 50;
  double least = std::numeric_limits<double>::infinity();
  double greatest = 0;
  for (const FigureSeries& series : panel.series) {
    for (const double value : series.y) {
      if (value < 0) return false;
      if (value > 0) least = std::min(least, value);
      greatest = std::fmax(greatest, value);
    }
  }
  return greatest > kLogSpan * least;
}

void choose_scale(FigurePanel& panel) {
  panel.log_y = is_wide(panel);
  if (!panel.log_y) return;
  for (FigureSeries& series : panel.series) {
    std::replace(series.y.begin(), series.y.end(), 0.0, evaluation::kNan);
  }
  std::erase_if(panel.series, [](const FigureSeries& series) {
    return std::all_of(series.y.begin(), series.y.end(), [](double y) { return std::isnan(y); });
  });
}

std::optional<FigureSeries> quantile_curve(std::vector<double> values, std::string label,
                                           int colour) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  FigureSeries curve = series(std::move(label), Mark::kLine, colour);
  if (values.size() == 1) values.push_back(values.front());  // all quantiles of a single seed
  for (std::size_t i = 0; i < values.size(); ++i) {
    curve.add(100 * static_cast<double>(i) / static_cast<double>(values.size() - 1), values[i]);
  }
  return thinned(std::move(curve), kMostPoints);
}

FigureSeries series(std::string label, Mark mark, int colour) {
  FigureSeries made;
  made.label = std::move(label);
  made.mark = mark;
  made.colour = colour;
  return made;
}

void add_span(std::string label, double from_ms, double to_ms, double panel_from_ms,
              FigurePanel& panel) {
  const double from = std::fmax(from_ms, panel_from_ms);
  if (!std::isfinite(from_ms) || !(to_ms > from)) return;  // also if one of them is unknown
  panel.spans.push_back({std::move(label), from / 1000, to_ms / 1000});
}

std::string camera_label(const RunDetail& run, std::size_t camera) {
  if (run.host_count < 2) return fmt::format("camera {}", camera);
  return fmt::format("host {}, camera {}", run.cameras[camera].host, camera);
}

std::vector<std::size_t> cameras_of_host(const RunDetail& run, std::size_t host, std::size_t most) {
  std::vector<std::size_t> cameras;
  for (std::size_t camera = 0; camera < run.cameras.size() && cameras.size() < most; ++camera) {
    if (run.cameras[camera].host == host) cameras.push_back(camera);
  }
  return cameras;
}

std::string camera_note(const RunDetail& run) {
  if (run.camera_count <= run.cameras.size()) return "";
  return fmt::format(" Only the first {} of {} cameras are drawn.", run.cameras.size(),
                     run.camera_count);
}

std::string frame_axis(const RunDetail& run) { return run.has_pulses ? "pulse" : "frame"; }

double frame_position(const RunDetail& run, const CameraDetail& camera, std::size_t frame) {
  const std::int64_t pulse = camera.frames[frame].pulse;
  if (pulse >= 0) return static_cast<double>(pulse);
  return run.has_pulses ? evaluation::kNan : static_cast<double>(frame);
}

CommonReference::CommonReference(const RunDetail& run, double FrameDetail::*stamp)
    : by_pulse_(run.has_pulses), first_pulse_(run.first_pulse) {
  if (!by_pulse_) return;
  by_row_.assign(static_cast<std::size_t>(run.pulses), evaluation::kNan);
  std::vector<std::vector<double>> stamps(run.has_truth ? 0 : by_row_.size());
  for (const CameraDetail& camera : run.cameras) {
    for (const FrameDetail& frame : camera.frames) {
      if (!frame.evaluated) continue;
      const auto row = static_cast<std::size_t>(frame.pulse - first_pulse_);
      if (!run.has_truth) {
        stamps[row].push_back(frame.*stamp);
      } else if (std::isnan(by_row_[row])) {
        by_row_[row] = frame.reference_ms;
      }
    }
  }
  for (std::size_t row = 0; row < stamps.size(); ++row) by_row_[row] = middle_of(stamps[row]);
}

double CommonReference::of(const FrameDetail& frame) const {
  if (!by_pulse_) return frame.reference_ms;
  return frame.evaluated ? by_row_[static_cast<std::size_t>(frame.pulse - first_pulse_)]
                         : evaluation::kNan;
}

FigureSeries stamp_series(const RunDetail& run, std::size_t camera, double FrameDetail::*stamp,
                          const CommonReference& reference, int colour) {
  FigureSeries made = series(camera_label(run, camera), Mark::kLine, colour);
  const CameraDetail& of_camera = run.cameras[camera];
  for (std::size_t i = 0; i < of_camera.frames.size(); ++i) {
    const FrameDetail& frame = of_camera.frames[i];
    if (run.has_pulses ? !frame.evaluated : frame.in_warm_up) continue;
    const auto x = static_cast<double>(run.has_pulses ? frame.pulse : static_cast<std::int64_t>(i));
    const bool lost_before = i > 0 && of_camera.frames[i - 1].counter + 1 != frame.counter;
    if (lost_before && !made.x.empty()) {
      made.add(x, evaluation::kNan);
    }
    made.add(x, frame.*stamp - reference.of(frame));
  }
  return thinned(std::move(made), kMostPoints);
}

std::string reference_axis(const RunDetail& run) {
  return run.has_truth ? "global stamp - truth (ms)" : "global stamp - median (ms)";
}

std::string truth_note(const RunDetail& run) {
  return run.has_truth
             ? " The truth is what the master's clock read at mid-exposure."
             : " There is no truth; the median is that of all cameras' stamps of the pulse.";
}

}  // namespace simbench::reports

#include "reports/figures/run_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "reports/figures/figure_parts.h"
#include "reports/figures/thin.h"

namespace simbench::reports {
namespace {

using evaluation::CameraDetail;
using evaluation::FrameDetail;
using evaluation::RunDetail;

constexpr std::size_t kCamerasOfAHost = 3;   // as in the paper's figures
constexpr std::size_t kFramesOfStamps = 60;  // more could not be told apart beside each other
constexpr double kFirstSeconds = 10;

constexpr const char* kNoFrames = "No camera of the master host has frames after the warm-up.";

// The interval that ends with each frame after the warm-up; a gap where frames are missing between.
FigureSeries interval_series(const RunDetail& run, std::size_t camera, double FrameDetail::*stamp) {
  FigureSeries made = series(camera_label(run, camera), Mark::kLine, 0);
  const CameraDetail& of_camera = run.cameras[camera];
  for (std::size_t i = 1; i < of_camera.frames.size(); ++i) {
    const FrameDetail& before = of_camera.frames[i - 1];
    const FrameDetail& frame = of_camera.frames[i];
    const double x = frame_position(run, of_camera, i);
    if (before.in_warm_up || frame.in_warm_up || std::isnan(x)) continue;
    made.x.push_back(x);
    made.y.push_back(frame.counter == before.counter + 1 ? frame.*stamp - before.*stamp
                                                         : evaluation::kNan);
  }
  return thinned(std::move(made), kMostPoints);
}

// The first frames after the warm-up.
FigureSeries raw_series(const RunDetail& run, std::size_t camera, double FrameDetail::*stamp,
                        std::size_t colour) {
  FigureSeries made = series(camera_label(run, camera), Mark::kPoints, static_cast<int>(colour));
  const CameraDetail& of_camera = run.cameras[camera];
  for (std::size_t i = 0; i < of_camera.frames.size() && made.x.size() < kFramesOfStamps; ++i) {
    const double x = frame_position(run, of_camera, i);
    if (of_camera.frames[i].in_warm_up || std::isnan(x)) continue;
    made.x.push_back(x);
    made.y.push_back(of_camera.frames[i].*stamp);
  }
  return made;
}

FigurePanel frame_panel(const RunDetail& run, std::string title, std::string y_label) {
  FigurePanel made = panel(std::move(title), frame_axis(run), std::move(y_label));
  made.x_is_pulse = run.has_pulses;
  return made;
}

bool has_points(const FigureSeries& series) { return !series.x.empty(); }

// Differences to the first of the series, where they have the same x.
FigurePanel differences(const RunDetail& run, const FigurePanel& stamps) {
  FigurePanel made = frame_panel(run, "Arrivals less those of the first camera", "difference (ms)");
  const FigureSeries& first = stamps.series.front();
  for (const FigureSeries& of_camera : stamps.series) {
    FigureSeries difference = series(of_camera.label, of_camera.mark, of_camera.colour);
    for (std::size_t i = 0; i < of_camera.x.size(); ++i) {
      const auto same = std::lower_bound(first.x.begin(), first.x.end(), of_camera.x[i]);
      if (same == first.x.end() || *same != of_camera.x[i]) continue;
      difference.x.push_back(of_camera.x[i]);
      difference.y.push_back(of_camera.y[i] -
                             first.y[static_cast<std::size_t>(same - first.x.begin())]);
    }
    made.series.push_back(std::move(difference));
  }
  return made;
}

// Global stamps of some cameras; colours by camera or by host.
FigurePanel global_panel(const RunDetail& run, std::string title,
                         const std::vector<std::size_t>& cameras, double FrameDetail::*stamp,
                         bool by_host) {
  FigurePanel made = frame_panel(run, std::move(title), reference_axis(run));
  const CommonReference reference(run, stamp);
  for (const std::size_t camera : cameras) {
    const std::size_t colour = by_host ? run.cameras[camera].host : made.series.size();
    made.series.push_back(stamp_series(run, camera, stamp, reference, static_cast<int>(colour)));
  }
  return made;
}

bool has_stamps(const FigurePanel& panel) {
  return std::any_of(panel.series.begin(), panel.series.end(), has_points);
}

// What x is zero at in the figure of the first seconds.
double capture_start_ms(const RunDetail& run, const CameraDetail& camera) {
  if (!std::isnan(run.capture_start_ms)) return run.capture_start_ms;
  return run.has_truth ? camera.frames.front().exposure_start_ms : camera.frames.front().arrival_ms;
}

FigureSeries first_intervals(const RunDetail& run, std::size_t camera, std::size_t colour) {
  FigureSeries made = series(camera_label(run, camera), Mark::kLine, static_cast<int>(colour));
  const std::vector<FrameDetail>& frames = run.cameras[camera].frames;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double at_ms = run.has_truth ? frames[i].mid_exposure_ms() : frames[i].arrival_ms;
    const double x = (at_ms - capture_start_ms(run, run.cameras[camera])) / 1000;
    if (x > kFirstSeconds) break;
    if (!made.x.empty() && x < made.x.back()) continue;
    made.x.push_back(x);
    made.y.push_back(frames[i].counter == frames[i - 1].counter + 1
                         ? frames[i].from_start_ms - frames[i - 1].from_start_ms
                         : evaluation::kNan);
  }
  return made;
}

}  // namespace

Figure stamp_intervals(const RunDetail& run) {
  Figure figure = of_run("stamp_intervals", run);
  struct Stamp {
    const char* title;
    double FrameDetail::*member;
  };
  constexpr Stamp kStamps[] = {
      {"Sensor stamp (middle of the exposure, camera's clock)", &FrameDetail::sensor_ms},
      {"Frame stamp (start of the transmission, camera's clock)", &FrameDetail::frame_ms},
      {"Back-end stamp (copied to the kernel, host's clock)", &FrameDetail::backend_ms},
      {"Time of arrival (delivered, host's clock)", &FrameDetail::arrival_ms}};
  const std::vector<std::size_t> cameras = cameras_of_host(run, 0, 1);
  if (cameras.empty()) return absent(std::move(figure), kNoFrames);
  for (const Stamp& stamp : kStamps) {
    FigurePanel made = frame_panel(run, stamp.title, "interval (ms)");
    made.series.push_back(interval_series(run, cameras.front(), stamp.member));
    if (!has_points(made.series.front())) return absent(std::move(figure), kNoFrames);
    figure.panels.push_back(std::move(made));
  }
  figure.caption = fmt::format(
      "Intervals between consecutive frames of {}, nominally {:.3f} ms. A gap is a lost frame.",
      camera_label(run, cameras.front()), 1000 / run.frame_rate_hz);
  return figure;
}

Figure stamps(const RunDetail& run) {
  Figure figure = of_run("stamps", run);
  FigurePanel sensor = frame_panel(run, "Sensor stamps", "camera's clock (ms)");
  FigurePanel arrival = frame_panel(run, "Arrival stamps", "host's clock (ms)");
  for (const std::size_t camera : cameras_of_host(run, 0, kCamerasOfAHost)) {
    const std::size_t colour = sensor.series.size();
    sensor.series.push_back(raw_series(run, camera, &FrameDetail::sensor_ms, colour));
    arrival.series.push_back(raw_series(run, camera, &FrameDetail::arrival_ms, colour));
  }
  if (!has_stamps(sensor)) return absent(std::move(figure), kNoFrames);
  FigurePanel difference = differences(run, arrival);
  figure.panels = {std::move(sensor), std::move(arrival), std::move(difference)};
  figure.caption = fmt::format(
      "The first {} frames after the warm-up. Every camera's clock has its own origin; the "
      "arrivals, on one clock, nearly coincide.",
      kFramesOfStamps);
  return figure;
}

Figure global_stamps(const RunDetail& run) {
  Figure figure = of_run("global_stamps", run);
  const std::vector<std::size_t> cameras = cameras_of_host(run, 0, kCamerasOfAHost);
  figure.panels = {global_panel(run, "Online: regression over the last 30 frames", cameras,
                                &FrameDetail::online_ms, /*by_host=*/false),
                   global_panel(run, "Offline: regression over all frames", cameras,
                                &FrameDetail::offline_ms, /*by_host=*/false)};
  if (!has_stamps(figure.panels.front())) return absent(std::move(figure), kNoFrames);
  figure.caption =
      "Global stamps by eq. (1) on the cameras of the master host, whichever device_time the "
      "pipeline has. The paper plots the stamps themselves, where no difference can be seen; "
      "both include the delay from exposure to arrival.";
  figure.caption += truth_note(run);
  return figure;
}

Figure hosts(const RunDetail& run) {
  Figure figure = of_run("hosts", run);
  std::vector<std::size_t> cameras = cameras_of_host(run, 0, kCamerasOfAHost);
  figure.panels.push_back(
      global_panel(run, "One host", cameras, &FrameDetail::global_ms, /*by_host=*/true));
  const std::vector<std::size_t> others = cameras_of_host(run, 1, kCamerasOfAHost);
  cameras.insert(cameras.end(), others.begin(), others.end());
  if (!others.empty()) {
    figure.panels.push_back(
        global_panel(run, "Two hosts", cameras, &FrameDetail::global_ms, /*by_host=*/true));
  }
  if (!has_stamps(figure.panels.back())) {
    return absent(std::move(figure), "No frame of the first two hosts has a global stamp.");
  }
  figure.caption = fmt::format(
      "Global stamps of the pipeline, one colour for each host. Cameras of one host lie together; "
      "what separates the hosts is the error of their clocks.{}{}",
      others.empty() ? " This rig has one host with cameras." : "", truth_note(run));
  return figure;
}

Figure first_seconds(const RunDetail& run) {
  Figure figure = of_run("first_seconds", run);
  FigurePanel made = panel("Intervals of the global stamps",
                           "time since the start of the cameras (s)", "interval (ms)");
  std::optional<double> start_ms;
  for (const std::size_t camera : cameras_of_host(run, 0, kCamerasOfAHost)) {
    if (run.cameras[camera].frames.empty()) continue;
    if (!start_ms) start_ms = capture_start_ms(run, run.cameras[camera]);
    made.series.push_back(first_intervals(run, camera, made.series.size()));
  }
  if (!has_stamps(made)) {
    return absent(std::move(figure), "No camera of the master host has two frames in this time.");
  }
  const double warm_s = (run.evaluated_start_ms - *start_ms) / 1000;
  if (warm_s > 0) {
    made.spans.push_back({"warm-up, not scored", 0, std::min(warm_s, kFirstSeconds)});
  }
  figure.panels.push_back(std::move(made));
  figure.caption =
      "The pipeline's device_time, here from each camera's first frame on. The paper found "
      "cameras unsteady for 5 s and discards them; so does every score.";
  return figure;
}

std::vector<Figure> run_figures(const RunDetail& run) {
  return {stamp_intervals(run), stamps(run),      global_stamps(run), hosts(run),
          first_seconds(run),   host_clocks(run), gathering(run)};
}

}  // namespace simbench::reports

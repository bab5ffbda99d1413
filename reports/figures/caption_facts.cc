#include "reports/figures/caption_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "evaluation/statistics/statistics.h"
#include "reports/figures/figure_parts.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::CameraDetail;
using evaluation::FrameDetail;
using evaluation::kNan;
using evaluation::RunDetail;

constexpr const char* kUnsynchronised = "ntp_last_set";  // the paper's pipeline without the method

// The frames that the scores are of; without pulses, those after the warm-up.
bool counts(const RunDetail& run, const FrameDetail& frame) {
  return run.has_pulses ? frame.evaluated : !frame.in_warm_up;
}

// A range that grows by values.
struct StampRange {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();
  std::size_t values = 0;

  void add(double value) {
    least = std::min(least, value);
    greatest = std::max(greatest, value);
    ++values;
  }
  double size() const { return greatest - least; }
};

// By pulse, or by the number of the frame where no pulse exposed it.
using Ranges = std::map<std::int64_t, StampRange>;

void add_stamps(const RunDetail& run, std::size_t camera, double FrameDetail::*stamp,
                Ranges& ranges) {
  const CameraDetail& of_camera = run.cameras[camera];
  for (std::size_t i = 0; i < of_camera.frames.size(); ++i) {
    const FrameDetail& frame = of_camera.frames[i];
    const double position = frame_position(run, of_camera, i);
    if (!counts(run, frame) || std::isnan(position) || std::isnan(frame.*stamp)) continue;
    ranges[static_cast<std::int64_t>(position)].add(frame.*stamp);
  }
}

// Means over frames, made of their sums.
class HostSum {
 public:
  void add(const FrameDetail& frame, double reference_ms) {
    sum_.exposure_ms += frame.reference_ms - reference_ms;
    sum_.clock_ms += frame.own_host_ms - frame.reference_ms;
    sum_.delay_ms += frame.global_ms - frame.own_host_ms;
    length_ms_ += frame.exposure_end_ms - frame.exposure_start_ms;
    ++frames_;
  }

  StampsOfHost mean(std::uint32_t host) const {
    return {.host = host,
            .mean = {.exposure_ms = sum_.exposure_ms / frames_,
                     .clock_ms = sum_.clock_ms / frames_,
                     .delay_ms = sum_.delay_ms / frames_},
            .exposure_length_ms = length_ms_ / frames_};
  }

 private:
  StampParts sum_;
  double length_ms_ = 0;
  double frames_ = 0;
};

// The parts of the distance between the earliest host and the latest.
std::string parts_text(const StampsOfHost& first, const StampsOfHost& last) {
  return fmt::format(
      "hosts {} and {}, the farthest, are {} apart: {} by their clocks, {} by the middles of their "
      "exposures ({} and {} long), {} by the delay from there to the stamp.",
      first.host, last.host, time_text(last.mean.stamp_ms() - first.mean.stamp_ms()),
      signed_time_text(last.mean.clock_ms - first.mean.clock_ms),
      signed_time_text(last.mean.exposure_ms - first.mean.exposure_ms),
      time_text(first.exposure_length_ms), time_text(last.exposure_length_ms),
      signed_time_text(last.mean.delay_ms - first.mean.delay_ms));
}

}  // namespace

std::vector<std::size_t> kept_cameras(const RunDetail& run) {
  std::vector<std::size_t> cameras(run.cameras.size());
  std::iota(cameras.begin(), cameras.end(), std::size_t{0});
  return cameras;
}

std::vector<StampsOfHost> stamps_of_hosts(const RunDetail& run,
                                          std::span<const std::size_t> cameras) {
  if (!run.has_truth) return {};
  std::map<std::uint32_t, HostSum> sums;
  const CommonReference reference(run, &FrameDetail::global_ms);
  for (const std::size_t camera : cameras) {
    for (const FrameDetail& frame : run.cameras[camera].frames) {
      if (!counts(run, frame) || std::isnan(frame.global_ms)) continue;
      sums[run.cameras[camera].host].add(frame, reference.of(frame));
    }
  }
  std::vector<StampsOfHost> hosts;
  hosts.reserve(sums.size());
  for (const auto& [host, sum] : sums) hosts.push_back(sum.mean(host));
  return hosts;
}

double range_in_hosts_ms(const RunDetail& run, std::span<const std::size_t> cameras) {
  std::map<std::uint32_t, Ranges> by_host;
  for (const std::size_t camera : cameras) {
    add_stamps(run, camera, &FrameDetail::global_ms, by_host[run.cameras[camera].host]);
  }
  std::vector<double> sizes;
  for (const auto& [host, ranges] : by_host) {
    for (const auto& [pulse, range] : ranges) {
      if (range.values > 1) sizes.push_back(range.size());
    }
  }
  return sizes.empty() ? kNan : evaluation::mean_of(sizes);
}

std::string distance_text(const RunDetail& run, std::span<const std::size_t> cameras) {
  const double in_host_ms = range_in_hosts_ms(run, cameras);
  std::string text;
  if (!std::isnan(in_host_ms)) {
    text = fmt::format(" Means over the pulses: the stamps of one host lie within {}",
                       time_text(in_host_ms));
  }
  const std::vector<StampsOfHost> hosts = stamps_of_hosts(run, cameras);
  if (hosts.size() < 2) {
    const std::string end = run.host_count > 1 && !run.has_truth
                                ? "; without truth nothing tells clocks from exposures."
                                : ".";
    return text.empty() ? "" : text + end;
  }
  const auto by_stamp = [](const StampsOfHost& a, const StampsOfHost& b) {
    return a.mean.stamp_ms() < b.mean.stamp_ms();
  };
  const auto [first, last] = std::minmax_element(hosts.begin(), hosts.end(), by_stamp);
  return (text.empty() ? " Means over the pulses: " : text + "; ") + parts_text(*first, *last);
}

IntervalFacts interval_facts(const RunDetail& run, std::size_t camera, double FrameDetail::*stamp) {
  const std::vector<FrameDetail>& frames = run.cameras[camera].frames;
  const double longest_ms = 1000 / run.frame_rate_hz * (1 + kJumpPeriods);
  IntervalFacts facts;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (frames[i - 1].in_warm_up || frames[i].in_warm_up) continue;
    if (frames[i].counter != frames[i - 1].counter + 1) continue;
    intervals.push_back(frames[i].*stamp - frames[i - 1].*stamp);
    if (intervals.back() > longest_ms) ++facts.jumps;
  }
  facts.intervals = intervals.size();
  facts.deviation_ms = evaluation::standard_deviation(intervals);
  return facts;
}

RangeFacts range_facts(const RunDetail& run, std::span<const std::size_t> cameras,
                       double FrameDetail::*stamp, std::size_t most) {
  Ranges ranges;
  for (const std::size_t camera : cameras) add_stamps(run, camera, stamp, ranges);
  std::vector<double> sizes;
  for (const auto& [pulse, range] : ranges) {
    if (sizes.size() == most) break;
    if (range.values == cameras.size() && range.values > 1) sizes.push_back(range.size());
  }
  if (sizes.empty()) return {};
  return {evaluation::mean_of(sizes), *std::max_element(sizes.begin(), sizes.end())};
}

bool is_copy(const CameraDetail& camera, double FrameDetail::*stamp) {
  double FrameDetail::*const original =
      stamp == &FrameDetail::backend_ms ? &FrameDetail::arrival_ms : &FrameDetail::sensor_ms;
  return stamp != original && stamp != &FrameDetail::arrival_ms &&
         std::ranges::all_of(camera.frames, [&](const FrameDetail& frame) {
           return frame.*stamp == frame.*original;
         });
}

std::string intervals_text(const RunDetail& run, std::size_t camera) {
  const IntervalFacts arrival = interval_facts(run, camera, &FrameDetail::arrival_ms);
  const auto deviation = [&](double FrameDetail::*stamp) {
    if (is_copy(run.cameras[camera], stamp)) return std::string("none");
    return time_text(interval_facts(run, camera, stamp).deviation_ms);
  };
  return fmt::format(
      " Their standard deviations: sensor {}, frame {}, back-end {}, arrival {}; {} of {} arrival "
      "intervals are longer by more than a tenth.",
      deviation(&FrameDetail::sensor_ms), deviation(&FrameDetail::frame_ms),
      deviation(&FrameDetail::backend_ms), time_text(arrival.deviation_ms), arrival.jumps,
      arrival.intervals);
}

std::string ranges_text(const RunDetail& run, std::span<const std::size_t> cameras) {
  const RangeFacts sensor = range_facts(run, cameras, &FrameDetail::sensor_ms, kFramesOfStamps);
  const RangeFacts arrival = range_facts(run, cameras, &FrameDetail::arrival_ms, kFramesOfStamps);
  if (std::isnan(sensor.mean_ms)) return "";
  return fmt::format(
      " The stamps of a {} are {} apart on the cameras' own clocks, and {} ({} at most) by their "
      "arrivals on the host's.",
      frame_axis(run), time_text(sensor.mean_ms), time_text(arrival.mean_ms),
      time_text(arrival.largest_ms));
}

std::string online_offline_text(const RunDetail& run, std::span<const std::size_t> cameras) {
  std::vector<double> differences;
  std::vector<double> online_late;
  std::vector<double> offline_late;
  for (const std::size_t camera : cameras) {
    for (const FrameDetail& frame : run.cameras[camera].frames) {
      if (!counts(run, frame)) continue;
      differences.push_back(std::abs(frame.online_ms - frame.offline_ms));
      online_late.push_back(frame.online_ms - frame.own_host_ms);
      offline_late.push_back(frame.offline_ms - frame.own_host_ms);
    }
  }
  if (differences.empty()) return "";
  std::string text =
      fmt::format(" Online and offline differ by {} on average, {} at most.",
                  time_text(evaluation::mean_of(differences)),
                  time_text(*std::max_element(differences.begin(), differences.end())));
  if (run.has_truth) {
    text += fmt::format(" They are {} and {} later than the exposure was by the host's clock.",
                        time_text(evaluation::mean_of(online_late)),
                        time_text(evaluation::mean_of(offline_late)));
  }
  return text;
}

std::string before_synchronisation_note(const RunDetail& run) {
  if (run.pipeline == kUnsynchronised) return "";
  return fmt::format(" The paper's figure is of hosts that are not yet synchronised: {}.",
                     kUnsynchronised);
}

SteadyFacts steady_facts(std::span<const FigureSeries> intervals) {
  std::vector<double> before;
  std::vector<double> after;
  for (const FigureSeries& of_camera : intervals) {
    for (std::size_t i = 0; i < of_camera.y.size(); ++i) {
      if (std::isnan(of_camera.y[i])) continue;
      if (of_camera.x[i] < kSettledSeconds) continue;
      (of_camera.x[i] < kUnsteadySeconds ? before : after).push_back(of_camera.y[i]);
    }
  }
  return {evaluation::standard_deviation(before), evaluation::standard_deviation(after)};
}

std::string steady_text(const SteadyFacts& facts) {
  return fmt::format(" Standard deviation of the intervals: {} from {:g} to {:g} s, {} later.",
                     time_text(facts.before_ms), kSettledSeconds, kUnsteadySeconds,
                     time_text(facts.after_ms));
}

std::string signed_time_text(double ms) { return (ms > 0 ? "+" : "") + time_text(ms); }

}  // namespace simbench::reports

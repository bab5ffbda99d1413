#include "sim/traffic/frame_bursts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/engine/random.h"
#include "sim/traffic/tcp_fluid.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kBurstPhase("traffic: phase of a paced stream");
constexpr ComponentKey kRandomBursts("traffic: random bursts");

constexpr double kBurstsPerCell = 64;
constexpr std::size_t kCellsKept = 64;
constexpr double kRareBurst = 1e6;  // one in so many is larger than those that windows allow for
constexpr double kDecay = 14;       // of the tail of the work, in powers of e: a millionth
constexpr double kMostHostNs = 1e9;
constexpr double kLeastFreeShare = 0.02;

// The mean of a Pareto law from 1 to `most` in units of its least.
double bounded_pareto_mean(double exponent, double most) {
  const double below = 1 - std::pow(most, -exponent);
  return exponent / (exponent - 1) * (1 - std::pow(most, 1 - exponent)) / below;
}

// One stream alone is in order already.
template <typename Element, typename Less>
void sort_if_needed(std::vector<Element>& elements, Less less) {
  if (!std::is_sorted(elements.begin(), elements.end(), less)) {
    std::sort(elements.begin(), elements.end(), less);
  }
}

}  // namespace

FrameBursts::FrameBursts(double line_bytes_per_ns, std::vector<BurstStream> streams,
                         std::vector<double> buffer_bytes, std::uint64_t run_seed)
    : line_bytes_per_ns_(line_bytes_per_ns),
      frame_ns_(kFullFrameBytes / line_bytes_per_ns),
      run_seed_(run_seed),
      ports_(buffer_bytes.size()) {
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    ports_[p].buffer_ns = buffer_bytes[p] / line_bytes_per_ns;
  }
  for (const BurstStream& stream : streams) add_stream(stream, run_seed);
}

void FrameBursts::add_stream(const BurstStream& parameters, std::uint64_t run_seed) {
  const std::size_t index = streams_.size();
  Stream stream;
  stream.parameters = parameters;
  stream.number = index;
  double mean_frames = std::max(1.0, std::ceil(parameters.burst_frames));
  stream.frames = stream.largest_frames = mean_frames;
  if (parameters.kind == scenarios::TrafficKind::kRandom) {
    const double least = std::max(1.0, parameters.burst_frames);
    mean_frames = least * bounded_pareto_mean(parameters.tail_exponent, kLargestPerLeast);
    stream.frames = least;
    stream.largest_frames =
        1 + least * std::min(kLargestPerLeast, std::pow(kRareBurst, 1 / parameters.tail_exponent));
  }
  stream.gap_ns = mean_frames * kFullFrameBytes / parameters.bytes_per_ns;
  if (parameters.kind == scenarios::TrafficKind::kPaced) {
    stream.phase_ns = stream.gap_ns * RandomStream(run_seed, kBurstPhase, index).uniform();
  } else {
    stream.cell_ns = std::max<std::int64_t>(
        1, static_cast<std::int64_t>(std::min(kBurstsPerCell * stream.gap_ns, 1e18)));
    stream.cells.resize(kCellsKept);
  }
  const std::vector<std::size_t>& ports = parameters.ports;
  for (std::size_t i = 0; i < ports.size(); ++i) {
    BurstPort& port = ports_[ports[i]];
    port.streams.push_back(index);
    port.load += parameters.bytes_per_ns / line_bytes_per_ns_;
    if (parameters.kind == scenarios::TrafficKind::kPaced) {
      port.paced_frames += stream.frames;
    } else {
      port.largest_frames = std::max(port.largest_frames, stream.largest_frames);
      port.mean_frames = std::max(port.mean_frames, mean_frames);
    }
    if (i > 0 &&
        std::find(port.feeders.begin(), port.feeders.end(), ports[i - 1]) == port.feeders.end()) {
      port.feeders.push_back(ports[i - 1]);
    }
  }
  streams_.push_back(std::move(stream));
}

Nanoseconds FrameBursts::wait(std::size_t port_number, TrueTime at) {
  BurstPort& port = ports_[port_number];
  if (port.streams.empty()) return Nanoseconds(0);
  const std::int64_t at_ns = at.time_since_epoch().count();
  if (port.buffer_ns == 0) return from_ns(host_work(port_number, at_ns, 0));
  const double longest_ns =
      static_cast<double>(kMostFrames) * frame_ns_ / std::max(0.1, std::min(1.0, port.load));
  const double served_ns = most_work_ns(port);
  double window_ns = std::min(longest_ns, 1.5 * served_ns / free_share(port));
  while (true) {
    double idle_ns = 0;
    const double work_ns = switch_work(port_number, at_ns, window_ns, idle_ns);
    if (idle_ns >= served_ns || window_ns >= longest_ns) return from_ns(work_ns);
    window_ns = std::min(2 * window_ns, longest_ns);
  }
}

double FrameBursts::overload_share(std::size_t port, TrueTime at) const {
  double load = 0;
  for (const std::size_t number : ports_[port].streams) {
    const BurstStream& stream = streams_[number].parameters;
    if (stream.begin <= at && at < stream.end) load += stream.bytes_per_ns / line_bytes_per_ns_;
  }
  return load > 1 ? 1 - 1 / load : 0;
}

double FrameBursts::overload_share(std::size_t port) const {
  return ports_[port].load > 1 ? 1 - 1 / ports_[port].load : 0;
}

double FrameBursts::free_share(const BurstPort& port) {
  return std::max(kLeastFreeShare, 1 - port.load);
}

double FrameBursts::most_work_ns(const BurstPort& port) const {
  double frames = 1 + port.paced_frames;
  if (port.largest_frames > 0) {
    frames += 2 * port.largest_frames + kDecay / 2 * port.mean_frames / free_share(port);
  }
  const double work_ns = frames * frame_ns_;
  return port.buffer_ns == 0 ? work_ns : std::min(work_ns, port.buffer_ns);
}

// The work that the host has left at the query; its bursts from `frames_from_ns` (below 0) on stay
// in port.bursts, with the begin of their transmission.
double FrameBursts::host_work(std::size_t port_number, std::int64_t at_ns, double frames_from_ns) {
  BurstPort& port = ports_[port_number];
  const double served_ns = most_work_ns(port);
  double window_ns = 1.5 * served_ns / free_share(port);
  while (true) {
    double idle_ns = 0;
    const double work_ns = host_window(port, at_ns, window_ns - frames_from_ns, idle_ns);
    const bool is_longest = window_ns > kMostHostNs || port.bursts.size() > kMostFrames;
    if (idle_ns >= served_ns || is_longest) return work_ns;
    window_ns *= 2;
  }
}

double FrameBursts::host_window(BurstPort& port, std::int64_t at_ns, double window_ns,
                                double& idle_ns) {
  port.bursts.clear();
  for (const std::size_t number : port.streams) {
    append_bursts(streams_[number], number, at_ns, window_ns, port.bursts);
  }
  sort_if_needed(port.bursts, [](const HostBurst& a, const HostBurst& b) {
    return a.begin_ns != b.begin_ns ? a.begin_ns < b.begin_ns : a.stream < b.stream;
  });
  double free_ns = -window_ns;
  for (HostBurst& burst : port.bursts) {
    if (burst.begin_ns > free_ns) {
      idle_ns += burst.begin_ns - free_ns;
      free_ns = burst.begin_ns;
    }
    // Only where more is asked than the line carries does a host have so much.
    if (free_ns - burst.begin_ns > kMostHostNs) burst.frames = 0;
    burst.begin_ns = free_ns;
    free_ns += burst.frames * frame_ns_;
  }
  if (free_ns < 0) idle_ns -= free_ns;
  return std::max(0.0, free_ns);
}

void FrameBursts::append_bursts(Stream& stream, std::size_t index, std::int64_t at_ns,
                                double window_ns, std::vector<HostBurst>& bursts) {
  const BurstStream& parameters = stream.parameters;
  const std::int64_t begin_ns = std::max(parameters.begin.time_since_epoch().count(),
                                         at_ns - static_cast<std::int64_t>(window_ns));
  const std::int64_t end_ns = std::min(parameters.end.time_since_epoch().count(), at_ns);
  if (begin_ns >= end_ns) return;
  const auto append = [&](std::int64_t ns, double frames) {
    if (ns < begin_ns || ns >= end_ns) return;
    bursts.push_back(
        {.begin_ns = static_cast<double>(ns - at_ns), .frames = frames, .stream = index});
  };
  if (parameters.kind == scenarios::TrafficKind::kPaced) {
    const double first =
        std::ceil((static_cast<double>(begin_ns) - stream.phase_ns) / stream.gap_ns) - 1;
    for (double k = first;; ++k) {
      const auto ns = static_cast<std::int64_t>(std::floor(stream.phase_ns + k * stream.gap_ns));
      if (ns >= end_ns) break;
      append(ns, stream.frames);
    }
    return;
  }
  const std::int64_t last = floor_div(end_ns - 1, stream.cell_ns);
  for (std::int64_t c = floor_div(begin_ns, stream.cell_ns); c <= last; ++c) {
    for (const Burst& burst : cell(stream, c).bursts) append(burst.begin_ns, burst.frames);
  }
}

const FrameBursts::Cell& FrameBursts::cell(Stream& stream, std::int64_t number) const {
  Cell& cell = stream.cells[static_cast<std::uint64_t>(number) % kCellsKept];
  if (cell.is_made && cell.number == number) return cell;
  cell.is_made = true;
  cell.number = number;
  cell.bursts.clear();
  RandomStream draws(run_seed_, kRandomBursts, stream.number, static_cast<std::uint64_t>(number));
  const double length_ns = static_cast<double>(stream.cell_ns);
  const double exponent = stream.parameters.tail_exponent;
  const double below = 1 - std::pow(kLargestPerLeast, -exponent);
  for (double at_ns = draws.exponential(stream.gap_ns); at_ns < length_ns;
       at_ns += draws.exponential(stream.gap_ns)) {
    const double size = stream.frames * std::pow(1 - below * draws.uniform(), -1 / exponent);
    // Whole frames with the same mean.
    const double frames = std::floor(size + draws.uniform());
    cell.bursts.push_back(
        {.begin_ns = number * stream.cell_ns + static_cast<std::int64_t>(at_ns), .frames = frames});
  }
  return cell;
}

bool FrameBursts::goes(std::size_t stream, std::size_t from, std::size_t to) const {
  const std::vector<std::size_t>& ports = streams_[stream].parameters.ports;
  for (std::size_t i = 1; i < ports.size(); ++i) {
    if (ports[i - 1] == from && ports[i] == to) return true;
  }
  return false;
}

// The work that the port has left at the query, if it had none at the begin of the window.
double FrameBursts::switch_work(std::size_t port_number, std::int64_t at_ns, double window_ns,
                                double& idle_ns) {
  BurstPort& port = ports_[port_number];
  port.frames.clear();
  for (const std::size_t feeder : port.feeders) {
    if (ports_[feeder].buffer_ns == 0) {
      host_work(feeder, at_ns, -window_ns);
      append_frames(feeder, port_number, port.frames);
    } else {
      double idle_before_ns = 0;
      const double further_ns = 2 * ports_[feeder].buffer_ns;
      switch_work(feeder, at_ns, window_ns + further_ns, idle_before_ns);
      for (const Frame& frame : ports_[feeder].frames) {
        if (frame.at_ns < 0 && goes(frame.stream, feeder, port_number)) {
          port.frames.push_back(frame);
        }
      }
    }
  }
  std::erase_if(port.frames, [&](const Frame& frame) { return frame.at_ns < -window_ns; });
  sort_if_needed(port.frames, [](const Frame& a, const Frame& b) {
    return a.at_ns != b.at_ns ? a.at_ns < b.at_ns : a.stream < b.stream;
  });
  double free_ns = -window_ns;
  pass_frames(port, free_ns, idle_ns);
  return std::max(0.0, free_ns);
}

// Turns the arrivals in port.frames to departures and takes out what is dropped.
void FrameBursts::pass_frames(BurstPort& port, double& free_ns, double& idle_ns) {
  std::size_t kept = 0;
  for (const Frame& frame : port.frames) {
    if (frame.at_ns > free_ns) {
      idle_ns += frame.at_ns - free_ns;
      free_ns = frame.at_ns;
    }
    if (free_ns + frame_ns_ - frame.at_ns > port.buffer_ns) continue;
    free_ns += frame_ns_;
    port.frames[kept++] = {.at_ns = free_ns, .stream = frame.stream};
  }
  port.frames.resize(kept);
  if (free_ns < 0) idle_ns -= free_ns;
}

// The frames of a host's bursts as they come to the next port.
void FrameBursts::append_frames(std::size_t from, std::size_t to,
                                std::vector<Frame>& frames) const {
  for (const HostBurst& burst : ports_[from].bursts) {
    if (!goes(burst.stream, from, to)) continue;
    for (double k = 1; k <= burst.frames; ++k) {
      const double at_ns = burst.begin_ns + k * frame_ns_;
      if (at_ns >= 0) break;
      frames.push_back({.at_ns = at_ns, .stream = burst.stream});
    }
  }
}

}  // namespace simbench::sim

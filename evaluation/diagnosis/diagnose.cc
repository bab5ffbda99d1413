#include "evaluation/diagnosis/diagnose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

#include "evaluation/frames/camera_statistics.h"
#include "recording/counted.h"

namespace simbench::evaluation {
namespace {

constexpr double kGapPeriods = 10;
constexpr double kLeastGapS = 0.5;
constexpr double kLateS = 1;        // a later start or earlier end than this is reported
constexpr double kUnsteady = 0.02;  // jitter as a share of the period
constexpr std::size_t kMostJumps = 3;
constexpr double kLeastClockMs = 1;        // ahead of the recorder
constexpr double kLeastClockApartMs = 50;  // more delay than the quickest camera's
constexpr double kSwapS = 0.5;
constexpr double kSwapShare = 0.5;  // of a period: lateness of the frames around a step

// From the first to the last arrival of a host's cameras, on its clock.
struct Presence {
  double first_s = std::numeric_limits<double>::infinity();
  double last_s = -std::numeric_limits<double>::infinity();
};

// Finds the faults camera by camera.
class Findings {
 public:
  explicit Findings(const Diagnosis& diagnosis) : diagnosis_(diagnosis) {
    for (const CameraDiagnosis& camera : diagnosis.cameras) {
      if (camera.facts.account.delivered == 0) continue;
      Presence& host = hosts_[camera.host];
      host.first_s = std::min(host.first_s, camera.facts.first_arrival_s);
      host.last_s = std::max(host.last_s, camera.facts.last_arrival_s);
    }
  }

  std::vector<Finding> all() {
    for (const CameraDiagnosis& camera : diagnosis_.cameras) {
      camera_ = &camera;
      if (!is_enough(camera)) {
        add_too_little();
        continue;
      }
      add_standing();
      add_lost();
      add_clock();
      add_stamps();
      add_presence();
    }
    for (const PairDiagnosis& pair : diagnosis_.pairs) add_pair(pair);
    return std::move(findings_);
  }

 private:
  // The camera's name, with its stream where it has several.
  std::string name() const {
    const auto streams =
        std::count_if(diagnosis_.cameras.begin(), diagnosis_.cameras.end(),
                      [this](const CameraDiagnosis& c) { return c.camera == camera_->camera; });
    return streams > 1 ? camera_->camera + " " + camera_->stream : camera_->camera;
  }

  void add(const char* kind, std::string_view text) {
    findings_.push_back({.camera = camera_->camera,
                         .stream = camera_->stream,
                         .kind = kind,
                         .text = fmt::format("{}: {}", called_camera(name()), text)});
  }

  const GroupVerdict& group() const {
    return *std::find_if(diagnosis_.groups.begin(), diagnosis_.groups.end(),
                         [this](const GroupVerdict& g) { return g.stream == camera_->stream; });
  }

  // The camera whose period is the common one.
  std::string standard() const {
    const std::size_t index = group().standard.value_or(0);
    std::size_t place = 0;
    for (const CameraDiagnosis& camera : diagnosis_.cameras) {
      if (camera.stream == camera_->stream && place++ == index) return camera.camera;
    }
    return "";
  }

  void add_too_little() {
    const std::int64_t frames = camera_->facts.account.delivered;
    add("too_few_frames", frames == 1 ? "one frame: too few for a diagnosis"
                          : frames > 1
                              ? fmt::format("{} frames, but their stamps do not advance", frames)
                              : std::string("no frame"));
  }

  void add_standing() {
    const Standing& standing = camera_->standing;
    const double rate_hz = 1000 / camera_->facts.host_period_ms;
    switch (standing.follows) {
      case Follows::kOwnClock:
        add("free_running", is_standard()
                                ? std::string("free-running: no other camera has its period")
                                : "free-running: its phase " + moves());
        break;
      case Follows::kOtherRate:
        add("other_rate",
            fmt::format("runs at {:.3f} Hz, no whole fraction of the common rate", rate_hz));
        break;
      case Follows::kHostOrOwn:
        add_host();
        break;
      case Follows::kUnknown:
        if (std::isnan(camera_->facts.host_period_ms)) {
          add("unknown_rate", "too few frames to determine its rate in host time");
        } else if (group().standard) {  // else the verdict reports it for all
          add("unknown_rate", "its rate in host time is too uncertain to compare");
        }
        break;
      case Follows::kTrigger:
        break;
    }
    if (standing.period_multiple > 1 && standing.follows != Follows::kOtherRate) {
      const std::string part =
          standing.period_multiple == 2 ? "half" : fmt::format("1/{} of", standing.period_multiple);
      add("divided_rate",
          fmt::format(
              "{} the rate ({:.3f} Hz): it ignores triggers while it is busy, with too long "
              "an exposure or a trigger faster than half its mode's rate",
              part, rate_hz));
    }
  }

  static bool is_enough(const CameraDiagnosis& camera) {
    return camera.facts.account.delivered >= 2 && camera.facts.period_ms > 0;
  }

  // One finding for all cameras of a host that move together.
  void add_host() {
    std::string names;
    int count = 0;
    for (const CameraDiagnosis& other : diagnosis_.cameras) {
      if (other.stream != camera_->stream || other.host != camera_->host) continue;
      if (!is_enough(other) || other.standing.follows != Follows::kHostOrOwn) continue;
      if (count++ == 0 && &other != camera_) return;  // reported with the first one
      names += (names.empty() ? "" : ", ") + other.camera;
    }
    if (is_standard()) return;  // the others are compared with this host
    const bool alone = count == 1;
    findings_.push_back(
        {.camera = camera_->camera,
         .stream = camera_->stream,
         .kind = "host_or_free_running",
         .text = fmt::format(
             "host {} ({} of camera{} {}): phase {}; the cause may be the host's clock or {}",
             camera_->host, camera_->stream, alone ? "" : "s", names, moves(),
             alone ? "the camera's" : "a trigger of their own")});
  }

  bool is_standard() const { return standard() == camera_->camera; }

  std::string moves() const {
    const Standing& standing = camera_->standing;
    return fmt::format("drifts {:.3g} ms per minute relative to camera {} ({:+.3g} ppm)",
                       standing.moves_ms_per_minute, standard(), standing.rate_ppm);
  }

  void add_lost() {
    const FrameAccount& account = camera_->facts.account;
    if (!camera_->facts.counted) {
      if (account.unknown == 0) return;
      add("missing_frames",
          fmt::format("{} without a frame: lost or never exposed, which nothing tells without a "
                      "frame counter",
                      counted(account.unknown, "period")));
      return;
    }
    if (account.lost > 0) {
      add("lost_frames", fmt::format("{} lost after the camera had counted them: in the "
                                     "camera, on USB or in the host",
                                     counted(account.lost, "frame")));
    }
    if (account.never_exposed > 0) {
      add("skipped_pulses",
          fmt::format("{} never exposed: periods that its counter did not count, because "
                      "the camera missed triggers or there were none",
                      counted(account.never_exposed, "frame")));
    }
    if (account.counter_restarts > 0) {
      add("counter_restarts",
          fmt::format("its frame counter stood still or went back {}: the camera was restarted, or "
                      "frames arrived twice",
                      times(account.counter_restarts)));
    }
    if (account.counter_jumps > 0) {
      add("counter_jumps",
          fmt::format("its frame counter jumps {} by more frames than the time between two allows; "
                      "these are not counted as lost",
                      times(account.counter_jumps)));
    }
  }

  void add_clock() {
    const StreamFacts& facts = camera_->facts;
    if (facts.one_clock) {
      add("one_clock",
          "its arrivals are its stamps, as from one column of a file: there is one clock only, so "
          "that nothing tells a camera's clock from its host's");
    } else if (facts.stamped_by_host) {
      add_host_clock();
    } else if (facts.global_time) {
      add("global_time",
          "its stamps count from 1970, as a computer's clock does and no camera's: with "
          "librealsense's global time they are the host's own estimate. Record with global time "
          "off");
    } else if (is_doubtful_drift(facts.drift_ppm)) {
      add("doubtful_rate",
          fmt::format("its clock and its host's differ by {:.0f} ppm, where some tens are usual: "
                      "are both stamps milliseconds of one camera?",
                      facts.drift_ppm));
    }
  }

  // Header stamps and arrivals may be of two computers: their difference has the delay in it, which
  // is positive, and much the same for all cameras.
  void add_host_clock() {
    const double delay_ms = camera_->facts.least_delay_ms;
    double least_ms = delay_ms;
    const CameraDiagnosis* earliest = camera_;
    for (const CameraDiagnosis& other : diagnosis_.cameras) {
      if (!(other.facts.least_delay_ms < least_ms)) continue;
      least_ms = other.facts.least_delay_ms;
      earliest = &other;
    }
    if (delay_ms < -kLeastClockMs) {
      add("clock_ahead",
          fmt::format("its stamps are {:.1f} ms later than the recorder had its frames: the clock "
                      "that made them is ahead of the recorder's by at least that",
                      -delay_ms));
    } else if (delay_ms - std::max(least_ms, 0.0) > kLeastClockApartMs) {
      add("clock_apart",
          fmt::format(
              "the recorder has its frames {:.1f} ms after their stamps, those of camera "
              "{} after {:.1f} ms: the clocks that made the stamps are apart, or its frames "
              "are held up",
              delay_ms, earliest->camera, least_ms));
    }
  }

  void add_jumps() {
    const StreamFacts& facts = camera_->facts;
    std::size_t shown = 0;
    for (const StampJump& jump : facts.jumps) {
      if (const CameraDiagnosis* other = swapped_with(*camera_, jump)) {
        add("swapped", fmt::format("at {:.1f} s it changes places with {}: each goes on with the "
                                   "stamps of the other",
                                   jump.at_s, called_camera(other->camera)));
        continue;
      }
      if (shown++ == kMostJumps) {
        const std::size_t more = facts.jumps.size() - kMostJumps;
        add("jumps", counted(more, "more jump"));
        break;
      }
      if (jump.periods != 0) {
        add("period_slip",
            fmt::format("at {:.1f} s its stamps slip permanently by {} period{} relative to "
                        "their arrivals",
                        jump.at_s, -jump.periods, std::abs(jump.periods) > 1 ? "s" : ""));
      } else {
        add("clock_step",
            fmt::format("at {:.1f} s arrivals and stamps move apart permanently by {:.3f} ms: "
                        "a clock was set",
                        jump.at_s, jump.step_ms));
      }
    }
  }

  void add_stamps() {
    const StreamFacts& facts = camera_->facts;
    if (facts.repeated_stamps > 0) {
      add("repeated_stamps", fmt::format("{} with the stamp of the frame before",
                                         counted(facts.repeated_stamps, "frame")));
    }
    for (const DelayBurst& burst : facts.bursts) {
      add("late_burst",
          fmt::format(
              "from {:.1f} s on, for {:.2f} s, {} came up to {:.1f} ms later than usual: the "
              "host or its bus was busy",
              burst.at_s, burst.for_s, counted(static_cast<std::uint64_t>(burst.late), "frame"),
              burst.most_ms));
    }
    add_jumps();
    if (facts.interval_jitter_ms > kUnsteady * facts.period_ms) {
      add("unsteady",
          fmt::format("unsteady: its intervals differ from whole periods of {1:.3f} ms by {0:.3f} "
                      "ms (standard deviation), {2:.1f} % are within a tenth of a period",
                      facts.interval_jitter_ms, facts.period_ms, facts.on_grid_share * 100));
    }
    if (facts.future_stamps > 0) {
      add("future_stamps",
          fmt::format("{} in the future: up to {:.1f} ms later than the delay of all other "
                      "frames allows",
                      counted(facts.future_stamps, "stamp"), facts.future_ms));
    }
    // Another camera's clock may well be behind.
    if (facts.backward_stamps > (is_swapped() ? 1 : 0)) {
      add("backward_stamps", "its stamps go back " + times(facts.backward_stamps));
    }
    if (facts.backward_arrivals > 0) {
      add("backward_arrivals", fmt::format("arrivals go back {}: its host's clock was set back",
                                           times(facts.backward_arrivals)));
    }
    if (facts.wraps > 0) {
      add("register_wraps",
          fmt::format("its 32-bit microsecond register wraps {} (every 71.6 min): "
                      "no fault, but programs must expect it",
                      times(facts.wraps)));
    }
  }

  std::string of_host() const { return hosts_.size() > 1 ? " of " + camera_->host : ""; }

  void add_presence() {
    const StreamFacts& facts = camera_->facts;
    if (facts.longest_gap_s > kLeastGapS &&
        facts.longest_gap_s > kGapPeriods * facts.period_ms * 1e-3) {
      add("stalled", fmt::format("no frame for {:.2f} s, {:.1f} s after its first",
                                 facts.longest_gap_s, facts.gap_at_s));
    }
    const Presence& host = hosts_.at(camera_->host);
    if (const double late_s = facts.first_arrival_s - host.first_s; late_s > kLateS) {
      add("late_start", fmt::format("starts {:.1f} s after the first camera{}", late_s, of_host()));
    }
    if (const double early_s = host.last_s - facts.last_arrival_s; early_s > kLateS) {
      add("ended_early", fmt::format("ends {:.1f} s before the last camera{}", early_s, of_host()));
    }
  }

  // Two streams of one kind whose stamps step at one time, one as far up as the other down, have
  // changed places.
  bool are_swapped(const CameraDiagnosis& a, const StampJump& jump_a, const CameraDiagnosis& b,
                   const StampJump& jump_b) const {
    const double apart_s =
        a.facts.first_arrival_s + jump_a.at_s - (b.facts.first_arrival_s + jump_b.at_s);
    return &a != &b && a.stream == b.stream && std::abs(apart_s) < kSwapS &&
           std::abs(jump_a.step_ms + jump_b.step_ms) < kSwapShare * a.facts.period_ms;
  }

  // The camera with which this one changes places at this jump.
  const CameraDiagnosis* swapped_with(const CameraDiagnosis& camera, const StampJump& jump) const {
    for (const CameraDiagnosis& other : diagnosis_.cameras) {
      for (const StampJump& its : other.facts.jumps) {
        if (are_swapped(camera, jump, other, its)) return &other;
      }
    }
    return nullptr;
  }

  bool is_swapped() const {
    return std::ranges::any_of(camera_->facts.jumps, [this](const StampJump& jump) {
      return swapped_with(*camera_, jump) != nullptr;
    });
  }

  void add_pair(const PairDiagnosis& pair) {
    if (!pair.runs_free) return;
    findings_.push_back(
        {.camera = pair.camera,
         .stream = pair.stream,
         .kind = "stream_runs_free",
         .text = fmt::format("{}: {} does not follow {}: its offset drifts {:.3g} ms per minute",
                             called_camera(pair.camera), pair.stream, pair.against,
                             pair.moves_ms_per_minute)});
  }

  const Diagnosis& diagnosis_;
  const CameraDiagnosis* camera_ = nullptr;
  std::map<std::string, Presence> hosts_;  // whose clocks may have nothing in common
  std::vector<Finding> findings_;
};

// Kinds of streams in order of occurrence, depth before all others: it is what triggers drive.
std::vector<std::string> kinds_of(const std::vector<RecordedStream>& streams) {
  std::vector<std::string> kinds;
  for (const RecordedStream& stream : streams) {
    if (std::find(kinds.begin(), kinds.end(), stream.stream) == kinds.end()) {
      kinds.push_back(stream.stream);
    }
  }
  std::stable_partition(kinds.begin(), kinds.end(), [](const std::string& kind) {
    return kind.starts_with("Depth") || kind.starts_with("depth");
  });
  return kinds;
}

GroupVerdict judge_kind(const std::string& kind, Diagnosis& diagnosis,
                        const DiagnoseOptions& options) {
  std::vector<GroupMember> members;
  for (CameraDiagnosis& camera : diagnosis.cameras) {
    if (camera.stream == kind) {
      members.push_back({camera.camera, camera.host, &camera.facts, &camera.standing});
    }
  }
  std::optional<double> period_ms;
  if (options.rate_hz) period_ms = 1000 / *options.rate_hz;
  return judge_group(kind, members, period_ms);
}

// Compares every other stream of a camera with that of its first kind.
std::vector<PairDiagnosis> pairs_of(const std::vector<RecordedStream>& streams,
                                    const std::vector<std::string>& kinds) {
  std::vector<PairDiagnosis> pairs;
  for (const RecordedStream& stream : streams) {
    const RecordedStream* first = &stream;
    const auto rank = [&kinds](const RecordedStream& s) {
      return std::find(kinds.begin(), kinds.end(), s.stream);
    };
    for (const RecordedStream& other : streams) {
      if (other.camera == stream.camera && rank(other) < rank(*first)) first = &other;
    }
    if (first == &stream) continue;
    PairDiagnosis pair = compare_streams(stream.frames, first->frames);
    pair.camera = stream.camera;
    pair.stream = stream.stream;
    pair.against = first->stream;
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

// The questions about this rig that stamps cannot answer.
std::vector<std::string> cannot_know(const Diagnosis& diagnosis) {
  std::vector<std::string> texts = {
      "whether the exposures coincide: no stamp shows a constant delay (trigger cabling, exposure "
      "time, latency). Film one flash with all cameras once.",
      "which frames belong together: cameras with one period may still be whole periods apart."};
  if (std::any_of(diagnosis.cameras.begin(), diagnosis.cameras.end(),
                  [](const CameraDiagnosis& c) { return c.facts.stamped_by_host; })) {
    texts.emplace_back(
        "what the cameras' clocks say: header stamps are of a computer, which made them when a "
        "driver had the frame. Record the metadata topics, or with hardware stamps.");
  }
  if (std::any_of(diagnosis.cameras.begin(), diagnosis.cameras.end(),
                  [](const CameraDiagnosis& c) { return c.facts.one_clock; })) {
    texts.emplace_back(
        "the delays of frames: arrivals and sensor stamps are one column, so that there is one "
        "clock only. Record both.");
  }
  const std::string host = diagnosis.cameras.empty() ? "" : diagnosis.cameras.front().host;
  if (std::any_of(diagnosis.cameras.begin(), diagnosis.cameras.end(),
                  [&host](const CameraDiagnosis& camera) { return camera.host != host; })) {
    texts.emplace_back(
        "phases between hosts: they are as accurate as the hosts' common zero and clocks "
        "(--one-host: all files are of one computer).");
  }
  return texts;
}

}  // namespace

std::string called_camera(const std::string& name) {
  return name.starts_with("camera") ? name : "camera " + name;
}

Diagnosis diagnose(const std::vector<RecordedStream>& streams, const DiagnoseOptions& options) {
  Diagnosis diagnosis;
  for (const RecordedStream& stream : streams) {
    diagnosis.cameras.push_back({.camera = stream.camera,
                                 .host = options.one_host ? "" : stream.host,
                                 .stream = stream.stream,
                                 .facts = stream_facts(stream),
                                 .standing = {}});
  }
  const std::vector<std::string> kinds = kinds_of(streams);
  for (const std::string& kind : kinds) {
    diagnosis.groups.push_back(judge_kind(kind, diagnosis, options));
  }
  if (!diagnosis.groups.empty()) diagnosis.verdict = diagnosis.groups.front();
  diagnosis.pairs = pairs_of(streams, kinds);
  diagnosis.findings = Findings(diagnosis).all();
  diagnosis.cannot_know = cannot_know(diagnosis);
  return diagnosis;
}

}  // namespace simbench::evaluation

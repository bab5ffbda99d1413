#include "watch/open_metrics.h"

#include <fmt/format.h>

#include <map>
#include <vector>

namespace simbench::watch {
namespace {

using reports::Json;

struct OpenMetric {
  const char* name;
  const char* help;
  bool is_counter;
  const char* member;  // of the snapshot's camera or clock
  double factor;       // to the base unit
};

constexpr OpenMetric kCameraMetrics[] = {
    {"simbench_camera_rate_hertz", "Frames that arrive in a second", false, "rate_hz", 1},
    {"simbench_camera_phase_seconds", "Phase against the reference camera", false, "phase_ms",
     1e-3},
    {"simbench_camera_moved_seconds", "How far the phase has moved", false, "moved_ms", 1e-3},
    {"simbench_camera_frames", "Frames since the watch began", true, "frames", 1},
    {"simbench_camera_lost_frames", "Frames lost, by the counter", true, "lost", 1},
    {"simbench_camera_lost_ratio", "Share of the frames of the last 10 s that was lost", false,
     "lost_share", 1},
    {"simbench_camera_slips", "How often the phase slipped", true, "slips", 1},
};
constexpr OpenMetric kClockMetrics[] = {
    {"simbench_clock_error_seconds", "The last time error", false, "error_ms", 1e-3},
    {"simbench_clock_max_error_seconds", "The largest of the last errors", false, "max_te_ms",
     1e-3},
    {"simbench_clock_rms_error_seconds", "The RMS of the last errors", false, "rms_te_ms", 1e-3},
    {"simbench_clock_steps", "How often the clock stepped", true, "steps", 1},
    {"simbench_clock_samples", "Errors since the watch began", true, "samples", 1},
};

std::string escaped_label(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\' || c == '"') escaped += '\\';
    escaped += c == '\n' ? std::string("\\n") : std::string(1, c);
  }
  return escaped;
}

std::string labels(const Json& of, const std::vector<const char*>& members) {
  std::string text;
  for (const char* const member : members) {
    text += fmt::format("{}{}=\"{}\"", text.empty() ? "" : ",", member,
                        escaped_label(of.at(member).get<std::string>()));
  }
  return text;
}

template <std::size_t kCount>
void add_metrics(const OpenMetric (&metrics)[kCount], const Json& things,
                 const std::vector<const char*>& members, std::string& text) {
  for (const OpenMetric& metric : metrics) {
    text += fmt::format("# TYPE {} {}\n# HELP {} {}.\n", metric.name,
                        metric.is_counter ? "counter" : "gauge", metric.name, metric.help);
    for (const Json& thing : things) {
      const Json& value = thing.at(metric.member);
      if (!value.is_number()) continue;
      const double number = value.get<double>() * metric.factor;
      if (!(number - number == 0)) continue;
      text += fmt::format("{}{}{{{}}} {:.9g}\n", metric.name, metric.is_counter ? "_total" : "",
                          labels(thing, members), number);
    }
  }
}

}  // namespace

std::string open_metrics(const Json& snapshot) {
  std::map<std::string, int> alarms;
  for (const Json& alarm : snapshot.at("alarms")) ++alarms[alarm.at("kind").get<std::string>()];
  std::string text = "# TYPE simbench_alarms gauge\n# HELP simbench_alarms Open alarms.\n";
  for (const auto& [kind, count] : alarms) {
    text += fmt::format("simbench_alarms{{kind=\"{}\"}} {}\n", escaped_label(kind), count);
  }
  text += fmt::format(
      "# TYPE simbench_in_order gauge\n# HELP simbench_in_order Whether no alarm is open.\n"
      "simbench_in_order {}\n",
      snapshot.at("status") == "in order" ? 1 : 0);
  add_metrics(kCameraMetrics, snapshot.at("cameras"), {"camera", "host", "stream"}, text);
  add_metrics(kClockMetrics, snapshot.at("clocks"), {"subject", "file"}, text);
  return text + "# EOF\n";
}

}  // namespace simbench::watch

#include "watch/watch_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/text/block.h"
#include "reports/text/plain_text.h"
#include "reports/text/time_text.h"

namespace simbench::watch {
namespace {

using reports::Align;
using reports::Json;

constexpr std::size_t kEventsShown = 6;

std::string number_or_dash(const Json& value, const char* format) {
  if (!value.is_number() || std::isnan(value.get<double>())) return "-";
  return fmt::format(fmt::runtime(format), value.get<double>());
}

std::string time_or_dash(const Json& value) {
  if (!value.is_number() || std::isnan(value.get<double>())) return "-";
  const double ms = value.get<double>();
  return (ms < 0 ? "-" : "") + reports::time_text(std::abs(ms));
}

std::string long_time(double seconds) {
  if (seconds < 120) return fmt::format("{:.0f} s", seconds);
  if (seconds < 7200) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

std::string camera_table(const Json& cameras) {
  reports::Table table({{"camera", Align::kLeft},
                        {"stream", Align::kLeft},
                        {"state", Align::kLeft},
                        {"rate Hz"},
                        {"phase"},
                        {"moved"},
                        {"scatter"},
                        {"frames"},
                        {"lost"},
                        {"slips"}});
  for (const Json& camera : cameras) {
    table.add({camera.at("camera"), camera.at("stream"), camera.at("state"),
               number_or_dash(camera.at("rate_hz"), "{:.2f}"), time_or_dash(camera.at("phase_ms")),
               time_or_dash(camera.at("moved_ms")), time_or_dash(camera.at("scatter_ms")),
               camera.at("frames").dump(),
               camera.at("lost").is_null() ? "-" : camera.at("lost").dump(),
               camera.at("slips").dump()});
  }
  return plain(table);
}

std::string clock_table(const Json& clocks) {
  reports::Table table(
      {{"clock", Align::kLeft}, {"error"}, {"largest"}, {"RMS"}, {"steps"}, {"samples"}});
  for (const Json& clock : clocks) {
    table.add({clock.at("subject"), time_or_dash(clock.at("error_ms")),
               time_or_dash(clock.at("max_te_ms")), time_or_dash(clock.at("rms_te_ms")),
               clock.at("steps").dump(), clock.at("samples").dump()});
  }
  return plain(table);
}

}  // namespace

std::string watch_text(const Json& snapshot) {
  const double now_s = snapshot.at("now_s");
  std::string text =
      reports::wrapped(fmt::format("{}, for {}: {}", snapshot.at("status").get<std::string>(),
                                   long_time(now_s - snapshot.at("since_s").get<double>()),
                                   snapshot.at("text").get<std::string>()));
  for (const Json& alarm : snapshot.at("alarms")) {
    text += reports::wrapped(fmt::format("  ! {} ({} ago)", alarm.at("text").get<std::string>(),
                                         long_time(now_s - alarm.at("since_s").get<double>())),
                             4);
  }
  if (!snapshot.at("cameras").empty()) text += "\n" + camera_table(snapshot.at("cameras"));
  if (!snapshot.at("clocks").empty()) text += "\n" + clock_table(snapshot.at("clocks"));
  const Json& diagnosis = snapshot.at("diagnosis");
  if (!diagnosis.is_null()) {
    text += "\n" + reports::wrapped("diagnose: " + diagnosis.at("lead").get<std::string>());
  }
  const Json& events = snapshot.at("events");
  const std::size_t first = events.size() > kEventsShown ? events.size() - kEventsShown : 0;
  if (!events.empty()) text += "\nLast events\n";
  for (std::size_t i = first; i < events.size(); ++i) {
    text += reports::wrapped("  " + events[i].at("text").get<std::string>(), 4);
  }
  return text;
}

}  // namespace simbench::watch

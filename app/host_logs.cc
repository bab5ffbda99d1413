#include "app/host_logs.h"

#include <cstddef>
#include <filesystem>
#include <utility>

namespace simbench::app {
namespace {

// What a file has; a table is one log, whose columns are no clocks.
std::vector<std::string> series_of(const std::string& file) {
  std::vector<std::string> names;
  for (const evaluation::ClockLogSeries& series : evaluation::clock_log_series(file)) {
    if (series.format == "csv") return {""};
    names.push_back(series.name);
  }
  return names;
}

}  // namespace

HostLogs host_logs(const std::vector<std::string>& given) {
  HostLogs found;
  for (const std::string& text : given) {
    const std::size_t equals = text.find('=');
    const bool has_host = equals != std::string::npos && !std::filesystem::exists(text);
    const std::string file = has_host ? text.substr(equals + 1) : text;
    const std::string host = has_host ? text.substr(0, equals) : "";
    for (const std::string& series : series_of(file)) {
      evaluation::ClockLog log = evaluation::read_clock_log(file, {.series = series});
      found.notes.insert(found.notes.end(), log.notes.begin(), log.notes.end());
      found.logs.push_back({.host = host, .log = std::move(log)});
    }
  }
  return found;
}

}  // namespace simbench::app

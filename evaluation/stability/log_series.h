// The series of a clock log while it is read: whose each point is, and which one is asked for.
//
//   const std::string path = "ptp4l.log";
//   LogSeriesSet set({.series = "eth0"});
//   set.add({.format = "ptp4l", .name = "eth0"}, {path, 17});
//   const ClockLog log = set.take({path, 17}, true);
//
// Complexity: constant for each point. Memory: 16 bytes a point.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "evaluation/stability/clock_log.h"
#include "evaluation/stability/log_lines.h"

namespace simbench::evaluation {

class LogSeriesSet {
 public:
  explicit LogSeriesSet(ClockLogOptions options) : options_(std::move(options)) {}

  // Throws scenarios::InputError for the series beyond kMostLogSeries.
  void add(const LogLine& line, const LogPlace& place);
  bool empty() const { return series_.empty(); }
  // With the names that tell them apart.
  std::vector<ClockLogSeries> list();
  // The one that the options ask for. Throws scenarios::InputError if there are several or none.
  ClockLog take(const LogPlace& place, bool absolute);

 private:
  struct Series {
    std::string format{};
    std::string host{};
    std::string process{};
    std::string tag{};
    std::string name{};
    std::vector<ClockLogPoint> points{};
    std::vector<double> largest_s{};
    std::vector<std::size_t> segments{};
    std::vector<ClockLog::Boot> boots{};
    std::size_t unlocked = 0;
    std::size_t first_line = 0;
    std::size_t last_line = 0;
    std::string label{};

    bool is_of_same_clock(const Series& other) const;
    void append(Series next);
    // Whether `asked` is one of its names.
    bool has_name(const std::string& asked) const;
  };

  Series& series_of(const LogLine& line, const LogPlace& place);
  // Processes of one program, each begun behind the end of the last one, are one series.
  void join_restarts();
  void name_series();
  Series& chosen(const LogPlace& place);

  ClockLogOptions options_;
  std::vector<Series> series_{};
  std::unordered_map<std::string, std::size_t> index_{};
  std::string key_{};
  bool joined_ = false;
};

// What is said of a file whose times go back so often: "FILE: ...".
std::string segments_note(const std::string& path, std::size_t segments);

}  // namespace simbench::evaluation

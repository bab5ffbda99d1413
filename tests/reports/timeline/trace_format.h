// The rules of the Chrome trace event format, as far as simbench uses it, and what one may expect
// of a timeline besides: every violation in a trace as a line of text.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace simbench {

class TraceFormat {
 public:
  using Json = nlohmann::ordered_json;

  // Empty if all is well; at most some.
  static std::vector<std::string> violations(const Json& trace) {
    TraceFormat format;
    if (!trace.contains("traceEvents") || trace.value("displayTimeUnit", "") != "ms") {
      return {"no traceEvents or displayTimeUnit"};
    }
    if (!trace.contains("otherData")) format.found("no otherData");
    for (const Json& event : trace["traceEvents"]) format.check(event);
    format.check_arrows();
    return format.violations_;
  }

  static std::int64_t ns(const Json& us) { return std::llround(us.get<double>() * 1e3); }

 private:
  struct Track {
    std::int64_t last = -1;
    std::vector<std::pair<std::int64_t, std::int64_t>> slices;
  };
  struct Point {
    char phase;
    std::int64_t at;
    std::int64_t track;
  };

  void found(const std::string& what) {
    if (violations_.size() < 20) violations_.push_back(what);
  }

  void check(const Json& event) {
    for (const char* member : {"ts", "pid", "tid"}) {
      if (!event.contains(member) || !event[member].is_number()) {
        return found(fmt::format("no number {}: {}", member, event.dump()));
      }
    }
    const std::string phase = event.value("ph", "");
    if (event.value("name", "").empty()) found("no name: " + event.dump());
    const std::int64_t at = ns(event["ts"]);
    const std::int64_t tid = event["tid"];
    if (at < 0) found("before zero: " + event.dump());
    if (phase == "M") return check_name(event);
    if (!processes_.contains(event["pid"])) found("a process without a name: " + event.dump());
    const auto thread = threads_.find(tid);
    if (thread == threads_.end() || thread->second != event["pid"]) {
      found("a thread without a name: " + event.dump());
    }
    Track& track = tracks_[tid];
    if (at < track.last) found("back in time: " + event.dump());
    track.last = at;
    if (phase == "X") {
      const std::int64_t end = at + ns(event.value("dur", Json(-1)));
      if (end <= at) found("no length: " + event.dump());
      if (!track.slices.empty() && track.slices.back().second > at) {
        found("overlaps the one before it: " + event.dump());
      }
      track.slices.emplace_back(at, end);
    } else if (phase == "C") {
      if (!event.contains("args") || event["args"].empty()) found("no value: " + event.dump());
      for (const auto& [name, value] : event["args"].items()) {
        if (!value.is_number()) found("no number: " + event.dump());
      }
    } else if (phase == "i") {
      if (event.value("s", "") != "t") found("an instant without a scope: " + event.dump());
    } else if (phase == "s" || phase == "t" || phase == "f") {
      arrows_[{event.value("cat", ""), event["id"]}].push_back({phase.front(), at, tid});
      if (phase != "s" && event.value("bp", "") != "e") found("binds to the next: " + event.dump());
    } else {
      found("an unknown phase: " + event.dump());
    }
  }

  void check_name(const Json& event) {
    if (event["name"] == "process_name") processes_.insert(event["pid"].get<std::int64_t>());
    if (event["name"] == "thread_name") {
      if (!threads_.emplace(event["tid"], event["pid"]).second) found("two names: " + event.dump());
    }
  }

  void check_arrows() {
    for (const auto& [id, points] : arrows_) {
      const std::string name = fmt::format("{} {}", id.first, id.second);
      if (points.size() < 2 || points.front().phase != 's' || points.back().phase != 'f') {
        found("an arrow that dangles: " + name);
      }
      for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        if (points[i].phase != 't') found("an arrow in pieces: " + name);
      }
      for (const Point& point : points) {
        const auto& slices = tracks_[point.track].slices;
        auto after = std::upper_bound(slices.begin(), slices.end(),
                                      std::pair(point.at, std::int64_t{INT64_MAX}));
        if (after == slices.begin() || std::prev(after)->second <= point.at) {
          found(fmt::format("an arrow that touches no slice: {} at {} ns", name, point.at));
        }
      }
    }
  }

  std::vector<std::string> violations_;
  std::set<std::int64_t> processes_;
  std::map<std::int64_t, std::int64_t> threads_;
  std::map<std::int64_t, Track> tracks_;
  std::map<std::pair<std::string, std::int64_t>, std::vector<Point>> arrows_;
};

}  // namespace simbench

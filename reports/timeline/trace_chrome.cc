#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "recording/program_failure.h"
#include "recording/version.h"
#include "reports/results/json.h"
#include "reports/text/json_node.h"
#include "reports/timeline/trace.h"
#include "reports/timeline/trace_events.h"

namespace simbench::reports {
namespace {

double us(Nanoseconds time) { return static_cast<double>(time.count()) * 1e-3; }

class ChromeWriter {
 public:
  ChromeWriter(const Trace& trace, std::ostream& out)
      : trace_(trace), timeline_(trace_timeline(trace)), out_(out) {
    if (!timeline_.events.empty()) zero_ = std::min(zero_, timeline_.events.front().at);
  }

  void write() {
    line_ = "{\"traceEvents\":[\n";
    write_names();
    for (const TraceEvent& event : timeline_.events) write(event);
    flush();
    out_ << "\n],\n\"displayTimeUnit\":\"ms\",\n\"otherData\":" << other_data().dump() << "}\n";
  }

 private:
  std::size_t pid(std::uint32_t track) const { return timeline_.tracks[track].process + 1U; }
  // No thread has the number of a process.
  std::size_t tid(std::uint32_t track) const { return timeline_.processes.size() + 1 + track; }

  void write_names() {
    std::vector<bool> named(timeline_.processes.size(), false);
    for (std::uint32_t track = 0; track < timeline_.tracks.size(); ++track) {
      const std::uint32_t process = timeline_.tracks[track].process;
      if (!named[process]) {
        named[process] = true;
        write_name(track, "process_name", "name", Json(timeline_.processes[process]).dump());
        write_name(track, "process_sort_index", "sort_index", fmt::format("{}", process));
      }
      write_name(track, "thread_name", "name", Json(timeline_.tracks[track].name).dump());
      write_name(track, "thread_sort_index", "sort_index", fmt::format("{}", track));
    }
  }

  void write_name(std::uint32_t track, const char* what, const char* key,
                  const std::string& value) {
    separate();
    add(R"({{"ph":"M","ts":0,"pid":{},"tid":{},"name":"{}","args":{{"{}":{}}}}})", pid(track),
        tid(track), what, key, value);
  }

  void write(const TraceEvent& event) {
    separate();
    add(R"({{"ph":"{}","ts":{:.3f},"pid":{},"tid":{})", static_cast<char>(event.phase),
        us(event.at - zero_), pid(event.track), tid(event.track));
    if (event.phase == TracePhase::kSlice) add(R"(,"dur":{:.3f})", us(event.length));
    if (event.phase == TracePhase::kInstant) add(R"(,"s":"t")");
    switch (event.what) {
      case TraceWhat::kFrameArrow:
      case TraceWhat::kMessageArrow:
        write_arrow(event);
        break;
      case TraceWhat::kExposure:
      case TraceWhat::kUsb:
      case TraceWhat::kHostStack:
      case TraceWhat::kLostInCamera:
      case TraceWhat::kLostOnUsb:
      case TraceWhat::kLostInQueue:
      case TraceWhat::kNotPassed:
        write_frame(event, trace_.frames[event.subject]);
        break;
      case TraceWhat::kSent:
      case TraceWhat::kReceived:
      case TraceWhat::kLostMessage:
        write_message(event, trace_.messages[event.subject]);
        break;
      default:
        write_other(event);
    }
    line_ += '}';
  }

  // "bp": the arrow attaches to the slice around its point, not to the next one.
  void write_arrow(const TraceEvent& event) {
    const char* kind = event.what == TraceWhat::kFrameArrow ? "frame" : "message";
    const char* binding = event.phase == TracePhase::kArrowBegin ? "" : R"(,"bp":"e")";
    add(R"(,"cat":"{}","name":"{}","id":{}{})", kind, kind, event.arrow, binding);
  }

  // Null: no loss.
  static const char* loss_name(TraceWhat what) {
    switch (what) {
      case TraceWhat::kLostInCamera:
        return "lost in camera";
      case TraceWhat::kLostOnUsb:
        return "lost on usb";
      case TraceWhat::kLostInQueue:
        return "lost in queue";
      case TraceWhat::kNotPassed:
        return "not passed on";
      default:
        return nullptr;
    }
  }

  void write_frame(const TraceEvent& event, const TraceFrame& frame) {
    const ObservedFrame& way = frame.way;
    if (const char* const loss = loss_name(event.what); loss != nullptr) {
      add(R"(,"cat":"frame","name":"{}","args":{{"frame":{}}})", loss, way.counter);
      return;
    }
    add(R"(,"cat":"frame","name":"frame {}","args":{{"frame":{},"camera":{},"stream":"{}")",
        way.counter, way.counter, way.camera, to_text(way.stream));
    if (way.pulse >= 0) add(R"(,"pulse":{})", way.pulse);
    if (event.what == TraceWhat::kHostStack) {
      add(R"(,"kernel_copy_us":{:.3f})", us(way.copied - way.transferred));
      if (frame.stamp) {
        add(R"(,"stamp_error_us":{:.3f})",
            us(frame.stamp->time_since_epoch() - frame.reference.time_since_epoch()));
      }
    }
    line_ += '}';
  }

  void write_message(const TraceEvent& event, const ObservedMessage& message) {
    const char* what = "lost";
    if (event.what == TraceWhat::kSent) what = "sent";
    if (event.what == TraceWhat::kReceived) what = "received";
    add(R"(,"cat":"message","name":"{} {}","args":{{"message":{},"from":{},"to":{})", what,
        message.id, message.id, message.from, message.to);
    add(R"(,"transport":"{}","bytes":{})", message.stream ? "stream" : "datagram", message.bytes);
    if (!message.lost) add(R"(,"latency_us":{:.3f})", us(message.arrived - message.left));
    line_ += '}';
  }

  void write_other(const TraceEvent& event) {
    if (event.what == TraceWhat::kPulse) {
      const std::int64_t pulse = trace_.pulses[event.subject].pulse;
      add(R"(,"cat":"pulse","name":"pulse {}","args":{{"pulse":{}}})", pulse, pulse);
    } else if (event.what == TraceWhat::kCaptureStart) {
      add(R"(,"cat":"pulse","name":"capture starts")");
    } else if (event.what == TraceWhat::kSet) {
      const TraceSet& set = trace_.sets[event.subject];
      add(R"(,"cat":"set","name":"{}","args":{{"frames":{},"stamps_range_us":{:.3f})",
          set.complete ? "set" : "partial set", set.members, us(set.range));
      if (set.certified_ms) add(R"(,"certified_ms":{:.6f})", *set.certified_ms);
      add("}}");
    } else if (event.what == TraceWhat::kClock) {
      add(R"(,"cat":"clock","name":"clock error, TE","args":{{"us":{:.3f}}})",
          us(trace_.clocks[event.subject].error));
    } else if (event.what == TraceWhat::kSession) {
      write_session(trace_.sessions[event.subject].last);
    } else {
      const TraceAdjustment& adjustment = trace_.adjustments[event.subject];
      add(R"(,"cat":"clock","name":"{}","args":{{"step_us":{:.3f},"rate_ppb":{}}})",
          adjustment.step.count() != 0 ? "step" : "rate", us(adjustment.step), adjustment.rate_ppb);
    }
  }

  void write_session(const SessionDelays& last) {
    add(R"(,"cat":"session","name":"session","args":{{"passes":{},"t_l_ms":{:.6f})", last.pass,
        to_ms(last.t_l));
    add(R"(,"t_t_ms":{:.6f},"t_d_ms":{:.6f})", to_ms(last.t_t), to_ms(last.t_d));
    add(R"(,"get_ms":{:.6f},"set_ms":{:.6f}}})", to_ms(last.get), to_ms(last.set));
  }

  Json other_data() const {
    Json data = {{"simbench", version()}, {"scenario", trace_.scenario}};
    state_derivation(trace_.derivation, data);
    data.update(
        {{"pipeline", trace_.pipeline},
         {"seed", trace_.seed},
         {"events", timeline_.events.size()},
         {"time", "ts and dur in microseconds of true time"},
         {"ts_0_is_true_time_us", us(zero_.time_since_epoch())},
         {"nominal_lengths_us", {{"pulse", us(kShownPulse)}, {"message", us(kShownMessage)}}},
         {"left_out", left_out_notes(trace_)}});
    if (!trace_.program_failures.empty()) {
      data["program_failures"] = failure_lines(trace_.program_failures);
    }
    return data;
  }

  void separate() {
    if (!is_first_) line_ += ",\n";
    is_first_ = false;
    if (line_.size() >= kChunk) flush();
  }
  void flush() {
    out_ << line_;
    line_.clear();
  }
  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(line_), format, std::forward<Values>(values)...);
  }

  static constexpr std::size_t kChunk = 1 << 16;

  const Trace& trace_;
  TraceTimeline timeline_;
  std::ostream& out_;
  TrueTime zero_{};
  std::string line_;
  bool is_first_ = true;
};

}  // namespace

void write_chrome_trace(const Trace& trace, std::ostream& out) { ChromeWriter(trace, out).write(); }

}  // namespace simbench::reports

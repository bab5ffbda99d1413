#include "recording/event_text.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace simbench {
namespace {

constexpr std::string_view kFrameKind = "frame";
// The kinds of RecordingEvent, in its order.
constexpr std::array<std::string_view, std::variant_size_v<RecordingEvent>> kKinds = {
    "pulse",     "adjustment", "poll",   "exchange", "outcome",
    "alignment", "led",        "delays", "program",  "pps"};
static_assert(!kKinds.back().empty(), "every event has a kind");

template <class Value, class Event>
concept Any = std::same_as<std::remove_const_t<Value>, Event>;

// The members of each event in the order of its line, with their names: for writing and reading.

void members(const auto& form, Any<FrameRecord> auto& frame) {
  form("camera", frame.camera);
  form("stream", frame.stream);
  form("domain", frame.domain);
  form("counter", frame.counter);
  form("exposure_us", frame.exposure_us);
  form("sensor_us", frame.sensor.us);
  form("frame_us", frame.frame.us);
  form("backend_ns", frame.backend);
  form("arrival_ns", frame.arrival);
  form("arrival_steady_ns", frame.arrival_steady);
}

void members(const auto& form, Any<FrameTruth> auto& truth) {
  form("pulse", truth.pulse);
  form("exposure_start_ns", truth.exposure_start);
  form("exposure_end_ns", truth.exposure_end);
  form("reference_ns", truth.reference);
  form("own_host_ns", truth.own_host);
  form("own_steady_ns", truth.own_steady);
  form("delivered_ns", truth.delivered);
}

void members(const auto& form, Any<PulseTruth> auto& pulse) {
  form("pulse", pulse.pulse);
  form("at_ns", pulse.at);
  form("error_ns", pulse.host_errors);
}

void members(const auto& form, Any<ClockAdjustment> auto& adjustment) {
  form("host", adjustment.host);
  form("at_steady_ns", adjustment.at);
  form("before_ns", adjustment.before);
  form("after_ns", adjustment.after);
  form("rate_ppb", adjustment.rate_ppb);
}

void members(const auto& form, Any<DevicePoll> auto& poll) {
  form("camera", poll.camera);
  form("device_us", poll.device.us);
  form("t0_ns", poll.t0);
  form("t1_ns", poll.t1);
  form("t0_steady_ns", poll.t0_steady);
  form("t1_steady_ns", poll.t1_steady);
}

void members(const auto& form, Any<ExchangeEvent> auto& event) {
  form("host", event.host);
  form("peer", event.exchange.peer);
  form("t1_ns", event.exchange.t1);
  form("t2_ns", event.exchange.t2);
  form("t3_ns", event.exchange.t3);
  form("t4_ns", event.exchange.t4);
  form.mark("estimated", event.exchange.is_estimated);
}

void members(const auto& form, Any<SyncOutcome> auto& outcome) {
  form("slave", outcome.slave);
  form("synchronised", outcome.synchronised);
  form("passes", outcome.passes);
  form("message", outcome.message);
}

void members(const auto& form, Any<AlignmentReport> auto& report) {
  form("camera", report.camera);
  form("aligned", report.aligned);
  form("controls", report.controls);
  form("message", report.message);
}

void members(const auto& form, Any<LedSighting> auto& sighting) {
  form("camera", sighting.camera);
  form("sensor_us", sighting.sensor.us);
  form("led_start_ns", sighting.led_start_ns);
  form("led_end_ns", sighting.led_end_ns);
}

void members(const auto& form, Any<SessionDelays> auto& delays) {
  form("slave", delays.slave);
  form("pass", delays.pass);
  form("begin_steady_ns", delays.begin);
  form("end_steady_ns", delays.end);
  form("t_l_ns", delays.t_l);
  form("t_t_ns", delays.t_t);
  form("t_d_ns", delays.t_d);
  form("get_ns", delays.get);
  form("set_ns", delays.set);
}

void members(const auto& form, Any<ProgramFailure> auto& failure) {
  form("host", failure.host);
  form("at_ns", failure.at);
  form.inner("program", failure.program);
  form.inner("how", failure.how);
  form.inner("last_words", failure.last_words);
  form("log", failure.log);
}

void members(const auto& form, Any<PulseSighting> auto& sighting) {
  form("host", sighting.host);
  form("seen_steady_ns", sighting.seen);
  form("gnss_ns", sighting.gnss);
}

constexpr std::array<std::string_view, 2> kStreams = {scenarios::to_text(StreamKind::kDepth),
                                                      scenarios::to_text(StreamKind::kColour)};
constexpr std::array<std::string_view, 3> kDomains = {"hardware_clock", "system_time",
                                                      "global_time"};
constexpr const auto& text_words(StreamKind) { return kStreams; }
constexpr const auto& text_words(StampDomain) { return kDomains; }

// The name of a value; its number if it has no name, which does not read back.
template <class Enum>
void append_name(std::string& line, Enum value) {
  const auto& names = text_words(value);
  const auto index = static_cast<std::size_t>(value);
  line += ',';
  if (index < names.size()) {
    line += names[index];
  } else {
    append_number(line, index);
  }
}

template <class Enum>
Enum read_name(FieldReader& fields, const char* name) {
  const auto& names = text_words(Enum{});
  const std::string_view found = fields.next(name);
  std::string allowed;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (found == names[i]) return static_cast<Enum>(i);
    if (i > 0) allowed += ", ";
    allowed += names[i];
  }
  fields.fail(name, allowed);
}

void append_list(std::string& line, const std::vector<Nanoseconds>& values) {
  line += ',';
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) line += ';';
    append_number(line, values[i].count());
  }
}

std::vector<Nanoseconds> read_list(FieldReader& fields, const char* name) {
  std::vector<Nanoseconds> values;
  std::string_view left = fields.next(name);
  while (!left.empty()) {
    const std::size_t end = left.find(';');
    std::int64_t value = 0;
    const bool ends_here = end == std::string_view::npos;
    if (!read_whole(left.substr(0, end), value) || end + 1 == left.size()) {
      fields.fail(name, "whole numbers with ';' between them");
    }
    values.emplace_back(value);
    left.remove_prefix(ends_here ? left.size() : end + 1);
  }
  return values;
}

bool read_flag(FieldReader& fields, const char* name) {
  const std::string_view flag = fields.next(name);
  if (flag != "true" && flag != "false") fields.fail(name, "true, false");
  return flag == "true";
}

// Appends members, each after a comma.
struct Writer {
  std::string& line;

  void operator()(const char* /*name*/, bool flag) const { line += flag ? ",true" : ",false"; }
  void operator()(const char* /*name*/, const std::string& text) const {
    line += ',';
    append_escaped(line, text);
  }
  void inner(const char* name, const std::string& text) const { (*this)(name, text); }
  void mark(const char* name, bool is_so) const {
    if (is_so) (line += ',') += name;
  }
  void operator()(const char* /*name*/, Nanoseconds interval) const {
    append_field(line, interval.count());
  }
  void operator()(const char* /*name*/, const std::vector<Nanoseconds>& values) const {
    append_list(line, values);
  }
  template <class Value>
  void operator()(const char* /*name*/, const Value& value) const {
    if constexpr (std::is_enum_v<Value>) {
      append_name(line, value);
    } else {
      append_field(line, value);
    }
  }
};

struct Reader {
  FieldReader& fields;

  void operator()(const char* name, bool& flag) const { flag = read_flag(fields, name); }
  void operator()(const char* name, double& value) const { value = fields.finite(name); }
  // The last member; inner(): others.
  void operator()(const char* name, std::string& text) const { text = fields.text(name); }
  void inner(const char* name, std::string& text) const { text = fields.inner_text(name); }
  // The last member, which is its own name where it is so, and else not there.
  void mark(const char* name, bool& is_so) const {
    is_so = !fields.at_end();
    if (is_so && fields.next(name) != name)
      fields.fail(name, fmt::format("\"{}\" or nothing", name));
  }
  void operator()(const char* name, Nanoseconds& interval) const {
    interval = Nanoseconds(fields.whole<std::int64_t>(name));
  }
  void operator()(const char* name, std::vector<Nanoseconds>& values) const {
    values = read_list(fields, name);
  }
  template <class Base>
  void operator()(const char* name, std::chrono::time_point<Base, Nanoseconds>& time) const {
    time =
        std::chrono::time_point<Base, Nanoseconds>(Nanoseconds(fields.whole<std::int64_t>(name)));
  }
  template <class Time>
  void operator()(const char* name, std::optional<Time>& time) const {
    const auto ns = fields.optional_whole<std::int64_t>(name);
    time = ns ? std::optional<Time>(Time(Nanoseconds(*ns))) : std::nullopt;
  }
  template <class Value>
  void operator()(const char* name, Value& value) const {
    if constexpr (std::is_enum_v<Value>) {
      value = read_name<Value>(fields, name);
    } else {
      value = fields.whole<Value>(name);
    }
  }
};

template <class Event>
Event read_members(FieldReader& fields) {
  Event event{};
  members(Reader{fields}, event);
  return event;
}

FrameEvent read_frame_event(FieldReader& fields) {
  FrameEvent frame{read_frame(fields), std::nullopt};
  if (!fields.at_end()) frame.truth = read_truth(fields);
  return frame;
}

template <std::size_t... Kinds>
bool read_other(std::string_view kind, FieldReader& fields, KeptEvent& event,
                std::index_sequence<Kinds...> /*all*/) {
  const auto read = [&](auto index) {
    event =
        RecordingEvent(read_members<std::variant_alternative_t<index(), RecordingEvent>>(fields));
    return true;
  };
  return ((kind == kKinds[Kinds] && read(std::integral_constant<std::size_t, Kinds>{})) || ...);
}

}  // namespace

std::string to_line(const KeptEvent& event) {
  std::string line;
  append_event(line, event);
  return line;
}

KeptEvent from_line(std::string_view line) {
  FieldReader fields(line);
  try {
    return read_event(fields);
  } catch (const TextFieldError& error) {
    throw EventTextError(error.what());
  }
}

void append_event(std::string& line, const KeptEvent& event) {
  if (const auto* frame = std::get_if<FrameEvent>(&event)) {
    line += kFrameKind;
    append_frame(line, frame->record);
    if (frame->truth) append_truth(line, *frame->truth);
  } else {
    append_event(line, std::get<RecordingEvent>(event));
  }
}

void append_event(std::string& line, const RecordingEvent& event) {
  line += kKinds[event.index()];
  std::visit([&](const auto& each) { members(Writer{line}, each); }, event);
}

KeptEvent read_event(FieldReader& fields) {
  const std::string_view kind = fields.next("kind");
  KeptEvent event;
  if (kind == kFrameKind) {
    event = read_frame_event(fields);
  } else if (!read_other(kind, fields, event, std::make_index_sequence<kKinds.size()>())) {
    std::string allowed(kFrameKind);
    for (const std::string_view each : kKinds) (allowed += ", ") += each;
    fields.fail("kind", allowed);
  }
  fields.end();
  return event;
}

void append_frame(std::string& line, const FrameRecord& record) { members(Writer{line}, record); }

void append_truth(std::string& line, const FrameTruth& truth) { members(Writer{line}, truth); }

FrameRecord read_frame(FieldReader& fields) { return read_members<FrameRecord>(fields); }

FrameTruth read_truth(FieldReader& fields) { return read_members<FrameTruth>(fields); }

}  // namespace simbench

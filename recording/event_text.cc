#include "recording/event_text.h"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace simbench {
namespace {

constexpr std::array<std::string_view, 2> kStreams = {scenarios::to_text(StreamKind::kDepth),
                                                      scenarios::to_text(StreamKind::kColour)};
constexpr std::array<std::string_view, 3> kDomains = {"hardware_clock", "system_time",
                                                      "global_time"};

// The name of a value; its number if it has no name, which does not read back.
template <std::size_t N, class Enum>
void append_name(std::string& line, const std::array<std::string_view, N>& names, Enum value) {
  const auto index = static_cast<std::size_t>(value);
  line += ',';
  if (index < N) {
    line += names[index];
  } else {
    append_number(line, index);
  }
}

template <class Enum, std::size_t N>
Enum read_name(FieldReader& fields, const char* name,
               const std::array<std::string_view, N>& names) {
  const std::string_view found = fields.next(name);
  std::string allowed;
  for (std::size_t i = 0; i < N; ++i) {
    if (found == names[i]) return static_cast<Enum>(i);
    if (i > 0) allowed += ", ";
    allowed += names[i];
  }
  fields.fail(name, allowed);
}

template <class Time>
Time read_time(FieldReader& fields, const char* name) {
  return Time(typename Time::duration(fields.whole<std::int64_t>(name)));
}

template <class... Values>
void append_fields(std::string& line, const Values&... values) {
  (append_field(line, values), ...);
}

std::optional<HostTime> read_optional(FieldReader& fields, const char* name) {
  const std::optional<std::int64_t> ns = fields.optional_whole<std::int64_t>(name);
  if (!ns) return std::nullopt;
  return HostTime(Nanoseconds(*ns));
}

void append_flag(std::string& line, bool flag) { line += flag ? ",true" : ",false"; }

bool read_flag(FieldReader& fields, const char* name) {
  const std::string_view flag = fields.next(name);
  if (flag != "true" && flag != "false") fields.fail(name, "true, false");
  return flag == "true";
}

struct Appender {
  std::string& line;

  void operator()(const FrameEvent& frame) const {
    line += "frame,";
    append_frame(line, frame.record);
    if (frame.truth) append_truth(line, *frame.truth);
  }
  void operator()(const PulseEvent& pulse) const {
    line += "pulse";
    append_fields(line, pulse.pulse, pulse.at);
    line += ',';
    for (std::size_t i = 0; i < pulse.host_errors.size(); ++i) {
      if (i > 0) line += ';';
      append_number(line, pulse.host_errors[i].count());
    }
  }
  void operator()(const ClockAdjustment& adjustment) const {
    line += "adjustment";
    append_fields(line, adjustment.host, adjustment.at, adjustment.before, adjustment.after,
                  adjustment.rate_ppb);
  }
  void operator()(const DevicePoll& poll) const {
    line += "poll";
    append_fields(line, poll.camera, poll.device.us, poll.t0, poll.t1, poll.t0_steady,
                  poll.t1_steady);
  }
  void operator()(const ExchangeEvent& event) const {
    const Exchange& exchange = event.exchange;
    line += "exchange";
    append_fields(line, event.host, exchange.peer, exchange.t1, exchange.t2, exchange.t3,
                  exchange.t4);
  }
  void operator()(const SyncOutcome& outcome) const {
    line += "outcome";
    append_field(line, outcome.slave);
    append_flag(line, outcome.synchronised);
    append_field(line, outcome.passes);
    line += ',';
    append_escaped(line, outcome.message);
  }
  void operator()(const AlignmentReport& report) const {
    line += "alignment";
    append_field(line, report.camera);
    append_flag(line, report.aligned);
    append_field(line, report.controls);
    line += ',';
    append_escaped(line, report.message);
  }
  void operator()(const LedSighting& sighting) const {
    line += "led";
    append_fields(line, sighting.camera, sighting.sensor.us, sighting.led_start_ns,
                  sighting.led_end_ns);
  }
};

FrameEvent read_frame_event(FieldReader& fields) {
  FrameEvent frame{read_frame(fields), std::nullopt};
  if (!fields.at_end()) frame.truth = read_truth(fields);
  return frame;
}

PulseEvent read_pulse(FieldReader& fields) {
  constexpr const char* kErrors = "error_ns";
  PulseEvent event;
  event.pulse = fields.whole<std::int64_t>("pulse");
  event.at = read_time<TrueTime>(fields, "at_ns");
  std::string_view errors = fields.next(kErrors);
  while (!errors.empty()) {
    const std::size_t end = errors.find(';');
    std::int64_t error = 0;
    const bool ends_here = end == std::string_view::npos;
    if (!read_whole(errors.substr(0, end), error) || end + 1 == errors.size()) {
      fields.fail(kErrors, "whole numbers with ';' between them");
    }
    event.host_errors.emplace_back(error);
    errors.remove_prefix(ends_here ? errors.size() : end + 1);
  }
  return event;
}

// The members of a braced list are read in their order.
ClockAdjustment read_adjustment(FieldReader& fields) {
  return {.host = fields.whole<std::uint32_t>("host"),
          .at = read_time<SteadyTime>(fields, "at_steady_ns"),
          .before = read_time<HostTime>(fields, "before_ns"),
          .after = read_time<HostTime>(fields, "after_ns"),
          .rate_ppb = fields.finite("rate_ppb")};
}

DevicePoll read_poll(FieldReader& fields) {
  return {.camera = fields.whole<std::uint32_t>("camera"),
          .device = {fields.whole<std::uint32_t>("device_us")},
          .t0 = read_time<HostTime>(fields, "t0_ns"),
          .t1 = read_time<HostTime>(fields, "t1_ns"),
          .t0_steady = read_time<SteadyTime>(fields, "t0_steady_ns"),
          .t1_steady = read_time<SteadyTime>(fields, "t1_steady_ns")};
}

ExchangeEvent read_exchange(FieldReader& fields) {
  return {.host = fields.whole<std::uint32_t>("host"),
          .exchange = {.peer = fields.whole<PeerId>("peer"),
                       .t1 = read_optional(fields, "t1_ns"),
                       .t2 = read_optional(fields, "t2_ns"),
                       .t3 = read_optional(fields, "t3_ns"),
                       .t4 = read_optional(fields, "t4_ns")}};
}

SyncOutcome read_outcome(FieldReader& fields) {
  SyncOutcome outcome;
  outcome.slave = fields.whole<PeerId>("slave");
  outcome.synchronised = read_flag(fields, "synchronised");
  outcome.passes = fields.whole<std::uint32_t>("passes");
  outcome.message = fields.text("message");
  return outcome;
}

AlignmentReport read_alignment(FieldReader& fields) {
  return {.camera = fields.whole<std::uint32_t>("camera"),
          .aligned = read_flag(fields, "aligned"),
          .controls = fields.whole<std::uint32_t>("controls"),
          .message = fields.text("message")};
}

LedSighting read_led_sighting(FieldReader& fields) {
  return {.camera = fields.whole<std::uint32_t>("camera"),
          .sensor = {fields.whole<std::uint32_t>("sensor_us")},
          .led_start_ns = fields.whole<std::int64_t>("led_start_ns"),
          .led_end_ns = fields.whole<std::int64_t>("led_end_ns")};
}

RecordingEvent read_members(std::string_view kind, FieldReader& fields) {
  if (kind == "frame") return read_frame_event(fields);
  if (kind == "pulse") return read_pulse(fields);
  if (kind == "adjustment") return read_adjustment(fields);
  if (kind == "poll") return read_poll(fields);
  if (kind == "exchange") return read_exchange(fields);
  if (kind == "outcome") return read_outcome(fields);
  if (kind == "alignment") return read_alignment(fields);
  if (kind == "led") return read_led_sighting(fields);
  fields.fail("kind", "frame, pulse, adjustment, poll, exchange, outcome, alignment, led");
}

}  // namespace

std::string to_line(const RecordingEvent& event) {
  std::string line;
  append_event(line, event);
  return line;
}

RecordingEvent from_line(std::string_view line) {
  FieldReader fields(line);
  try {
    return read_event(fields);
  } catch (const TextFieldError& error) {
    throw EventTextError(error.what());
  }
}

void append_event(std::string& line, const RecordingEvent& event) {
  std::visit(Appender{line}, event);
}

RecordingEvent read_event(FieldReader& fields) {
  RecordingEvent event = read_members(fields.next("kind"), fields);
  fields.end();
  return event;
}

void append_frame(std::string& line, const FrameRecord& record) {
  append_number(line, record.camera);
  append_name(line, kStreams, record.stream);
  append_name(line, kDomains, record.domain);
  append_fields(line, record.counter, record.exposure_us, record.sensor.us, record.frame.us,
                record.backend, record.arrival, record.arrival_steady);
}

void append_truth(std::string& line, const FrameTruth& truth) {
  append_fields(line, truth.pulse, truth.exposure_start, truth.exposure_end, truth.reference,
                truth.own_host, truth.own_steady, truth.delivered);
}

FrameRecord read_frame(FieldReader& fields) {
  return {.camera = fields.whole<std::uint32_t>("camera"),
          .stream = read_name<StreamKind>(fields, "stream", kStreams),
          .domain = read_name<StampDomain>(fields, "domain", kDomains),
          .counter = fields.whole<std::uint32_t>("counter"),
          .exposure_us = fields.whole<std::uint32_t>("exposure_us"),
          .sensor = {fields.whole<std::uint32_t>("sensor_us")},
          .frame = {fields.whole<std::uint32_t>("frame_us")},
          .backend = read_time<HostTime>(fields, "backend_ns"),
          .arrival = read_time<HostTime>(fields, "arrival_ns"),
          .arrival_steady = read_time<SteadyTime>(fields, "arrival_steady_ns")};
}

FrameTruth read_truth(FieldReader& fields) {
  return {.pulse = fields.whole<std::int64_t>("pulse"),
          .exposure_start = read_time<TrueTime>(fields, "exposure_start_ns"),
          .exposure_end = read_time<TrueTime>(fields, "exposure_end_ns"),
          .reference = read_time<HostTime>(fields, "reference_ns"),
          .own_host = read_time<HostTime>(fields, "own_host_ns"),
          .own_steady = read_time<SteadyTime>(fields, "own_steady_ns"),
          .delivered = read_time<HostTime>(fields, "delivered_ns")};
}

}  // namespace simbench

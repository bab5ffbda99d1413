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

// The name of a value; its number if it has none, which does not read back.
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

template <class Base, class Duration>
void append_field(std::string& line, std::chrono::time_point<Base, Duration> time) {
  simbench::append_field(line, time.time_since_epoch().count());
}
using simbench::append_field;

template <class Time>
Time read_time(FieldReader& fields, const char* name) {
  return Time(typename Time::duration(fields.whole<std::int64_t>(name)));
}

void append_optional(std::string& line, const std::optional<HostTime>& time) {
  if (time) {
    append_field(line, *time);
  } else {
    line += ',';
  }
}

std::optional<HostTime> read_optional(FieldReader& fields, const char* name) {
  const std::optional<std::int64_t> ns = fields.optional_whole<std::int64_t>(name);
  if (!ns) return std::nullopt;
  return HostTime(Nanoseconds(*ns));
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
    append_field(line, pulse.pulse);
    append_field(line, pulse.at);
    line += ',';
    for (std::size_t i = 0; i < pulse.host_errors.size(); ++i) {
      if (i > 0) line += ';';
      append_number(line, pulse.host_errors[i].count());
    }
  }
  void operator()(const ClockAdjustment& adjustment) const {
    line += "adjustment";
    append_field(line, adjustment.host);
    append_field(line, adjustment.at);
    append_field(line, adjustment.before);
    append_field(line, adjustment.after);
    append_field(line, adjustment.rate_ppb);
  }
  void operator()(const DevicePoll& poll) const {
    line += "poll";
    append_field(line, poll.camera);
    append_field(line, poll.device.us);
    append_field(line, poll.t0);
    append_field(line, poll.t1);
    append_field(line, poll.t0_steady);
    append_field(line, poll.t1_steady);
  }
  void operator()(const ExchangeEvent& event) const {
    line += "exchange";
    append_field(line, event.host);
    append_field(line, event.exchange.peer);
    append_optional(line, event.exchange.t1);
    append_optional(line, event.exchange.t2);
    append_optional(line, event.exchange.t3);
    append_optional(line, event.exchange.t4);
  }
  void operator()(const SyncOutcome& outcome) const {
    line += "outcome";
    append_field(line, outcome.slave);
    line += outcome.synchronised ? ",true" : ",false";
    append_field(line, outcome.passes);
    line += ',';
    append_escaped(line, outcome.message);
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

ClockAdjustment read_adjustment(FieldReader& fields) {
  ClockAdjustment adjustment;
  adjustment.host = fields.whole<std::uint32_t>("host");
  adjustment.at = read_time<SteadyTime>(fields, "at_steady_ns");
  adjustment.before = read_time<HostTime>(fields, "before_ns");
  adjustment.after = read_time<HostTime>(fields, "after_ns");
  adjustment.rate_ppb = fields.finite("rate_ppb");
  return adjustment;
}

DevicePoll read_poll(FieldReader& fields) {
  DevicePoll poll;
  poll.camera = fields.whole<std::uint32_t>("camera");
  poll.device.us = fields.whole<std::uint32_t>("device_us");
  poll.t0 = read_time<HostTime>(fields, "t0_ns");
  poll.t1 = read_time<HostTime>(fields, "t1_ns");
  poll.t0_steady = read_time<SteadyTime>(fields, "t0_steady_ns");
  poll.t1_steady = read_time<SteadyTime>(fields, "t1_steady_ns");
  return poll;
}

ExchangeEvent read_exchange(FieldReader& fields) {
  ExchangeEvent event;
  event.host = fields.whole<std::uint32_t>("host");
  event.exchange.peer = fields.whole<PeerId>("peer");
  event.exchange.t1 = read_optional(fields, "t1_ns");
  event.exchange.t2 = read_optional(fields, "t2_ns");
  event.exchange.t3 = read_optional(fields, "t3_ns");
  event.exchange.t4 = read_optional(fields, "t4_ns");
  return event;
}

SyncOutcome read_outcome(FieldReader& fields) {
  SyncOutcome outcome;
  outcome.slave = fields.whole<PeerId>("slave");
  const std::string_view synchronised = fields.next("synchronised");
  outcome.synchronised = synchronised == "true";
  if (!outcome.synchronised && synchronised != "false") {
    fields.fail("synchronised", "true, false");
  }
  outcome.passes = fields.whole<std::uint32_t>("passes");
  outcome.message = fields.text("message");
  return outcome;
}

RecordingEvent read_members(std::string_view kind, FieldReader& fields) {
  if (kind == "frame") return read_frame_event(fields);
  if (kind == "pulse") return read_pulse(fields);
  if (kind == "adjustment") return read_adjustment(fields);
  if (kind == "poll") return read_poll(fields);
  if (kind == "exchange") return read_exchange(fields);
  if (kind == "outcome") return read_outcome(fields);
  fields.fail("kind", "frame, pulse, adjustment, poll, exchange, outcome");
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
  append_field(line, record.counter);
  append_field(line, record.exposure_us);
  append_field(line, record.sensor.us);
  append_field(line, record.frame.us);
  append_field(line, record.backend);
  append_field(line, record.arrival);
  append_field(line, record.arrival_steady);
}

void append_truth(std::string& line, const FrameTruth& truth) {
  append_field(line, truth.pulse);
  append_field(line, truth.exposure_start);
  append_field(line, truth.exposure_end);
  append_field(line, truth.reference);
  append_field(line, truth.own_host);
  append_field(line, truth.own_steady);
  append_field(line, truth.delivered);
}

FrameRecord read_frame(FieldReader& fields) {
  FrameRecord record;
  record.camera = fields.whole<std::uint32_t>("camera");
  record.stream = read_name<StreamKind>(fields, "stream", kStreams);
  record.domain = read_name<StampDomain>(fields, "domain", kDomains);
  record.counter = fields.whole<std::uint32_t>("counter");
  record.exposure_us = fields.whole<std::uint32_t>("exposure_us");
  record.sensor.us = fields.whole<std::uint32_t>("sensor_us");
  record.frame.us = fields.whole<std::uint32_t>("frame_us");
  record.backend = read_time<HostTime>(fields, "backend_ns");
  record.arrival = read_time<HostTime>(fields, "arrival_ns");
  record.arrival_steady = read_time<SteadyTime>(fields, "arrival_steady_ns");
  return record;
}

FrameTruth read_truth(FieldReader& fields) {
  FrameTruth truth;
  truth.pulse = fields.whole<std::int64_t>("pulse");
  truth.exposure_start = read_time<TrueTime>(fields, "exposure_start_ns");
  truth.exposure_end = read_time<TrueTime>(fields, "exposure_end_ns");
  truth.reference = read_time<HostTime>(fields, "reference_ns");
  truth.own_host = read_time<HostTime>(fields, "own_host_ns");
  truth.own_steady = read_time<SteadyTime>(fields, "own_steady_ns");
  truth.delivered = read_time<HostTime>(fields, "delivered_ns");
  return truth;
}

}  // namespace simbench

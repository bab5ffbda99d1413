// The events of one simulated run for a timeline: pulses, the way of every frame, messages,
// sessions of Algorithms 1 and 2, clocks and gathered sets, in order of true time.
//
// TraceRecorder (trace_recorder.h) makes a trace; write_chrome_trace() and write_trace_csv() write
// it. Its size is bounded: it omits things that begin outside the window, and those that begin
// after the instant at which the number of events would exceed the limit. `left_out` counts both. A
// thing is complete or absent.
//
// Units: true time (recording/true_time.h), nanoseconds.
#pragma once

#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "algorithms/ports/exchange.h"
#include "algorithms/ports/time.h"
#include "evaluation/certificates/assumptions.h"
#include "recording/recording.h"
#include "recording/world_observer.h"
#include "scenarios/derivation.h"

namespace simbench::reports {

struct TraceOptions {
  // Things that begin in [from, to) are kept; a set belongs to its first frame.
  TrueTime from = TrueTime::min();
  TrueTime to = TrueTime::max();
  std::uint64_t max_events = 200'000;
  std::optional<evaluation::Assumptions> certify{};  // empty: sets have no certificates
};

struct TraceFrame {
  ObservedFrame way;
  DeviceStamp sensor{};             // delivered frames only
  std::optional<GlobalTime> stamp;  // by device_time
  HostTime reference{};             // the correct stamp
  std::optional<std::uint32_t> set;
  bool leads_set = false;  // it is the set's first
};

struct TraceSet {
  std::vector<std::uint32_t> frames;  // the kept ones
  std::size_t members = 0;
  bool complete = false;
  Nanoseconds range{};                   // of the members' stamps
  std::optional<double> certified_ms{};  // no two members are further apart; empty: unknown
  TrueTime begin{};                      // its first frame is delivered
  TrueTime end{};  // it is emitted, at least 1 ns after the last one is delivered
};

// A host's system clock minus the master's.
struct TraceClock {
  TrueTime at{};
  std::uint32_t host = 0;
  Nanoseconds error{};
};

struct TraceAdjustment {
  // From the host's steady clock, between two instants at which both are known: accurate to
  // microseconds, for a host without cameras to its drift since the world's start.
  TrueTime at{};
  std::uint32_t host = 0;
  SteadyTime at_steady{};
  Nanoseconds step{};
  double rate_ppb = 0;
};

// A session of Algorithms 1 and 2 at its slave: from the first READY of a pass that it finished
// until it has set its clock for the last time. Its times are as accurate as an adjustment's.
struct TraceSession {
  TrueTime at{};
  TrueTime end{};
  SteadyTime begin_steady{};
  SessionDelays last;  // of its last pass
};

// Numbers of events.
struct TraceLeftOut {
  std::uint64_t outside = 0;   // of the window
  std::uint64_t too_many = 0;  // beyond the limit
  TrueTime cut_at = TrueTime::max();
};

struct Trace {
  std::string scenario;
  scenarios::Derivation derivation{};  // of that scenario
  std::string pipeline;
  std::uint64_t seed = 0;
  std::uint32_t hosts = 0;
  std::vector<CameraLayout> cameras;
  TrueTime world_start{};
  std::optional<TrueTime> capture_start;

  // Each in order of time; frames by the begin of their exposure.
  std::vector<ObservedPulse> pulses;
  std::vector<TraceFrame> frames;
  std::vector<ObservedMessage> messages;
  std::vector<TraceClock> clocks;
  std::vector<TraceAdjustment> adjustments;
  std::vector<TraceSession> sessions;
  std::vector<TraceSet> sets;

  // Real programs that ended too early: what clocks do from then on is not their work.
  std::vector<ProgramFailure> program_failures{};

  TraceOptions options;
  TraceLeftOut left_out;
};

// The begin of a thing, and the largest number of its events.
inline TrueTime begin_of(const ObservedPulse& pulse) { return pulse.at; }
inline TrueTime begin_of(const TraceFrame& frame) { return frame.way.exposure_start; }
inline TrueTime begin_of(const ObservedMessage& message) { return message.left; }
inline TrueTime begin_of(const TraceClock& clock) { return clock.at; }
inline TrueTime begin_of(const TraceAdjustment& adjustment) { return adjustment.at; }
inline TrueTime begin_of(const TraceSession& session) { return session.at; }

inline std::uint64_t events_of(const ObservedPulse&) { return 1; }
inline std::uint64_t events_of(const TraceFrame& frame) {
  if (frame.way.fate != FrameFate::kDelivered) return 4;  // exposure, loss, and an arrow's ends
  return frame.leads_set ? 8 : 7;  // exposure, transfer, stack, an arrow with four points; set
}
inline std::uint64_t events_of(const ObservedMessage&) { return 4; }
inline std::uint64_t events_of(const TraceClock&) { return 1; }
inline std::uint64_t events_of(const TraceAdjustment&) { return 1; }
inline std::uint64_t events_of(const TraceSession&) { return 1; }

// Returns a sentence for each reason why something was left out.
std::vector<std::string> left_out_notes(const Trace& trace);

// A trace in the Chrome trace event format (JSON object format), which the Perfetto UI
// (ui.perfetto.dev) and chrome://tracing open.
//
// `ts` and `dur` are microseconds with three decimals, in true time from true zero, the start of
// host synchronisation, or from the first event before that. otherData has that zero, the run and
// the omissions. One line per event, in order of time, names first. The same trace gives the same
// bytes. Cost: memory for the events, the text is streamed.
// Source: "Trace Event Format", the Chromium project.
void write_chrome_trace(const Trace& trace, std::ostream& out);

inline constexpr std::uint32_t kTraceCsvPlaces = 100;

// A trace as a table of series over time, which PlotJuggler opens: one strictly increasing column
// `time_s`, seconds of true time, and a cell only where a series has a value.
//
//   trigger/pulse                number of the pulse
//   hostN/clock_error_us         system clock minus the master's, its TE (N > 0)
//   hostN/clock_step_us          step of the clock
//   cameraN/latency_ms           middle of the exposure to delivery, at the delivery
//                                (cameraN/colour/latency_ms: of the colour stream)
//   cameraN/stamp_error_us       the pipeline's stamp minus the correct one, at the delivery
//   gathering/stamps_range_us    of the set emitted then
//   gathering/frames             in that set
//   gathering/certified_ms       how far its frames were exposed apart at most, for sure
//
// Two values of a series at one instant: the later is shown. Columns are those of the first
// kTraceCsvPlaces hosts and cameras; the rest is left out.
void write_trace_csv(const Trace& trace, std::ostream& out);

// A sentence if columns are left out, besides left_out_notes().
std::vector<std::string> trace_csv_notes(const Trace& trace);

}  // namespace simbench::reports

// A trace as a table of series over time, which PlotJuggler opens: one strictly increasing column
// `time_s`, seconds of true time, and a cell only where a series has a value.
//
//   trigger/pulse                number of the pulse
//   hostN/clock_error_us         system clock minus the master's (N > 0)
//   hostN/clock_step_us          what was set at once
//   cameraN/latency_ms           middle of the exposure to delivery, at the delivery
//                                (cameraN/colour/latency_ms: of the colour stream)
//   cameraN/stamp_error_us       the pipeline's stamp minus what it should be, at the delivery
//   gathering/stamps_range_us    of the set emitted then
//   gathering/frames             in that set
//
// Of two values of a series at one instant the later is shown. Columns are those of the first
// kTraceCsvPlaces hosts and cameras; the rest is left out.
//
//   write_trace_csv(trace, std::cout);
#ifndef SIMBENCH_REPORTS_TIMELINE_TRACE_CSV_H_
#define SIMBENCH_REPORTS_TIMELINE_TRACE_CSV_H_

#include <ostream>
#include <string>
#include <vector>

#include "reports/timeline/trace.h"

namespace simbench::reports {

inline constexpr std::uint32_t kTraceCsvPlaces = 100;

void write_trace_csv(const Trace& trace, std::ostream& out);

// A sentence if columns are left out, besides left_out_notes().
std::vector<std::string> trace_csv_notes(const Trace& trace);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TIMELINE_TRACE_CSV_H_

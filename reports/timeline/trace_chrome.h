// A trace in the Chrome trace event format (JSON object format), which the Perfetto UI
// (ui.perfetto.dev) and chrome://tracing open.
//
// `ts` and `dur` are microseconds with three decimals, in true time from true zero, the start of
// host synchronisation; if something begins before that, from its begin. otherData says which, what
// was run, and what was left out. One line per event, in order of time, names first.
// The same trace gives the same bytes. Cost: memory for the events, the text is streamed.
// Source: "Trace Event Format", the Chromium project.
//
//   write_chrome_trace(trace, std::cout);
#ifndef SIMBENCH_REPORTS_TIMELINE_TRACE_CHROME_H_
#define SIMBENCH_REPORTS_TIMELINE_TRACE_CHROME_H_

#include <ostream>

#include "reports/timeline/trace.h"

namespace simbench::reports {

void write_chrome_trace(const Trace& trace, std::ostream& out);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TIMELINE_TRACE_CHROME_H_

// A snapshot of a monitor as OpenMetrics, for Prometheus.
//
//   simbench_alarms{kind="slipped"} 1
//   simbench_camera_phase_seconds{camera="front",host="a",stream="Depth 0"} 0.0012
//
// Values that do not exist are left out. Source: OpenMetrics 1.0.0 (RFC-style draft of the CNCF).
//
//   const std::string text = open_metrics(monitor.snapshot());
#pragma once

#include <string>

#include "reports/text/json_node.h"

namespace simbench::watch {

inline constexpr const char* kOpenMetricsType =
    "application/openmetrics-text; version=1.0.0; charset=utf-8";

std::string open_metrics(const reports::Json& snapshot);

}  // namespace simbench::watch

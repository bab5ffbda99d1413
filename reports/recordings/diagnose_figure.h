// A diagnosis as a picture: how the phase of each camera's arrivals moves.
//
// For each kind of stream two panels. The first has for each camera its arrivals less the common
// frame period, from 0 on, as medians of short stretches: a camera on the trigger stays level, one
// that runs free leaves along a straight line. The second has the jitter of the single arrivals
// about that, the drift taken out: from 5 to 95 %. Cameras at no whole fraction of the common rate
// have no place in it.
//
//   const Figure figure = diagnose_figure(diagnosis);
#pragma once

#include "evaluation/diagnosis/diagnose.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

// Figure "phases" of the catalogue.
Figure diagnose_figure(const evaluation::Diagnosis& diagnosis);

// The phase of each frame of one camera, in order of time; empty where it has no place.
// `period_ms`: of its group (GroupVerdict).
FigureSeries phase_series(const evaluation::CameraDiagnosis& camera, double period_ms);
// The medians of its stretches, at most 80.
FigureSeries block_medians(const FigureSeries& curve);

}  // namespace simbench::reports

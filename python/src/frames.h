// Every frame of a run as rows: stamps, truth, errors.
#ifndef SIMBENCH_PYTHON_SRC_FRAMES_H_
#define SIMBENCH_PYTHON_SRC_FRAMES_H_

#include "evaluation/run/run_detail.h"
#include "python/src/rows.h"

namespace simbench::python {

// Takes the frames of the detail, camera by camera: at no time is all of it there twice.
Rows frame_rows(evaluation::RunDetail detail);

}  // namespace simbench::python

#endif  // SIMBENCH_PYTHON_SRC_FRAMES_H_

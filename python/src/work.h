// Long work for a caller in Python: without the interpreter's lock, with progress, until Ctrl-C.
//
// The work runs on a thread of its own. The calling thread waits without the lock; 20 times a
// second it takes it, lets Python handle its signals and reports progress. What a handler or the
// report raises (KeyboardInterrupt) interrupts the work (app/interrupt.h) and is thrown at its end.
//
//   const evaluation::Results results = watched<evaluation::Results>(
//       on_progress, [&](const evaluation::Progress& progress) {
//         return evaluation::evaluate(scenario, make_source, options, progress);
//       });
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "evaluation/run/evaluate.h"
#include "python/src/object.h"

namespace simbench::python {

// `on_progress`: called with (done, total), or None. Throws what the work throws.
void run_watched(const Object& on_progress,
                 const std::function<void(const evaluation::Progress&)>& work);

template <class Result, class Work>
Result watched(const Object& on_progress, const Work& work) {
  std::optional<Result> result;
  run_watched(on_progress,
              [&](const evaluation::Progress& progress) { result.emplace(work(progress)); });
  return std::move(*result);
}

}  // namespace simbench::python

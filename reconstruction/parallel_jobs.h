// Independent jobs, numbered from 0, on several threads of this process.
//
//   run_jobs(rows * seeds, /*threads=*/0, cancel, [&](std::size_t job) { results[job] = ...; });
#ifndef SIMBENCH_RECONSTRUCTION_PARALLEL_JOBS_H_
#define SIMBENCH_RECONSTRUCTION_PARALLEL_JOBS_H_

#include <atomic>
#include <cstddef>
#include <functional>

namespace simbench::reconstruction {

// Begins jobs in order; `threads` 0: as many as there are cores. Once `cancel` (may be null) is
// true no more are begun. If a job throws, no more are begun, those that run come to their end, and
// the exception of the first job that threw passes through. Returns whether all jobs were done.
bool run_jobs(std::size_t count, unsigned threads, const std::atomic<bool>* cancel,
              const std::function<void(std::size_t)>& job);

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_RECONSTRUCTION_PARALLEL_JOBS_H_

#include "python/src/work.h"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>

#include "app/interrupt.h"

namespace simbench::python {
namespace {

constexpr auto kPollInterval = std::chrono::milliseconds(50);

// How many works run, on as many threads of Python. The first clears an earlier interruption; an
// interruption ends all. Guarded by the interpreter's lock.
int running_works = 0;

class RunningWork {
 public:
  RunningWork() {
    if (running_works++ == 0) app::InterruptHandler::set(false);
  }
  ~RunningWork() { --running_works; }
  RunningWork(const RunningWork&) = delete;
  RunningWork& operator=(const RunningWork&) = delete;
};

// What the working and the waiting thread share.
struct WorkState {
  std::mutex mutex;  // guards what follows
  std::condition_variable ended_or_due;
  std::uint64_t done = 0;
  std::uint64_t total = 0;
  bool ended = false;
  std::exception_ptr error{};
};

void do_work(WorkState& state, const std::function<void(const evaluation::Progress&)>& work) {
  std::exception_ptr error;
  try {
    work([&state](std::uint64_t done, std::uint64_t total) {
      const std::lock_guard lock(state.mutex);
      state.done = done;
      state.total = total;
    });
  } catch (...) {
    error = std::current_exception();
  }
  const std::lock_guard lock(state.mutex);
  state.ended = true;
  state.error = std::move(error);
  state.ended_or_due.notify_one();
}

// Returns what Python raised.
std::exception_ptr look_after(const Object& on_progress, std::uint64_t done, std::uint64_t total) {
  try {
    if (PyErr_CheckSignals() != 0) throw PythonError::raised();
    if (total > 0 && !on_progress.is_none()) on_progress(done, total);
  } catch (...) {
    return std::current_exception();
  }
  return nullptr;
}

// Until the work has ended. Returns what Python raised first.
std::exception_ptr wait_for(WorkState& state, const Object& on_progress) {
  std::exception_ptr raised;
  const WithoutGil without_lock;
  std::unique_lock lock(state.mutex);
  while (!state.ended) {
    state.ended_or_due.wait_for(lock, kPollInterval);
    if (state.ended) break;
    const std::uint64_t done = state.done;
    const std::uint64_t total = state.total;
    lock.unlock();
    if (!raised) {
      const WithGil with_lock;
      raised = look_after(on_progress, done, total);
      if (raised) app::InterruptHandler::set(true);
    }
    lock.lock();
  }
  return raised;
}

}  // namespace

void run_watched(const Object& on_progress,
                 const std::function<void(const evaluation::Progress&)>& work) {
  const RunningWork running;
  WorkState state;
  std::thread worker(do_work, std::ref(state), std::cref(work));
  const std::exception_ptr raised = wait_for(state, on_progress);
  {
    const WithoutGil without_lock;
    worker.join();
  }
  if (raised) std::rethrow_exception(raised);
  if (state.error) std::rethrow_exception(state.error);
  if (!on_progress.is_none() && state.total > 0) on_progress(state.done, state.total);
}

}  // namespace simbench::python

// Threads: each has a link of its own and begins when its turn comes. Those that libc makes for
// itself (timers with SIGEV_THREAD, aio_read(), getaddrinfo_a()) have none, and end the program.
#include <errno.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <threads.h>
#include <unistd.h>

#include "shim/begin.h"
#include "shim/link.h"

namespace simbench::shim {
namespace {

// What a thread is to do. There are as many as may begin at once: one, since its maker waits until
// it has read this.
struct Start {
  Newcomer newcomer{};
  void* (*routine)(void*) = nullptr;
  void* argument = nullptr;
};
Start next_start;

pthread_key_t end_key;
bool has_end_key = false;
__thread int end_rounds __attribute__((tls_model("initial-exec"))) = 0;

// libc calls it with the other destructors of the thread's values, in any order, and again as long
// as a value is set: the last time is after those of the program.
void near_end(void* value) {
  if (++end_rounds < PTHREAD_DESTRUCTOR_ITERATIONS) {
    pthread_setspecific(end_key, value);
  } else {
    end_thread();
  }
}

void* run_thread(void* /*nothing*/) {
  const Start start = next_start;
  begin_thread(start.newcomer);
  watch_thread();
  return start.routine(start.argument);
}

}  // namespace

void watch_thread() {
  if (!has_end_key) has_end_key = pthread_key_create(&end_key, near_end) == 0;
  end_rounds = 0;
  if (has_end_key) pthread_setspecific(end_key, &end_key);
}

SIMBENCH_CALL int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                                 void* (*routine)(void*), void* argument) {
  if (!is_simulated()) {
    return SIMBENCH_REAL(pthread_create)(thread, attributes, routine, argument);
  }
  const int before = errno;
  Start start{.routine = routine, .argument = argument};
  if (!announce(Call::kNewThread, start.newcomer)) {
    const int error = errno;
    errno = before;
    return error;
  }
  next_start = start;
  const int error = SIMBENCH_REAL(pthread_create)(thread, attributes, run_thread, nullptr);
  tell_started(start.newcomer, true, error == 0 ? 1 : 0);
  errno = before;
  return error;
}

namespace {

// thrd_create()'s, by way of pthread_create().
struct OldStart {
  thrd_start_t routine;
  void* argument;
};

void* run_old(void* given) {
  const OldStart start = *static_cast<OldStart*>(given);
  munmap(given, sizeof(OldStart));
  return at<void>(start.routine(start.argument));
}

}  // namespace

SIMBENCH_CALL int thrd_create(thrd_t* thread, thrd_start_t routine, void* argument) {
  if (!is_simulated()) return SIMBENCH_REAL(thrd_create)(thread, routine, argument);
  void* start =
      mmap(nullptr, sizeof(OldStart), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (start == MAP_FAILED) return thrd_nomem;
  *static_cast<OldStart*>(start) = {routine, argument};
  switch (pthread_create(thread, nullptr, run_old, start)) {
    case 0:
      return thrd_success;
    case ENOMEM:
      return thrd_nomem;
    default:
      munmap(start, sizeof(OldStart));
      return thrd_error;
  }
}

SIMBENCH_CALL pid_t gettid() {
  return is_simulated() ? own_thread() : static_cast<pid_t>(machine_call(SYS_gettid));
}

namespace {

// A thread of this process that waits looks at the signal that it has.
void wake_threads() { ask({.call = Call::kLookAtSignals, .a = identity().process}); }

}  // namespace

SIMBENCH_CALL int pthread_kill(pthread_t thread, int signal) {
  const int error = SIMBENCH_REAL(pthread_kill)(thread, signal);
  if (error == 0 && signal != 0 && is_simulated()) wake_threads();
  return error;
}

SIMBENCH_CALL int pthread_cancel(pthread_t thread) {
  const int error = SIMBENCH_REAL(pthread_cancel)(thread);
  if (error == 0 && is_simulated()) wake_threads();
  return error;
}

}  // namespace simbench::shim

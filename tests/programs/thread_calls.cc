// What man pages promise of threads, locks and what waits for them, in the world's time.
//
//   thread_calls check | thread_calls bomb | thread_calls compute | thread_calls order
#include <errno.h>
#include <linux/futex.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <threads.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <future>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/programs/promises.h"

namespace {

using namespace promises;
using namespace std::chrono_literals;

// How long it takes by the world's oscillator.
template <class Work>
std::int64_t took(Work work) {
  const std::int64_t begin = steady();
  work();
  return steady() - begin;
}

void check_conditions() {
  std::mutex mutex;
  std::condition_variable condition;
  std::unique_lock lock(mutex);
  std::int64_t ns = took([&] {
    expect(condition.wait_for(lock, 250ms) == std::cv_status::timeout, "wait_for: time is up");
  });
  expect(is_about(ns, 250 * kMillisecond), "wait_for waits so long");
  ns = took([&] { condition.wait_until(lock, std::chrono::system_clock::now() + 40ms); });
  expect(is_about(ns, 40 * kMillisecond), "wait_until, by the system clock");
  bool is_set = false;
  std::thread other([&] {
    usleep(70'000);
    const std::lock_guard own(mutex);
    is_set = true;
    condition.notify_one();
  });
  ns = took([&] { condition.wait(lock, [&] { return is_set; }); });
  expect(is_about(ns, 70 * kMillisecond), "who notifies ends the wait");
  lock.unlock();
  other.join();
}

void check_locks() {
  std::timed_mutex mutex;
  mutex.lock();
  std::thread other([&] {
    const std::int64_t ns = took([&] { expect(!mutex.try_lock_for(30ms), "it is taken"); });
    expect(is_about(ns, 30 * kMillisecond), "try_lock_for waits so long");
    const std::int64_t more = took([&] { mutex.lock(); });
    expect(is_about(more, 20 * kMillisecond), "lock waits until it is free");
    mutex.unlock();
  });
  usleep(50'000);
  mutex.unlock();
  other.join();
  std::shared_mutex shared;
  shared.lock_shared();
  std::thread writer([&] {
    const std::int64_t ns = took([&] { shared.lock(); });
    expect(is_about(ns, 10 * kMillisecond), "a writer waits for readers");
    shared.unlock();
  });
  usleep(10'000);
  shared.unlock_shared();
  writer.join();
  pthread_mutexattr_t inherits{};
  pthread_mutexattr_init(&inherits);
  pthread_mutexattr_setprotocol(&inherits, PTHREAD_PRIO_INHERIT);
  pthread_mutex_t owned{};
  pthread_mutex_init(&owned, &inherits);
  pthread_mutex_lock(&owned);
  std::thread third([&] {
    const std::int64_t ns = took([&] { expect(pthread_mutex_lock(&owned) == 0, "PI lock"); });
    expect(is_about(ns, 5 * kMillisecond), "a lock with inheritance waits");
    pthread_mutex_unlock(&owned);
  });
  usleep(5'000);
  pthread_mutex_unlock(&owned);
  third.join();
}

void* die_with(void* lock) {
  pthread_mutex_lock(static_cast<pthread_mutex_t*>(lock));
  return nullptr;
}

void check_ends() {
  pthread_mutexattr_t robust{};
  pthread_mutexattr_init(&robust);
  pthread_mutexattr_setrobust(&robust, PTHREAD_MUTEX_ROBUST);
  pthread_mutex_t lock{};
  pthread_mutex_init(&lock, &robust);
  pthread_t thread{};
  expect(pthread_create(&thread, nullptr, die_with, &lock) == 0, "pthread_create");
  usleep(1'000);
  expect(pthread_mutex_lock(&lock) == EOWNERDEAD, "a robust lock tells that its owner is dead");
  void* result = &thread;
  expect(pthread_join(thread, &result) == 0 && result == nullptr, "pthread_join");
  std::future<int> later = std::async(std::launch::async, [] {
    sleep(1);
    return 7;
  });
  const std::int64_t ns = took([&] { expect(later.get() == 7, "std::future"); });
  expect(is_about(ns, kSecond), "a future waits for its thread");
  thrd_t old{};
  int number = -1;
  const thrd_start_t routine = [](void* argument) { return *static_cast<int*>(argument) + 1; };
  int argument = 41;
  expect(thrd_create(&old, routine, &argument) == thrd_success, "thrd_create");
  expect(thrd_join(old, &number) == thrd_success && number == 42, "thrd_join");
}

struct AtEnd {
  int* count;
  ~AtEnd() { ++*count; }
};

void check_own_storage() {
  static int ended = 0;
  std::thread([] {
    thread_local const AtEnd last{&ended};
    static_cast<void>(last.count);
  }).join();
  expect(ended == 1, "destructors of a thread's storage run before it is joined");
  expect(gettid() == getpid(), "the first thread has the number of its process");
  pid_t number = 0;
  std::thread([&] { number = gettid(); }).join();
  expect(number > 0 && number != getpid(), "others have their own");
}

void check_semaphores() {
  sem_t semaphore{};
  sem_init(&semaphore, 0, 0);
  timespec until{};
  clock_gettime(CLOCK_REALTIME, &until);
  until.tv_sec += 1;
  const std::int64_t ns =
      took([&] { expect_error(sem_timedwait(&semaphore, &until), ETIMEDOUT, "sem_timedwait"); });
  expect(is_about(ns, kSecond), "until its time on the system clock");
  std::thread other([&] {
    usleep(3'000);
    sem_post(&semaphore);
  });
  expect(sem_wait(&semaphore) == 0, "sem_wait");
  other.join();
  pthread_barrier_t barrier{};
  pthread_barrier_init(&barrier, nullptr, 3);
  std::vector<std::thread> all;
  for (int i = 0; i < 3; ++i) {
    all.emplace_back([&, i] {
      usleep(static_cast<useconds_t>(1000 * i));
      pthread_barrier_wait(&barrier);
    });
  }
  for (std::thread& each : all) each.join();
}

// A cancelled wait ends.
void* wait_for_ever(void* /*nothing*/) {
  for (;;) sleep(1000);
}

void* lock_for_ever(void* given) {
  pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
  pthread_mutex_lock(&lock);
  pthread_cond_wait(static_cast<pthread_cond_t*>(given), &lock);
  return nullptr;
}

void check_cancelling() {
  pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
  for (auto* routine : {wait_for_ever, lock_for_ever}) {
    pthread_t thread{};
    pthread_create(&thread, nullptr, routine, &condition);
    usleep(1'000);
    void* result = nullptr;
    expect(pthread_cancel(thread) == 0 && pthread_join(thread, &result) == 0, "pthread_cancel");
    expect(result == PTHREAD_CANCELED, "a cancelled thread says so");
  }
}

std::atomic<int> signals_taken = 0;

void check_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { ++signals_taken; };
  sigaction(SIGUSR2, &action, nullptr);
  std::atomic<int> error = 0;
  std::thread other([&] {
    const timespec long_time{.tv_sec = 100, .tv_nsec = 0};
    if (nanosleep(&long_time, nullptr) < 0) error = errno;
  });
  usleep(1'000);
  pthread_kill(other.native_handle(), SIGUSR2);
  other.join();
  expect(error == EINTR && signals_taken == 1, "a signal ends a sleep of another thread");
}

// What nobody's function does.
void check_calls() {
  std::uint32_t place = 5;
  const timespec moment{.tv_sec = 0, .tv_nsec = 2'000'000};
  errno = 0;
  expect_error(syscall(SYS_futex, &place, FUTEX_WAIT_PRIVATE, 4, &moment), EAGAIN,
               "another value is there");
  const std::int64_t ns = took([&] {
    expect_error(syscall(SYS_futex, &place, FUTEX_WAIT_PRIVATE, 5, &moment), ETIMEDOUT, "in vain");
  });
  expect(is_about(ns, 2 * kMillisecond), "a wait on a place has its time");
  expect(syscall(SYS_futex, &place, FUTEX_WAKE_PRIVATE, 1) == 0, "nobody waits");
  std::vector<std::thread> waiting;
  std::uint32_t other = 0;
  for (int i = 0; i < 3; ++i) {
    waiting.emplace_back([&] { syscall(SYS_futex, &place, FUTEX_WAIT_PRIVATE, 5, nullptr); });
  }
  usleep(1'000);
  expect(syscall(SYS_futex, &place, FUTEX_CMP_REQUEUE_PRIVATE, 1, 2, &other, 5) == 3,
         "one is woken, two wait elsewhere");
  expect(syscall(SYS_futex, &place, FUTEX_WAKE_PRIVATE, 9) == 0, "here no more");
  expect(syscall(SYS_futex, &other, FUTEX_WAKE_PRIVATE, 9) == 2, "but there");
  for (std::thread& each : waiting) each.join();
}

// A counter of the kernel's between threads.
void check_counters() {
  const int counter = eventfd(0, 0);
  std::thread other([&] {
    usleep(8'000);
    const std::uint64_t two = 2;
    expect(write(counter, &two, sizeof two) == sizeof two, "write");
  });
  std::uint64_t value = 0;
  const std::int64_t ns =
      took([&] { expect(read(counter, &value, sizeof value) == sizeof value, "read"); });
  expect(value == 2 && is_about(ns, 8 * kMillisecond), "a read waits for another's write");
  other.join();
  int ends[2];
  expect(pipe(ends) == 0, "pipe");
  std::vector<char> much(300'000, 'x');
  std::thread reader([&] {
    std::size_t got = 0;
    while (got < much.size()) {
      usleep(1'000);
      got += static_cast<std::size_t>(read(ends[0], much.data(), 20'000));
    }
  });
  expect(write(ends[1], much.data(), much.size()) == static_cast<ssize_t>(much.size()),
         "a write waits for room");
  reader.join();
}

void check() {
  check_conditions();
  check_locks();
  check_ends();
  check_own_storage();
  check_semaphores();
  check_cancelling();
  check_signals();
  check_calls();
  check_counters();
  finish();
}

// As many as there may be.
void bomb() {
  std::vector<std::thread> threads;
  std::mutex held;
  held.lock();
  int error = 0;
  try {
    for (int i = 0; i < 1000; ++i)
      threads.emplace_back([&] {
        held.lock();
        held.unlock();
      });
  } catch (const std::system_error& failure) {
    error = failure.code().value();
  }
  std::printf("%zu threads: %s\n", threads.size(), strerrorname_np(error));
  held.unlock();
  for (std::thread& each : threads) each.join();
  finish();
}

// The order in which threads come to what they share.
void order() {
  std::mutex mutex;
  std::string taken;
  std::vector<std::thread> threads;
  for (char name = 'a'; name < 'i'; ++name) {
    threads.emplace_back([&, name] {
      for (int i = 0; i < 20; ++i) {
        const std::lock_guard lock(mutex);
        taken += name;
        usleep(static_cast<useconds_t>((name * 7 + i * 13) % 50));
      }
    });
  }
  for (std::thread& each : threads) each.join();
  std::puts(taken.c_str());
  finish();
}

}  // namespace

int main(int count, char** words) {
  const std::string what = count > 1 ? words[1] : "";
  if (what == "check") check();
  if (what == "bomb") bomb();
  if (what == "order") order();
  if (what == "compute") {
    std::thread([] {
      for (volatile unsigned i = 0;;) i = i + 1;
    }).join();
  }
  return 2;
}

// The engine of the simulated world: virtual time, and its events in their order.
//
// Events are executed in the total order (time, order of scheduling). Virtual time moves only when
// an event is taken and never decreases. The engine is single-threaded: one world, one thread, any
// number of worlds side by side.
//
// There are two kinds of event, both without allocation in steady state:
//
//   schedule()  a typed event for an attached EventHandler, for models on hot paths
//   call_at()   a callback with a capture of up to 48 bytes, which can be cancelled
//
// Coroutines wait on the engine through virtual_executor.h.
//
//   class Metronome : public EventHandler {
//    public:
//     explicit Metronome(Engine& engine) : engine_(engine), id_(engine.attach(*this)) {}
//     void start(TrueTime at) { engine_.schedule(at, id_, 0, 0); }
//     void handle(Event event) override {
//       engine_.schedule(event.time + from_ms(500), id_, event.kind, event.subject + 1);
//     }
//    private:
//     Engine& engine_;
//     HandlerId id_;
//   };
//
// Every executed event enters the trace hash, a 64-bit hash of (time, handler, kind, subject) that
// depends on the order: two runs with the same hash executed the same events. Callbacks enter with
// a fixed mark in place of handler, kind and subject.
//
// Errors: scheduling before now() is a programming error and stops the program. A run that does
// not end by itself ends with EngineLimitReached. Exceptions of handlers and callbacks leave run();
// the engine stays usable and the event counts as executed.
//
// Complexity: see event_queue.h. Times: integer nanoseconds of true time.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/ports/assert.h"
#include "recording/true_time.h"
#include "sim/engine/callback_slab.h"
#include "sim/engine/event.h"
#include "sim/engine/event_queue.h"

namespace simbench::sim {

// The limits of a run, for those that never end. The defaults are far beyond any scenario: some
// minutes of computing, a year of virtual time.
struct EngineLimits {
  std::uint64_t max_events = 10'000'000'000;
  TrueTime max_time = TrueTime(std::chrono::hours(24 * 365));  // events at max_time still happen
  // Polled after some thousand events; once true, the run stops as by stop(). May be null.
  const std::atomic<bool>* cancel = nullptr;
  // Called as often, with the present time; empty: never. It must not change the world.
  std::function<void(TrueTime now)> on_poll{};
};

// The message has the limit, the virtual time, the events executed and pending, and what live
// coroutines wait for, a line each; limit() its first line alone.
class EngineLimitReached : public std::runtime_error {
 public:
  EngineLimitReached(std::string limit, const std::string& waits)
      : std::runtime_error(limit + waits), limit_(std::move(limit)) {}
  const std::string& limit() const { return limit_; }

 private:
  std::string limit_;
};

// Names one callback. A default-constructed id names none. Ids are never reused in practice: each
// slot counts its 2^32 generations.
class TimerId {
 public:
  TimerId() = default;
  bool is_none() const { return slot_ == std::numeric_limits<std::uint32_t>::max(); }

 private:
  friend class Engine;
  TimerId(std::uint32_t slot, std::uint32_t generation) : slot_(slot), generation_(generation) {}

  std::uint32_t slot_ = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t generation_ = 0;
};

class Engine {
 public:
  explicit Engine(EngineLimits limits = {}, TrueTime start = TrueTime{});
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  // The time of the event being executed, or of the last one; run_until() moves it to its end.
  TrueTime now() const { return now_; }

  // Gives the handler its number. The handler must outlive the engine's runs. Up to 65535.
  HandlerId attach(EventHandler& handler);

  // Schedules an event at `at`, not before now(). It cannot be cancelled, only ignored by its
  // handler.
  void schedule(TrueTime at, HandlerId handler, std::uint16_t kind, std::uint32_t subject) {
    SIMBENCH_ASSERT(at >= now_, "an event cannot be scheduled in the past");
    SIMBENCH_ASSERT(handler < handlers_.size(), "the handler is not attached to this engine");
    queue_.push(at, payload_of(handler, kind, subject));
  }

  // Calls `callback()` at `at`, not before now(). The callback is destroyed exactly once: after
  // its call, when cancelled, or with the engine.
  template <class F>
  TimerId call_at(TrueTime at, F callback) {
    SIMBENCH_ASSERT(at >= now_, "a callback cannot be scheduled in the past");
    const std::uint32_t slot = callbacks_.emplace(std::move(callback));
    queue_.push(at, payload_of(kCallbackHandler, 0, slot));
    return TimerId(slot, callbacks_.generation(slot));
  }

  // Destroys the callback. False if it runs or has run, was cancelled, or the id names none.
  bool cancel(TimerId id);

  // Executes events until none is pending, stop() is called, or a limit is reached, which throws
  // EngineLimitReached.
  void run();

  // Executes the events with time < end, then sets now() to end. If stop() is called, now() stays
  // where it was. Limits throw as in run().
  void run_until(TrueTime end);

  // Leaves run() or run_until() after the current event.
  void stop() { stopped_ = true; }

  std::uint64_t events() const { return events_; }
  // Events and callbacks still to come, without cancelled ones.
  std::size_t pending() const { return queue_.size() - cancelled_; }
  std::uint64_t trace_hash() const { return trace_hash_; }

  // Reports what live coroutines wait for, a line each, for the message of EngineLimitReached
  // (virtual_executor.h sets it). An empty function removes the reporter.
  using WaitReporter = std::function<std::vector<std::string>()>;
  void set_wait_reporter(WaitReporter reporter) { wait_reporter_ = std::move(reporter); }

 private:
  static constexpr HandlerId kCallbackHandler = std::numeric_limits<HandlerId>::max();

  void execute_through(TrueTime last);
  bool is_cancelled() const {
    return limits_.cancel != nullptr && limits_.cancel->load(std::memory_order_relaxed);
  }
  void begin(TrueTime at, std::uint64_t payload);
  bool release_if_cancelled(Event event);
  bool has_event_through(TrueTime last);
  [[noreturn]] void throw_limit_reached() const;

  EngineLimits limits_;
  TrueTime now_;
  EventQueue queue_;
  std::vector<EventHandler*> handlers_;
  std::uint64_t events_ = 0;
  std::uint64_t trace_hash_ = 0;
  bool stopped_ = false;
  bool running_ = false;
  std::size_t cancelled_ = 0;  // cancelled callbacks whose events still lie in the queue
  WaitReporter wait_reporter_;
  // Last, so that the destructor of a callback still finds an engine.
  CallbackSlab callbacks_;
};

}  // namespace simbench::sim

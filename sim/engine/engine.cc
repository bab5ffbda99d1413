#include "sim/engine/engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace simbench::sim {
namespace {

// Below this many cancelled callbacks the queue is not worth sweeping.
constexpr std::size_t kFewCancelled = 64;

// Few enough for a part of a second, also where an event takes long.
constexpr std::uint64_t kEventsBetweenPolls = 1024;

// Odd constants with about half of their bits set (golden ratio; first constant of splitmix64).
constexpr std::uint64_t kHashPayload = 0x9E3779B97F4A7C15;
constexpr std::uint64_t kHashChain = 0xBF58476D1CE4E5B9;

// One multiplication on the chain from event to event, so that the hash keeps pace with the queue.
std::uint64_t extend_hash(std::uint64_t hash, std::int64_t time_ns, std::uint64_t payload) {
  hash = (hash ^ (static_cast<std::uint64_t>(time_ns) + payload * kHashPayload)) * kHashChain;
  return hash ^ (hash >> 32);
}

double seconds_of(TrueTime time) { return to_seconds(time.time_since_epoch()); }

}  // namespace

Engine::Engine(EngineLimits limits, TrueTime start) : limits_(std::move(limits)), now_(start) {}

HandlerId Engine::attach(EventHandler& handler) {
  SIMBENCH_ASSERT(handlers_.size() < kCallbackHandler, "too many event handlers");
  handlers_.push_back(&handler);
  return static_cast<HandlerId>(handlers_.size() - 1);
}

bool Engine::cancel(TimerId id) {
  if (!callbacks_.exists(id.slot_) || callbacks_.generation(id.slot_) != id.generation_ ||
      !callbacks_.holds(id.slot_)) {
    return false;
  }
  ++cancelled_;
  callbacks_.destroy(id.slot_);
  if (cancelled_ > kFewCancelled && cancelled_ > queue_.size() / 2) {
    queue_.erase_if(
        [this](const QueueEntry& entry) { return release_if_cancelled(entry.event()); });
  }
  return true;
}

bool Engine::release_if_cancelled(Event event) {
  if (event.handler != kCallbackHandler || callbacks_.holds(event.subject)) return false;
  --cancelled_;
  callbacks_.release(event.subject);
  return true;
}

void Engine::run() {
  execute_through(limits_.max_time);
  if (!stopped_ && pending() > 0) throw_limit_reached();
}

void Engine::run_until(TrueTime end) {
  SIMBENCH_ASSERT(end >= now_, "virtual time cannot run backwards");
  const TrueTime last = end - Nanoseconds(1);
  execute_through(std::min(last, limits_.max_time));
  if (stopped_) return;
  if (has_event_through(last)) throw_limit_reached();
  now_ = end;
}

// The time of an event, and its place in the trace.
inline void Engine::begin(TrueTime at, std::uint64_t payload) {
  now_ = at;
  ++events_;
  trace_hash_ = extend_hash(trace_hash_, at.time_since_epoch().count(), payload);
}

void Engine::execute_through(TrueTime last) {
  SIMBENCH_ASSERT(!running_, "an event must not run the engine that executes it");
  struct Running {
    bool& flag;
    explicit Running(bool& running) : flag(running) { flag = true; }
    ~Running() { flag = false; }
  } const running(running_);
  stopped_ = false;
  while (events_ < limits_.max_events) {
    stopped_ = is_cancelled();
    if (stopped_) return;
    if (limits_.on_poll) limits_.on_poll(now_);
    const std::uint64_t next_poll = std::min(limits_.max_events, events_ + kEventsBetweenPolls);
    while (events_ < next_poll) {
      QueueEntry entry;
      if (!queue_.pop_through(last, entry)) return;
      const Event event = entry.event();
      if (event.handler != kCallbackHandler) {
        begin(event.time, entry.payload);
        handlers_[event.handler]->handle(event);
      } else if (!release_if_cancelled(event)) {
        // The slot of a callback says nothing about the world.
        begin(event.time, payload_of(kCallbackHandler, 0, 0));
        callbacks_.run(event.subject);
      }
      if (stopped_) return;
    }
  }
}

bool Engine::has_event_through(TrueTime last) {
  const std::int64_t last_ns = last.time_since_epoch().count();
  std::optional<QueueEntry> first = queue_.first();
  while (first && first->time_ns <= last_ns && release_if_cancelled(first->event())) {
    QueueEntry cancelled;
    queue_.pop_through(last, cancelled);
    first = queue_.first();
  }
  return first && first->time_ns <= last_ns;
}

void Engine::throw_limit_reached() const {
  const std::string limit =
      events_ >= limits_.max_events
          ? fmt::format("limit of {} events reached", limits_.max_events)
          : fmt::format("limit of virtual time, {} s, reached", seconds_of(limits_.max_time));
  std::string reached = fmt::format("{} at {} s after {} events, {} pending", limit,
                                    seconds_of(now_), events_, pending());
  std::string waiting;
  if (wait_reporter_) {
    const std::vector<std::string> waits = wait_reporter_();
    waiting = fmt::format("; {} coroutines wait", waits.size());
    for (const std::string& wait : waits) waiting += "\n  " + wait;
  }
  throw EngineLimitReached(std::move(reached), waiting);
}

}  // namespace simbench::sim

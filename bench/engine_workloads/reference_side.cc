// The workloads without an engine: a priority queue, plain events, a switch.
#include <limits>
#include <queue>
#include <vector>

#include "bench/engine_workloads/models.h"
#include "bench/engine_workloads/workload.h"

namespace simbench::bench {
namespace {

struct PlainEvent {
  std::int64_t time_ns;
  std::uint64_t sequence;
  std::uint32_t kind;
  std::uint32_t subject;
};

struct Later {
  bool operator()(const PlainEvent& a, const PlainEvent& b) const {
    return a.time_ns != b.time_ns ? a.time_ns > b.time_ns : a.sequence > b.sequence;
  }
};

class PlainQueue {
 public:
  void push(std::int64_t time_ns, std::uint32_t kind, std::uint32_t subject) {
    queue_.push({time_ns, next_sequence_++, kind, subject});
  }
  const PlainEvent& top() const { return queue_.top(); }
  void pop() { queue_.pop(); }

 private:
  std::priority_queue<PlainEvent, std::vector<PlainEvent>, Later> queue_;
  std::uint64_t next_sequence_ = 0;
};

// Executes events up to the end of the warm-up or, when that is past, of the run.
void run_hold_phase(PlainQueue& queue, HoldModel& model) {
  do {
    const PlainEvent event = queue.top();
    queue.pop();
    const std::int64_t delay_ns = model.expire(event.subject);
    if (model.ended()) return;
    queue.push(event.time_ns + delay_ns, 0, event.subject);
  } while (!model.warmed_up());
}

// Executes at most `max_events` events before the end; returns their number.
std::uint64_t run_rig_phase(PlainQueue& queue, RigModel& model, std::int64_t end_ns,
                            std::uint64_t max_events) {
  std::uint64_t events = 0;
  while (events < max_events && queue.top().time_ns < end_ns) {
    const PlainEvent event = queue.top();
    const std::int64_t now_ns = event.time_ns;
    queue.pop();
    ++events;
    switch (event.kind) {
      case RigModel::kTrigger: {
        const std::uint32_t slot = model.trigger(event.subject, now_ns);
        queue.push(now_ns + model.delay_ns(0, slot), 1, slot);
        queue.push(now_ns + RigModel::kPeriod_ns, RigModel::kTrigger, event.subject);
        break;
      }
      case RigModel::kDelivery:
        model.deliver(event.subject, now_ns);
        break;
      default:
        model.stamp(event.kind, event.subject, now_ns);
        queue.push(now_ns + model.delay_ns(event.kind, event.subject), event.kind + 1,
                   event.subject);
    }
  }
  return events;
}

}  // namespace

WorkloadResult run_hold_reference(std::uint32_t timers, std::uint64_t events) {
  PlainQueue queue;
  HoldModel model(timers, events);
  for (std::uint32_t i = 0; i < timers; ++i) queue.push(first_expiry_ns(i), 0, i);
  run_hold_phase(queue, model);  // the warm-up
  const double start = cpu_seconds();
  run_hold_phase(queue, model);
  return {.events = events, .seconds = cpu_seconds() - start, .checksum = model.checksum()};
}

WorkloadResult run_rig_reference(std::uint32_t cameras, std::int64_t duration_ms) {
  const std::int64_t end_ns = duration_ms * 1'000'000;
  const std::uint64_t warm_up = std::uint64_t{6} * cameras;
  PlainQueue queue;
  RigModel model(cameras);
  for (std::uint32_t i = 0; i < cameras; ++i) {
    queue.push(trigger_phase_ns(i), RigModel::kTrigger, i);
  }
  if (run_rig_phase(queue, model, end_ns, warm_up) < warm_up) throw_too_short(duration_ms);
  const double start = cpu_seconds();
  const std::uint64_t events =
      run_rig_phase(queue, model, end_ns, std::numeric_limits<std::uint64_t>::max());
  const double seconds = cpu_seconds() - start;
  if (events == 0) throw_too_short(duration_ms);
  return {.events = events,
          .seconds = seconds,
          .checksum = model.checksum(),
          .order_checksum = model.order_checksum()};
}

}  // namespace simbench::bench

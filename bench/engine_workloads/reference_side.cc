// The workloads without an engine: a priority queue, packed events, a switch.
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <stdexcept>
#include <vector>

#include "bench/engine_workloads/models.h"
#include "bench/engine_workloads/workload.h"

namespace simbench::bench {
namespace {

struct PlainEvent {
  std::int64_t time_ns;
  std::uint32_t kind;
  std::uint32_t subject;
};

// An event and its place in the order of insertion in 16 bytes, which compare as one number: from
// the top 64 bits of time, 35 of sequence, 3 of kind and 26 of subject. It holds 3.4e10 events of
// up to 8 kinds and 6.7e7 subjects: all that the workloads need, and less than a general engine
// does.
__extension__ typedef __int128 PackedEvent;

constexpr int kSequenceBits = 35;
constexpr int kKindBits = 3;
constexpr int kSubjectBits = 26;
static_assert(kSequenceBits + kKindBits + kSubjectBits == 64);

PackedEvent packed(const PlainEvent& event, std::uint64_t sequence) {
  const std::uint64_t low = (sequence << (kKindBits + kSubjectBits)) |
                            (std::uint64_t{event.kind} << kSubjectBits) | event.subject;
  return (static_cast<PackedEvent>(event.time_ns) << 64) | static_cast<PackedEvent>(low);
}

PlainEvent unpacked(PackedEvent event) {
  const auto low = static_cast<std::uint64_t>(event);
  return {.time_ns = static_cast<std::int64_t>(event >> 64),
          .kind = static_cast<std::uint32_t>(low >> kSubjectBits) & ((1U << kKindBits) - 1),
          .subject = static_cast<std::uint32_t>(low) & ((1U << kSubjectBits) - 1)};
}

class PlainQueue {
 public:
  void push(std::int64_t time_ns, std::uint32_t kind, std::uint32_t subject) {
    queue_.push(packed({time_ns, kind, subject}, next_sequence_++));
  }
  std::int64_t next_ns() const { return static_cast<std::int64_t>(queue_.top() >> 64); }
  PlainEvent pop() {
    const PlainEvent event = unpacked(queue_.top());
    queue_.pop();
    return event;
  }
  std::uint64_t pushed() const { return next_sequence_; }

 private:
  std::priority_queue<PackedEvent, std::vector<PackedEvent>, std::greater<>> queue_;
  std::uint64_t next_sequence_ = 0;
};

// Their order would be lost.
void refuse_too_many(const PlainQueue& queue) {
  if (queue.pushed() >> kSequenceBits != 0) throw std::length_error("too many events to pack");
}

// Executes events up to the end of the warm-up or, when that is past, of the run.
void run_hold_phase(PlainQueue& queue, HoldModel& model) {
  do {
    const PlainEvent event = queue.pop();
    const std::int64_t delay_ns = model.expire(event.subject);
    if (model.ended()) return;
    queue.push(event.time_ns + delay_ns, 0, event.subject);
  } while (!model.warmed_up());
}

// Executes at most `max_events` events before the end; returns their number.
std::uint64_t run_rig_phase(PlainQueue& queue, RigModel& model, std::int64_t end_ns,
                            std::uint64_t max_events) {
  std::uint64_t events = 0;
  while (events < max_events && queue.next_ns() < end_ns) {
    const PlainEvent event = queue.pop();
    const std::int64_t now_ns = event.time_ns;
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
  const double seconds = cpu_seconds() - start;
  refuse_too_many(queue);
  return {.events = events, .seconds = seconds, .checksum = model.checksum()};
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
  refuse_too_many(queue);
  return {.events = events,
          .seconds = seconds,
          .checksum = model.checksum(),
          .order_checksum = model.order_checksum()};
}

}  // namespace simbench::bench

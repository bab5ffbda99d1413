// futex(), which the locks, condition variables, semaphores and joins of all libraries wait with.
//
// A thread that waits is the world's (kWaitForWake); the value is looked at here, and nobody else
// runs in between. When a thread or process ends, the world wakes all that wait, as futex() may:
// who joins it then sees what the kernel has written.
#include <errno.h>
#include <linux/futex.h>
#include <stdint.h>
#include <sys/syscall.h>
#include <time.h>

#include <initializer_list>

#include "shim/link.h"
#include "shim/served_calls.h"

namespace simbench::shim {
namespace {

using Value = std::uint32_t;

Value value_at(const Value* place) { return __atomic_load_n(place, __ATOMIC_SEQ_CST); }
void put_value(Value* place, Value value) { __atomic_store_n(place, value, __ATOMIC_SEQ_CST); }

Lock lock_at(const void* place, int operation, Value bits = ~0U) {
  return {.address = reinterpret_cast<std::uintptr_t>(place),
          .bits = bits,
          .is_shared = (operation & FUTEX_PRIVATE_FLAG) == 0 ? 1U : 0U};
}

struct LockWait {
  Lock lock{};
  Deadline kind = Deadline::kNever;
  std::int64_t time = 0;
};

bool set_deadline(LockWait& wait, const timespec* time, bool is_absolute, bool is_system) {
  if (time == nullptr) return true;
  if (!is_time(*time)) return false;
  wait.time = nanoseconds(*time);
  wait.kind = !is_absolute ? Deadline::kAfter
              : is_system  ? Deadline::kAtSystemTime
                           : Deadline::kAtMonotonicTime;
  return true;
}

// 0 or minus an errno.
Word wait_for_wake(LockWait& wait) {
  if (!has_link()) return 0;
  for (;;) {
    const HandledSignals before = handled_signals();
    std::int64_t left = wait.time;
    Received reply{.data = &left, .capacity = sizeof left};
    const std::int64_t woken =
        ask({.call = Call::kWaitForWake, .a = static_cast<std::int64_t>(wait.kind), .b = wait.time},
            {&wait.lock, sizeof wait.lock}, {}, &reply);
    if (woken >= 0) return 0;
    if (errno != EINTR) return -errno;
    if (handled_signals().interrupting != before.interrupting) return -EINTR;
    // It has not been woken; who waits anew may see another value by now.
    if (handled_signals().all != before.all) return 0;
    if (wait.kind == Deadline::kAfter) wait.time = left;
  }
}

std::int64_t wake(const Lock& lock, std::int64_t most) {
  if (!has_link()) return 0;
  return ask({.call = Call::kWake, .a = most}, {&lock, sizeof lock});
}

Word requeue(Value* from, Value* to, int operation, std::int64_t woken, std::int64_t moved) {
  const Lock locks[2] = {lock_at(from, operation), lock_at(to, operation)};
  return static_cast<Word>(
      ask({.call = Call::kRequeue, .a = woken, .b = moved}, {locks, sizeof locks}));
}

// FUTEX_WAKE_OP: changes the second place, wakes at the first, and at the second if its old value
// compares so.
Word wake_and_change(const Word* a, int operation) {
  auto* first = at<Value>(a[0]);
  auto* second = at<Value>(a[4]);
  const auto code = static_cast<Value>(a[5]);
  auto operand = static_cast<std::int32_t>(code << 8U) >> 20U;
  const std::int32_t compared = static_cast<std::int32_t>(code << 20U) >> 20U;
  const Value kind = (code >> 28U) & 15U;
  if ((kind & FUTEX_OP_OPARG_SHIFT) != 0) operand = 1 << (operand & 31);
  const Value old = value_at(second);
  const auto given = static_cast<Value>(operand);
  switch (kind & 7U) {
    case FUTEX_OP_SET:
      put_value(second, given);
      break;
    case FUTEX_OP_ADD:
      put_value(second, old + given);
      break;
    case FUTEX_OP_OR:
      put_value(second, old | given);
      break;
    case FUTEX_OP_ANDN:
      put_value(second, old & ~given);
      break;
    case FUTEX_OP_XOR:
      put_value(second, old ^ given);
      break;
    default:
      return -ENOSYS;
  }
  const auto was = static_cast<std::int32_t>(old);
  const bool holds[] = {was == compared, was != compared,
                        was<compared, was <= compared, was> compared, was >= compared};
  const Value comparison = (code >> 24U) & 15U;
  if (comparison >= sizeof holds) return -ENOSYS;
  std::int64_t woken = wake(lock_at(first, operation), a[2]);
  if (holds[comparison]) woken += wake(lock_at(second, operation), a[3]);
  return static_cast<Word>(woken);
}

// Locks whose place has their owner's number by the machine.
Word take_owned(Value* place, int operation, const timespec* time, bool waits, bool is_system) {
  const auto own = static_cast<Value>(machine_call(SYS_gettid));
  LockWait wait{.lock = lock_at(place, operation)};
  if (!set_deadline(wait, time, true, is_system)) return -EINVAL;
  for (;;) {
    const Value now = value_at(place);
    if ((now & FUTEX_TID_MASK) == 0) {
      put_value(place, own | (now & (FUTEX_WAITERS | FUTEX_OWNER_DIED)));
      return 0;
    }
    if ((now & FUTEX_TID_MASK) == own) return -EDEADLK;
    if (!waits) return -EAGAIN;
    put_value(place, now | FUTEX_WAITERS);
    const Word woken = wait_for_wake(wait);
    if (woken == -ETIMEDOUT) return woken;
  }
}

Word give_owned(Value* place, int operation) {
  put_value(place, value_at(place) & FUTEX_WAITERS);
  wake(lock_at(place, operation), 1);
  return 0;
}

}  // namespace

Word serve_futex(const Word* a) {
  auto* place = at<Value>(a[0]);
  const auto operation = static_cast<int>(a[1]);
  const auto* time = at<const timespec>(a[3]);
  const int command = operation & FUTEX_CMD_MASK;
  const bool is_system = (operation & FUTEX_CLOCK_REALTIME) != 0;
  const auto value = static_cast<Value>(a[2]);
  switch (command) {
    case FUTEX_WAIT:
    case FUTEX_WAIT_BITSET: {
      const bool has_bits = command == FUTEX_WAIT_BITSET;
      LockWait wait{.lock = lock_at(place, operation, has_bits ? static_cast<Value>(a[5]) : ~0U)};
      if (wait.lock.bits == 0 || !set_deadline(wait, time, has_bits, is_system)) return -EINVAL;
      return value_at(place) != value ? -EAGAIN : wait_for_wake(wait);
    }
    case FUTEX_WAKE:
      return static_cast<Word>(wake(lock_at(place, operation), static_cast<int>(a[2])));
    case FUTEX_WAKE_BITSET:
      return static_cast<Word>(
          wake(lock_at(place, operation, static_cast<Value>(a[5])), static_cast<int>(a[2])));
    case FUTEX_CMP_REQUEUE:
      if (value_at(place) != static_cast<Value>(a[5])) return -EAGAIN;
      [[fallthrough]];
    case FUTEX_REQUEUE:
      return requeue(place, at<Value>(a[4]), operation, static_cast<int>(a[2]),
                     static_cast<int>(a[3]));
    case FUTEX_WAKE_OP:
      return wake_and_change(a, operation);
    case FUTEX_LOCK_PI:
    case FUTEX_LOCK_PI2:
      return take_owned(place, operation, time, true, is_system || command == FUTEX_LOCK_PI);
    case FUTEX_TRYLOCK_PI:
      return take_owned(place, operation, nullptr, false, false);
    case FUTEX_UNLOCK_PI:
      return give_owned(place, operation);
    default:
      return -ENOSYS;
  }
}

}  // namespace simbench::shim

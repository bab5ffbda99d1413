// The requests that concern waits.
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "sim/programs/epoll_set.h"
#include "sim/programs/process.h"
#include "sim/programs/program_thread.h"

namespace simbench::sim {
namespace {

// What a wait of no time takes where other threads of the host are to have their turn.
constexpr Nanoseconds kTurn(1000);

void take_earlier(std::optional<TrueTime>& next, std::optional<TrueTime> look) {
  if (look && (!next || *look < *next)) next = look;
}

}  // namespace

Task<WaitEnd> Process::wait_until(ProgramThread& thread, WakeTime deadline, bool watches_real,
                                  std::function<bool()> is_ready,
                                  std::function<std::optional<TrueTime>()> timers) {
  const SimHost& host = around_.host;
  const std::uint64_t activity = around_.processes.activity();
  for (;;) {
    if (is_ready() || is_stopped_) co_return WaitEnd::kReady;
    if (is_past(host, deadline)) co_return WaitEnd::kTimeUp;
    if (watches_real && around_.processes.activity() != activity) co_return WaitEnd::kActivity;
    if (has_expirations() || thread.signals_seen != signals_) co_return WaitEnd::kSignal;
    std::optional<TrueTime> look = next_look(host, deadline);
    take_earlier(look, timers());
    for (const auto& [number, timer] : signal_timers_) take_earlier(look, timer.next_look());
    thread.watches_real = watches_real;
    co_await thread.woken.wait(look);
    thread.watches_real = false;
  }
}

std::int16_t Process::readiness_of(const shim::Interest& interest) {
  const std::shared_ptr<OpenObject> object = object_of(interest.fd);
  if (object == nullptr) return POLLNVAL;
  // Timers and sets have no error that is told without being asked for.
  const bool is_of_network = object->socket() != nullptr || object->stream() != nullptr;
  const int always = is_of_network ? POLLERR | POLLHUP : 0;
  return static_cast<std::int16_t>(readiness(*object) & (interest.events | always));
}

std::optional<TrueTime> Process::next_timer(std::span<const shim::Interest> interests) {
  std::optional<TrueTime> next;
  for (const shim::Interest& interest : interests) {
    const std::shared_ptr<OpenObject> object = object_of(interest.fd);
    if (object == nullptr || (interest.events & POLLIN) == 0) continue;
    if (const ProcessTimer* timer = object->timer()) take_earlier(next, timer->next_look());
    if (EpollSet* set = object->set()) take_earlier(next, set->next_look());
  }
  return next;
}

Task<Process::Answer> Process::wait(ProgramThread& thread, ChildRequest request) {
  std::vector<shim::Interest> interests(request.data.size() / sizeof(shim::Interest));
  if (!interests.empty()) {
    std::memcpy(interests.data(), request.data.data(), interests.size() * sizeof interests[0]);
  }
  const WakeTime deadline =
      wake_time(around_.host, static_cast<shim::Deadline>(request.head.a), request.head.b);
  std::int64_t ready = 0;
  const auto look = [&] {
    ready = 0;
    for (shim::Interest& interest : interests) {
      interest.ready = readiness_of(interest);
      ready += interest.ready != 0;
    }
    return ready > 0;
  };
  const bool watches_real = (request.head.flags & shim::kWatchesReal) != 0;
  const bool has_others = around_.processes.threads() > 1;
  if (has_others && is_past(around_.host, deadline)) co_await around_.host.sleep_for(kTurn);
  const WaitEnd end = co_await wait_until(thread, deadline, watches_real, look,
                                          [&] { return next_timer(interests); });
  if (end == WaitEnd::kSignal || end == WaitEnd::kActivity) {
    co_return Answer{.error = end == WaitEnd::kActivity ? EAGAIN : EINTR,
                     .data = bytes_of(left_ns(around_.host, deadline))};
  }
  Answer answer{.value = ready};
  const auto bytes = std::as_bytes(std::span(interests));
  answer.data.assign(bytes.begin(), bytes.end());
  co_return answer;
}

Task<Process::Answer> Process::wait_for_wake(ProgramThread& thread, const ChildRequest& request) {
  thread.lock_wait = {.lock = read_head<shim::Lock>(request.data),
                      .order = around_.processes.take_order()};
  const WakeTime deadline =
      wake_time(around_.host, static_cast<shim::Deadline>(request.head.a), request.head.b);
  const WaitEnd end = co_await wait_until(
      thread, deadline, false, [&] { return thread.lock_wait->is_woken; },
      [] { return std::nullopt; });
  thread.lock_wait.reset();
  if (end == WaitEnd::kReady) co_return Answer{};
  if (end == WaitEnd::kTimeUp) co_return Answer{.error = ETIMEDOUT};
  co_return Answer{.error = EINTR, .data = bytes_of(left_ns(around_.host, deadline))};
}

// Sets of epoll().

Process::Answer Process::open_set(int fd) {
  if (open_.size() >= kMostOpen) return {.error = EMFILE};
  open(fd, std::make_shared<EpollSet>());
  return {};
}

Process::Answer Process::control_set(const ChildRequest& request) {
  const std::shared_ptr<OpenObject> set = object_of(request.head.fd);
  const auto item = read_head<shim::EpollItem>(request.data);
  const std::shared_ptr<OpenObject> object = object_of(item.number);
  if (set == nullptr || set->set() == nullptr || object == nullptr) {
    throw BadRequest("watched a descriptor that it never opened");
  }
  const int error = set->set()->control(static_cast<int>(request.head.a), object, item);
  if (error == 0) {
    object->watch(set);
    set->changed(POLLIN);
    around_.wake();
  }
  return {.error = error};
}

Process::Answer Process::take_events(const ChildRequest& request) {
  const std::shared_ptr<OpenObject> set = object_of(request.head.fd);
  if (set == nullptr || set->set() == nullptr) throw BadRequest("used a set that it never opened");
  constexpr std::int64_t kMost = shim::kMostData / sizeof(shim::EpollItem);
  const auto most = static_cast<std::size_t>(std::clamp<std::int64_t>(request.head.a, 0, kMost));
  Answer answer;
  for (const shim::EpollItem& each : set->set()->take(most)) {
    const Bytes bytes = bytes_of(each);
    answer.data.insert(answer.data.end(), bytes.begin(), bytes.end());
  }
  return answer;
}

}  // namespace simbench::sim

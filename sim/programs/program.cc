#include "sim/programs/program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/this_coro.hpp>
#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>
#include <utility>

namespace simbench::sim {
namespace {

using shim::Call;

constexpr std::size_t kMostNote = 400;  // bytes of it in the row's note

// Waits until the machine has no such thread any more, for a moment: what it does at its end is not
// to happen beside others. One of a process that goes on may stay as a zombie.
void await_end_of_thread(pid_t process, std::int64_t thread) {
  const std::string place = fmt::format("/proc/{}/task/{}", process, thread);
  for (int i = 0; i < 2000 && std::filesystem::exists(place) && thread != process; ++i) {
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

bool waits_for_machine(const ProgramThread& thread) {
  const pid_t process = thread.process->machine();
  const pid_t number = thread.machine > 0 ? thread.machine : process;
  std::ifstream file(fmt::format("/proc/{}/task/{}/stat", process, number));
  std::string text;
  std::getline(file, text);
  // Its name may have spaces and brackets; the state follows the last one.
  const std::size_t end = text.rfind(") ");
  return end != std::string::npos && text.compare(end + 2, 1, "S") == 0;
}

}  // namespace

Program::Program(const Surroundings& surroundings, const Child::Settings& settings)
    : around_(surroundings),
      chance_(
          surroundings.host.world().run_seed,
          surroundings.host.name(fmt::format(
              "program {}", surroundings.processes.next_number() - HostProcesses::kFirstNumber))),
      has_ended_(surroundings.host.world().context, surroundings.host.name("a program ends")),
      child_(settings) {
  Process& first = processes_.emplace_back(for_processes(), around_.processes.take_number(), 1);
  if (child_.process() > 0) first.set_machine(child_.process());
  around_.processes.add(first);
  add_thread(first, first.number(), nullptr);
}

Program::~Program() {
  for (Process& process : processes_) {
    if (process.machine() != child_.process() && process.signal(SIGKILL) == 0) {
      process.await_end();
    }
    around_.processes.remove(process);
  }
  for (ProgramThread& thread : threads_) around_.processes.remove_thread(thread);
}

Process::Surroundings Program::for_processes() {
  return {around_.host,  around_.network, around_.kernel,
          around_.card,  around_.pulses,  around_.processes,
          around_.files, chance_,         [this] { wake_threads(); }};
}

ProgramThread& Program::add_thread(Process& process, std::int32_t number,
                                   std::unique_ptr<Child> end) {
  ProgramThread& thread = threads_.emplace_back(around_.host, process, number, std::move(end));
  around_.processes.add_thread(thread);
  return thread;
}

void Program::wake_threads() {
  for (ProgramThread& each : threads_) each.woken.notify();
}

void Program::fail(const std::string& reason) {
  if (!std::exchange(is_over_, true)) reason_ = reason;
  for (Process& each : processes_) each.stop();
  wake_threads();
}

void Program::stop() {
  is_stopped_ = true;
  fail("");
}

Child& Program::end_of(ProgramThread& thread) {
  return thread.end != nullptr ? *thread.end : child_;
}

std::optional<ChildRequest> Program::next(ProgramThread& thread) {
  std::function<bool()> is_asleep;
  if (threads_.size() > 1) is_asleep = [&thread] { return waits_for_machine(thread); };
  Child& end = end_of(thread);
  std::optional<ChildRequest> request = end.next(is_asleep);
  if (thread.end != nullptr && !end.excess().empty()) fail(end.excess());
  return request;
}

void Program::reply(ProgramThread& thread, const Answer& answer) {
  Process& process = *thread.process;
  int error = answer.error;
  if (process.has_expirations()) error |= shim::kHasExpirations;
  if (std::exchange(thread.signals_seen, process.signals()) != process.signals()) {
    error |= shim::kHasSignals;
  }
  if (around_.processes.has_watchers()) error |= shim::kIsWatched;
  end_of(thread).reply(answer.value, error, answer.data);
}

bool Program::goes_on(const ProgramThread& thread) const {
  return !is_over_ && !thread.process->has_ended;
}

Task<void> Program::wait_for_activity(ProgramThread& thread) {
  const std::uint64_t before = around_.processes.activity();
  thread.watches_real = true;
  while (goes_on(thread) && around_.processes.activity() == before) {
    co_await thread.woken.wait(std::nullopt);
  }
  thread.watches_real = false;
}

Task<void> Program::run(ProgramThread& thread) {
  while (goes_on(thread)) {
    std::optional<ChildRequest> request = next(thread);
    if (!request && end_of(thread).thread_link().was_asleep()) {
      co_await wait_for_activity(thread);
      continue;
    }
    if (!request) break;
    std::optional<Answer> given;
    try {
      if (!request->is_whole) throw BadRequest("sent a request of a wrong size");
      if (request->head.call == Call::kEndThread) {
        thread.has_left = true;
        await_end_of_thread(thread.process->machine(), request->head.b);
        break;
      }
      thread.process->count_request();
      const bool has_acted = (request->head.flags & shim::kHasOnlyLooked) == 0;
      if (has_acted && threads_.size() > 1 && around_.processes.has_watchers()) {
        around_.processes.report_activity();
      }
      given = co_await answer(thread, std::move(*request));
    } catch (const BadRequest& bad) {
      fail(bad.what());
    }
    if (!given || !goes_on(thread)) break;
    reply(thread, *given);
  }
  co_await leave(thread);
}

Task<void> Program::leave(ProgramThread& thread) {
  Process& process = *thread.process;
  const bool ends_alone = thread.has_left || process.is_replaced;
  around_.processes.remove_thread(thread);
  std::erase_if(threads_, [&](const ProgramThread& each) { return &each == &thread; });
  wake_locks(process);
  const bool is_last = std::ranges::none_of(
      threads_, [&](const ProgramThread& each) { return each.process == &process; });
  if (!ends_alone || is_last) process.has_ended = true;
  if (is_last) co_await end_process(process);
  wake_threads();
  has_ended_.notify();
}

Task<void> Program::end_process(Process& process) {
  if (!is_stopped_) {
    co_await process.close_all();
    if (reason_.empty()) process.await_end();  // else it will be killed
    if (Process* parent = around_.processes.find(process.parent())) parent->look_at_signals();
    for (Process* each : around_.processes.all()) {
      if (each->parent() == process.number()) each->set_parent(1);
    }
  }
  around_.processes.remove(process);
  around_.processes.report_activity();
  std::erase_if(processes_, [&](const Process& each) { return &each == &process; });
}

Task<void> Program::serve() {
  co_await run(threads_.front());
  while (!threads_.empty()) co_await has_ended_.wait();
  end_ = child_.end_of(reason_);
  if (!is_stopped_) ending_ = end_.text();
}

Task<Process::Answer> Program::answer(ProgramThread& thread, ChildRequest request) {
  const shim::Request& head = request.head;
  switch (head.call) {
    case Call::kNewThread:
    case Call::kNewProcess:
      co_return co_await announce(thread, std::move(request));
    case Call::kStarted:
      co_return start(request);
    case Call::kHello:
      co_return co_await hello(thread, std::move(request));
    case Call::kExecute:
      thread.process->is_replaced = true;
      co_return Answer{};
    case Call::kSignal:
      co_return send_signal(thread, request);
    case Call::kLookAtSignals:
      if (Process* target = around_.processes.find(static_cast<std::int32_t>(head.a))) {
        target->look_at_signals();
      }
      co_return Answer{};
    case Call::kFindProcess:
      co_return find_process(head);
    case Call::kWake:
      co_return wake_waiting(thread, request);
    case Call::kRequeue:
      co_return requeue(thread, request);
    case Call::kNote:
      throw BadRequest(std::string(reinterpret_cast<const char*>(request.data.data()),
                                   std::min(request.data.size(), kMostNote)));
    default:
      co_return co_await thread.process->answer(thread, std::move(request));
  }
}

// Threads and processes.

void Program::count_made() {
  const TrueTime now = around_.host.true_now();
  if (now >= counted_since_ + Nanoseconds(std::chrono::seconds(1))) {
    counted_since_ = now;
    made_ = 0;
  }
  if (++made_ > kMostMade) {
    throw BadRequest(fmt::format("makes more than {} threads and processes a second", kMostMade));
  }
}

Task<Process::Answer> Program::announce(ProgramThread& maker, ChildRequest request) {
  if (request.passed < 0) throw BadRequest("made a thread or process without a link");
  auto end = std::make_unique<Child>(Child::Settings{.command = {"a thread"},
                                                     .patience = child_.patience(),
                                                     .link = request.passed,
                                                     .use = child_.use()});
  count_made();
  if (around_.processes.threads() >= HostProcesses::kMost) co_return Answer{.error = EAGAIN};
  const std::int32_t number = around_.processes.take_number();
  Process* process = maker.process;
  if (request.head.call == Call::kNewProcess) {
    end->thread_link().ask_for_sender();
    process = &processes_.emplace_back(*maker.process, number);
    around_.processes.add(*process);
  }
  ProgramThread& thread = add_thread(*process, number, std::move(end));
  thread.signals_seen = process->signals();
  // Its own coroutine: it begins when the maker hands over.
  boost::asio::co_spawn(co_await boost::asio::this_coro::executor, run(thread),
                        [](const std::exception_ptr& failure) {
                          if (failure) std::rethrow_exception(failure);
                        });
  co_return Answer{.value = number};
}

Process::Answer Program::start(const ChildRequest& request) {
  for (const ProgramThread& each : threads_) {
    if (each.number == request.head.a && each.end != nullptr && request.head.b != 0) {
      each.end->thread_link().await_request();
    }
  }
  return {};
}

Task<Process::Answer> Program::hello(ProgramThread& thread, ChildRequest request) {
  Process& process = *thread.process;
  process.is_replaced = false;
  thread.machine = static_cast<pid_t>(request.head.b);
  if (process.machine() < 0 && request.sender > 0) process.set_machine(request.sender);
  return process.answer(thread, std::move(request));
}

Process::Answer Program::send_signal(const ProgramThread& sender, const ChildRequest& whole) {
  const shim::Request& request = whole.head;
  const Process& own = *sender.process;
  std::optional<std::uint64_t> value;
  if (!whole.data.empty()) value = read_head<std::uint64_t>(whole.data);
  const auto number = static_cast<int>(request.b);
  const auto is_meant = [&](const Process& each) {
    if (request.a > 0) return each.number() == request.a;
    if (request.a == -1) return &each != &own;
    const pid_t group = getpgid(each.machine());
    if (request.a == 0) return group == getpgid(own.machine());
    const Process* leader = around_.processes.find(static_cast<std::int32_t>(-request.a));
    return leader != nullptr ? group == leader->machine() : false;
  };
  Answer answer{.error = ESRCH};
  const std::vector<Process*> all = around_.processes.all();
  for (Process* each : all) {
    if (!is_meant(*each)) continue;
    const int error = each->signal(number, own.number(), value);
    if (answer.error != 0) answer.error = error;
  }
  return answer;
}

Process::Answer Program::find_process(const shim::Request& request) const {
  if (request.b != 0) {
    const Process* found = around_.processes.find_machine(static_cast<pid_t>(request.a));
    return {.value = found != nullptr ? found->number() : 1};
  }
  const Process* found = around_.processes.find(static_cast<std::int32_t>(request.a));
  if (found == nullptr) return {.error = ESRCH};
  return {.value = found->machine()};
}

// Locks.

std::vector<ProgramThread*> Program::waiting_for(const Process& process, const shim::Lock& lock) {
  std::vector<ProgramThread*> waiting;
  for (ProgramThread& each : threads_) {
    const auto& wait = each.lock_wait;
    if (!wait || wait->is_woken || each.process != &process) continue;
    if (wait->lock.address == lock.address && (wait->lock.bits & lock.bits) != 0) {
      waiting.push_back(&each);
    }
  }
  std::ranges::sort(waiting, {}, [](const ProgramThread* each) { return each->lock_wait->order; });
  return waiting;
}

namespace {

void wake(ProgramThread& thread) {
  thread.lock_wait->is_woken = true;
  thread.woken.notify();
}

}  // namespace

void Program::wake_locks(const Process& process) {
  for (ProgramThread& each : threads_) {
    const bool is_meant =
        each.process == &process || (each.lock_wait && each.lock_wait->lock.is_shared);
    if (each.lock_wait && is_meant) wake(each);
  }
}

Process::Answer Program::wake_waiting(const ProgramThread& waker, const ChildRequest& request) {
  const auto lock = read_head<shim::Lock>(request.data);
  std::int64_t woken = 0;
  for (ProgramThread* each : waiting_for(*waker.process, lock)) {
    if (woken == request.head.a) break;
    wake(*each);
    ++woken;
  }
  if (lock.is_shared == 0) return {.value = woken};
  // Other processes may have it at another address.
  for (ProgramThread& each : threads_) {
    const bool shares = each.lock_wait && each.lock_wait->lock.is_shared != 0;
    if (each.process != waker.process && shares) wake(each);
  }
  return {.value = woken};
}

Process::Answer Program::requeue(const ProgramThread& waker, const ChildRequest& request) {
  if (request.data.size() < 2 * sizeof(shim::Lock)) throw BadRequest("too little data");
  const auto from = read_head<shim::Lock>(request.data);
  const auto to =
      read_head<shim::Lock>(Bytes(request.data.begin() + sizeof(shim::Lock), request.data.end()));
  std::int64_t woken = 0;
  std::int64_t moved = 0;
  for (ProgramThread* each : waiting_for(*waker.process, from)) {
    if (woken < request.head.a) {
      wake(*each);
      ++woken;
    } else if (moved < request.head.b) {
      each->lock_wait->lock.address = to.address;
      ++moved;
    }
  }
  return {.value = woken + moved};
}

}  // namespace simbench::sim

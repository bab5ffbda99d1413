#include "sim/programs/process.h"

#include <fmt/format.h>
#include <linux/ptp_clock.h>
#include <poll.h>
#include <signal.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "sim/programs/program_thread.h"

namespace simbench::sim {
namespace {

using clocks::kLatestSetting;
using shim::Call;

// What a reading of a clock takes where the scenario says less: a program may wait for a tick.
constexpr Nanoseconds kLeastReading(20);

constexpr std::size_t kMostSignalTimers = 64;

bool is_known(std::int64_t clock) { return clock >= CLOCK_REALTIME && clock <= CLOCK_TAI; }

bool is_system(std::int64_t clock) {
  return clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE || clock == CLOCK_TAI ||
         clock == CLOCK_REALTIME_ALARM;
}

bool is_about_sockets(Call call) {
  switch (call) {
    case Call::kSetOption:
    case Call::kBind:
    case Call::kConnect:
    case Call::kName:
    case Call::kPeerName:
    case Call::kReceive:
    case Call::kCountInput:
    case Call::kSocketError:
    case Call::kListen:
    case Call::kAccept:
    case Call::kShutDown:
    case Call::kJoin:
    case Call::kFilterArrivals:
    case Call::kCountArrivals:
      return true;
    default:
      return false;
  }
}

}  // namespace

Process::Process(const Surroundings& surroundings, std::int32_t number, std::int32_t parent)
    : around_(surroundings),
      number_(number),
      parent_(parent),
      counted_since_(surroundings.host.true_now()) {}

Process::Process(const Process& parent, std::int32_t number)
    : around_(parent.around_),
      number_(number),
      parent_(parent.number_),
      open_(parent.open_),
      counted_since_(parent.around_.host.true_now()) {}

Process::~Process() {
  if (handle_ >= 0) ::close(handle_);
}

void Process::set_machine(pid_t machine) {
  machine_ = machine;
  handle_ = static_cast<int>(syscall(SYS_pidfd_open, machine, 0));
}

int Process::signal(int number, std::int32_t sender, std::optional<std::uint64_t> value) {
  if (handle_ < 0) return ESRCH;
  // A process that is stopped would stop the world.
  if (number == SIGSTOP || number == SIGTSTP || number == SIGTTIN || number == SIGTTOU)
    return EPERM;
  siginfo_t info{};
  info.si_signo = number;
  info.si_code = value ? shim::kQueuedByWorld : shim::kByWorld;
  info.si_pid = sender;
  if (value) info.si_value.sival_ptr = reinterpret_cast<void*>(*value);  // NOLINT: as it came
  if (syscall(SYS_pidfd_send_signal, handle_, number, &info, 0) != 0) return errno;
  if (number != 0) look_at_signals();
  return 0;
}

void Process::look_at_signals() {
  ++signals_;
  around_.wake();
}

void Process::await_end() const {
  constexpr int kMoment = 1000;  // ms
  pollfd interest{.fd = handle_, .events = POLLIN, .revents = 0};
  if (handle_ >= 0) poll(&interest, 1, kMoment);
}

void Process::count_request() {
  constexpr Nanoseconds kASecond = std::chrono::seconds(1);
  if (around_.host.true_now() >= counted_since_ + kASecond) {
    counted_since_ = around_.host.true_now();
    asked_ = 0;
  }
  if (++asked_ > kMostASecond) {
    throw BadRequest(fmt::format("never waits: it asks more than {} times a second", kMostASecond));
  }
}

Task<Process::Answer> Process::answer(ProgramThread& thread, ChildRequest request) {
  if (is_of_stream(request)) co_return co_await of_stream(std::move(request));
  if (is_about_devices(request.head.call)) co_return of_device(request);
  if (is_about_sockets(request.head.call)) co_return of_socket(request);
  switch (request.head.call) {
    case Call::kReadClock:
      co_return co_await read_clock(request.head.a, request.head.b != 0);
    case Call::kSetClock:
      co_return co_await set_clock(request.head.a, request.head.b);
    case Call::kAdjustClock:
      co_return co_await adjust_clock(std::move(request));
    case Call::kSend:
      co_return co_await send(std::move(request));
    case Call::kWait:
      co_return co_await wait(thread, std::move(request));
    case Call::kSetTimer:
    case Call::kQueryTimer:
    case Call::kReadTimer:
      co_return of_timer(request);
    case Call::kCardStamping:
      co_return card_stamping(request.head.a);
    case Call::kSetSignalTimer:
    case Call::kQuerySignalTimer:
    case Call::kDropSignalTimer:
      co_return of_signal_timer(request);
    case Call::kTakeExpirations:
      co_return take_expirations();
    case Call::kReadCard:
      co_return co_await read_card(request.head.a);
    case Call::kLocalActivity:
      around_.processes.report_activity();
      co_return Answer{};
    case Call::kHello:
      if (request.head.a != 0) co_await keep_only(request.data);
      co_return Answer{.data = bytes_of(identity(thread))};
    case Call::kWaitForWake:
      co_return co_await wait_for_wake(thread, request);
    case Call::kOpenEpoll:
      co_return open_set(request.head.fd);
    case Call::kControlEpoll:
      co_return control_set(request);
    case Call::kTakeEvents:
      co_return take_events(request);
    case Call::kRandom:
      co_return random_bytes(request.head.a);
    case Call::kLookAtFile:
      co_return look_at_file(request);
    case Call::kOpenSocket:
      co_return open_socket(request);
    case Call::kOpenTimer:
      co_return open_timer(request.head.fd, request.head.a);
    case Call::kClose:
      co_return co_await close(request.head.fd);
    default:
      break;
  }
  throw BadRequest("asked what the world does not know");
}

shim::Identity Process::identity(const ProgramThread& thread) const {
  return {.process = number_,
          .parent = parent_,
          .thread = thread.number,
          .address = around_.network.address(),
          .netmask = processes::kNetmask,
          .first_address = processes::kFirstAddress,
          .hosts = static_cast<std::uint32_t>(around_.network.hosts()),
          .has_card_clock = around_.host.nic() != nullptr ? 1U : 0U,
          .most_card_rate =
              around_.host.nic() != nullptr
                  ? static_cast<std::int32_t>(std::lround(around_.host.nic()->max_frequency_ppb()))
                  : 0,
          .has_pulse_line = around_.pulses.has_line() ? 1U : 0U,
          .cards = around_.network.cables().cards(),
          .carriers = around_.network.cables().carriers()};
}

Process::Answer Process::random_bytes(std::int64_t count) {
  if (count < 0 || count > static_cast<std::int64_t>(shim::kMostData)) {
    throw BadRequest("asked for too many random bytes");
  }
  Answer answer;
  answer.data.resize(static_cast<std::size_t>(count));
  for (std::byte& byte : answer.data) byte = static_cast<std::byte>(around_.chance.uniform() * 256);
  return answer;
}

Process::Answer Process::look_at_file(const ChildRequest& request) {
  const HostFiles::Seen seen = around_.files.look(read_head<shim::FileSight>(request.data));
  return {.value = seen.number, .data = bytes_of(seen.modified)};
}

Task<Process::Answer> Process::read_clock(std::int64_t clock, bool is_free) {
  if (clock == shim::kCardClock) {
    const CardClock::Reading card = co_await around_.card.read();
    co_return Answer{.value = card.sample.card, .error = card.error};
  }
  if (!is_known(clock)) co_return Answer{.error = EINVAL};
  const TrueTime asked = around_.host.true_now();
  if (is_free) {
    co_return Answer{.value = is_system(clock) ? epoch_ns(around_.host.system_clock().read(asked))
                                               : monotonic_ns(around_.host.steady_clock().now())};
  }
  std::int64_t reading = 0;
  if (is_system(clock)) {
    const HostTime now = co_await around_.host.clock().now();
    reading = epoch_ns(now);
  } else {
    reading = monotonic_ns(around_.host.steady_clock().now());
  }
  if (around_.host.true_now() == asked) co_await around_.host.sleep_for(kLeastReading);
  co_return Answer{.value = reading};
}

Task<Process::Answer> Process::set_clock(std::int64_t clock, std::int64_t reading) {
  if (reading < 0 || reading >= kLatestSetting) co_return Answer{.error = EINVAL};
  if (clock == shim::kCardClock) {
    const int error = co_await around_.card.set(reading);
    co_return Answer{.error = error};
  }
  if (clock != CLOCK_REALTIME) co_return Answer{.error = EINVAL};
  co_await around_.kernel.set(from_epoch_ns(reading));
  co_return Answer{};
}

Task<Process::Answer> Process::adjust_clock(ChildRequest request) {
  const auto wanted = read_head<timex>(request.data);
  if (request.head.a == shim::kCardClock) {
    const KernelClock::Answer card = co_await around_.card.adjust(wanted);
    co_return Answer{.value = card.state, .error = card.error, .data = bytes_of(card.now)};
  }
  if (request.head.a != CLOCK_REALTIME) co_return Answer{.error = EOPNOTSUPP};
  const KernelClock::Answer given = co_await around_.kernel.adjust(wanted);
  co_return Answer{.value = given.state, .error = given.error, .data = bytes_of(given.now)};
}

// The network card.

Task<Process::Answer> Process::read_card(std::int64_t count) {
  if (count < 0 || count > PTP_MAX_SAMPLES) throw BadRequest("asked for too many readings");
  Answer answer;
  for (std::int64_t i = 0; i < count; ++i) {
    const CardClock::Reading reading = co_await around_.card.read();
    if (reading.error != 0) co_return Answer{.error = reading.error};
    const Bytes sample = bytes_of(reading.sample);
    answer.data.insert(answer.data.end(), sample.begin(), sample.end());
  }
  co_return answer;
}

Process::Answer Process::card_stamping(std::int64_t wanted) {
  if (around_.host.nic() == nullptr) return {.error = EOPNOTSUPP};
  if (wanted >= 0) {
    around_.network.set_card_stamping(
        {.arrivals = (wanted & 1) != 0, .departures = (wanted & 2) != 0});
  }
  const CardStamping now = around_.network.card_stamping();
  return {.value = (now.arrivals ? 1 : 0) | (now.departures ? 2 : 0)};
}

// Timers.

Process::Answer Process::open_timer(int fd, std::int64_t clock) {
  if (open_.size() >= kMostOpen) return {.error = EMFILE};
  const bool is_of_timers = clock == CLOCK_REALTIME || clock == CLOCK_MONOTONIC ||
                            clock == CLOCK_BOOTTIME || clock == CLOCK_REALTIME_ALARM ||
                            clock == CLOCK_BOOTTIME_ALARM;
  if (!is_of_timers) return {.error = EINVAL};
  open(fd, ProcessTimer(around_.host, is_system(clock)));
  return {};
}

namespace {

shim::TimerSetting setting_in(const Bytes& data) {
  const auto setting = read_head<shim::TimerSetting>(data);
  if (setting.left < 0 || setting.interval < 0) throw BadRequest("set a timer to a negative time");
  return setting;
}

}  // namespace

Process::Answer Process::of_timer(const ChildRequest& request) {
  const std::shared_ptr<OpenObject> object = object_of(request.head.fd);
  if (object == nullptr || object->timer() == nullptr) {
    throw BadRequest("used a timer that it never opened");
  }
  ProcessTimer& timer = *object->timer();
  if (request.head.call == Call::kReadTimer) {
    const std::int64_t expirations = timer.take();
    return {.value = expirations, .error = expirations == 0 ? EAGAIN : 0};
  }
  const shim::TimerSetting before = timer.setting();
  if (request.head.call == Call::kSetTimer) {
    timer.set(setting_in(request.data), request.head.a != 0);
  }
  return {.data = bytes_of(before)};
}

Process::Answer Process::of_signal_timer(const ChildRequest& request) {
  const int number = request.head.fd;
  if (request.head.call == Call::kDropSignalTimer) {
    signal_timers_.erase(number);
    return {};
  }
  const auto found = signal_timers_.find(number);
  const bool exists = found != signal_timers_.end();
  const shim::TimerSetting before = exists ? found->second.setting() : shim::TimerSetting{};
  if (request.head.call == Call::kSetSignalTimer) {
    if (!exists && signal_timers_.size() >= kMostSignalTimers) return {.error = EAGAIN};
    ProcessTimer timer(around_.host, is_system(request.head.b));
    timer.set(setting_in(request.data), request.head.a != 0);
    signal_timers_.insert_or_assign(number, timer);
  }
  return {.data = bytes_of(before)};
}

bool Process::has_expirations() {
  return std::ranges::any_of(signal_timers_,
                             [](auto& timer) { return timer.second.expirations() > 0; });
}

Process::Answer Process::take_expirations() {
  Answer answer;
  for (auto& [number, timer] : signal_timers_) {
    const std::int64_t times = timer.take();
    if (times == 0) continue;
    constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();  // DELAYTIMER_MAX
    const shim::Expiration expiration{.timer = number,
                                      .times = static_cast<std::uint32_t>(std::min(times, kMost))};
    const Bytes bytes = bytes_of(expiration);
    answer.data.insert(answer.data.end(), bytes.begin(), bytes.end());
  }
  return answer;
}

}  // namespace simbench::sim

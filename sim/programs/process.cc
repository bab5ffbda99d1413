#include "sim/programs/process.h"

#include <fmt/format.h>
#include <linux/ptp_clock.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "recording/text_fields.h"

namespace simbench::sim {
namespace {

using clocks::kLatestSetting;
using shim::Call;

// What a reading of a clock takes where the scenario says less: a program may wait for a tick.
constexpr Nanoseconds kLeastReading(20);

constexpr std::size_t kMostSignalTimers = 64;
constexpr std::size_t kMostNote = 400;  // bytes of it in the row's note

bool is_system(std::int64_t clock) {
  return clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE || clock == CLOCK_TAI ||
         clock == CLOCK_REALTIME_ALARM;
}

}  // namespace

Process::Process(SimHost& host, HostNetwork& network, KernelClock& kernel, CardClock& card,
                 const Child::Settings& settings, std::uint32_t number)
    : host_(host),
      network_(network),
      kernel_(kernel),
      card_(card),
      number_(number),
      chance_(host.world().run_seed, host.name(fmt::format("program {}", number))),
      woken_(host.world().context, host.name(fmt::format("program {} waits", number))),
      child_(settings),
      counted_since_(host.true_now()) {
  network_.watch_local_activity(woken_);
}

Process::~Process() { close_sockets(); }

void Process::count_request() {
  constexpr Nanoseconds kASecond = std::chrono::seconds(1);
  if (host_.true_now() >= counted_since_ + kASecond) {
    counted_since_ = host_.true_now();
    asked_ = 0;
  }
  if (++asked_ > kMostASecond) {
    throw BadRequest(fmt::format("never waits: it asks more than {} times a second", kMostASecond));
  }
}

Task<void> Process::serve() {
  while (!is_stopped_) {
    std::optional<ChildRequest> request = child_.next();
    if (!request) break;
    std::optional<Answer> given;
    try {
      if (!request->is_whole) throw BadRequest("sent a request of a wrong size");
      count_request();
      given = co_await answer(std::move(*request));
    } catch (const BadRequest& bad) {
      ending_ = bad.what();
    }
    if (!given) break;
    const std::int32_t told = has_expirations() ? shim::kHasExpirations : 0;
    child_.reply(given->value, given->error | told, given->data);
  }
  if (!is_stopped_) {
    network_.report_local_activity();
    co_await close_streams();
    close_sockets();
  }
  const std::string how = child_.ending(ending_);
  if (!is_stopped_) ending_ = printable_name(how);
}

void Process::stop() {
  is_stopped_ = true;
  woken_.notify();
}

Task<Process::Answer> Process::answer(ChildRequest request) {
  if (is_of_stream(request)) co_return co_await of_stream(std::move(request));
  switch (request.head.call) {
    case Call::kReadClock:
      co_return co_await read_clock(request.head.a);
    case Call::kSetClock:
      co_return co_await set_clock(request.head.a, request.head.b);
    case Call::kAdjustClock:
      co_return co_await adjust_clock(std::move(request));
    case Call::kSend:
      co_return co_await send(std::move(request));
    case Call::kWait:
      co_return co_await wait(std::move(request));
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
      co_return of_socket(request);
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
      network_.report_local_activity();
      co_return Answer{};
    case Call::kHello:
      co_return Answer{.data = bytes_of(identity())};
    case Call::kRandom:
      co_return random_bytes(request.head.a);
    case Call::kOpenSocket:
      co_return open_socket(request);
    case Call::kOpenTimer:
      co_return open_timer(request.head.fd, request.head.a);
    case Call::kClose:
      co_return close(request.head.fd);
    case Call::kNote:
      throw BadRequest(std::string(reinterpret_cast<const char*>(request.data.data()),
                                   std::min(request.data.size(), kMostNote)));
  }
  throw BadRequest("asked what the world does not know");
}

shim::Identity Process::identity() const {
  return {.process = static_cast<std::int32_t>(100 + number_),
          .address = network_.address(),
          .netmask = processes::kNetmask,
          .first_address = processes::kFirstAddress,
          .hosts = static_cast<std::uint32_t>(network_.hosts()),
          .has_card_clock = host_.nic() != nullptr ? 1U : 0U,
          .most_card_rate =
              host_.nic() != nullptr
                  ? static_cast<std::int32_t>(std::lround(host_.nic()->max_frequency_ppb()))
                  : 0,
          .cards = network_.cables().cards(),
          .carriers = network_.cables().carriers()};
}

Process::Answer Process::random_bytes(std::int64_t count) {
  if (count < 0 || count > static_cast<std::int64_t>(shim::kMostData)) {
    throw BadRequest("asked for too many random bytes");
  }
  Answer answer;
  answer.data.resize(static_cast<std::size_t>(count));
  for (std::byte& byte : answer.data) byte = static_cast<std::byte>(chance_.uniform() * 256);
  return answer;
}

Task<Process::Answer> Process::read_clock(std::int64_t clock) {
  if (clock == shim::kCardClock) {
    const CardClock::Reading card = co_await card_.read();
    co_return Answer{.value = card.sample.card, .error = card.error};
  }
  if (clock < 0) co_return Answer{.error = EINVAL};
  const TrueTime asked = host_.true_now();
  std::int64_t reading = 0;
  if (is_system(clock)) {
    const HostTime now = co_await host_.clock().now();
    reading = epoch_ns(now);
  } else {
    reading = nanoseconds_of(host_.steady_clock().now());
  }
  if (host_.true_now() == asked) co_await host_.sleep_for(kLeastReading);
  co_return Answer{.value = reading};
}

Task<Process::Answer> Process::set_clock(std::int64_t clock, std::int64_t reading) {
  if (reading < 0 || reading >= kLatestSetting) co_return Answer{.error = EINVAL};
  if (clock == shim::kCardClock) {
    const int error = co_await card_.set(reading);
    co_return Answer{.error = error};
  }
  if (clock != CLOCK_REALTIME) co_return Answer{.error = EINVAL};
  co_await kernel_.set(from_epoch_ns(reading));
  co_return Answer{};
}

Task<Process::Answer> Process::adjust_clock(ChildRequest request) {
  const auto wanted = read_head<timex>(request.data);
  if (request.head.a == shim::kCardClock) {
    const KernelClock::Answer card = co_await card_.adjust(wanted);
    co_return Answer{.value = card.state, .error = card.error, .data = bytes_of(card.now)};
  }
  if (request.head.a != CLOCK_REALTIME) co_return Answer{.error = EOPNOTSUPP};
  const KernelClock::Answer given = co_await kernel_.adjust(wanted);
  co_return Answer{.value = given.state, .error = given.error, .data = bytes_of(given.now)};
}

// The network card.

Task<Process::Answer> Process::read_card(std::int64_t count) {
  if (count < 0 || count > PTP_MAX_SAMPLES) throw BadRequest("asked for too many readings");
  Answer answer;
  for (std::int64_t i = 0; i < count; ++i) {
    const CardClock::Reading reading = co_await card_.read();
    if (reading.error != 0) co_return Answer{.error = reading.error};
    const Bytes sample = bytes_of(reading.sample);
    answer.data.insert(answer.data.end(), sample.begin(), sample.end());
  }
  co_return answer;
}

Process::Answer Process::card_stamping(std::int64_t wanted) {
  if (host_.nic() == nullptr) return {.error = EOPNOTSUPP};
  if (wanted >= 0) {
    network_.set_card_stamping({.arrivals = (wanted & 1) != 0, .departures = (wanted & 2) != 0});
  }
  const CardStamping now = network_.card_stamping();
  return {.value = (now.arrivals ? 1 : 0) | (now.departures ? 2 : 0)};
}

// Timers.

Process::Answer Process::open_timer(int fd, std::int64_t clock) {
  if (open_descriptors() >= kMostOpen) return {.error = EMFILE};
  timers_.insert_or_assign(fd, ProcessTimer(host_, is_system(clock)));
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
  const auto found = timers_.find(request.head.fd);
  if (found == timers_.end()) throw BadRequest("used a timer that it never opened");
  ProcessTimer& timer = found->second;
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
    ProcessTimer timer(host_, is_system(request.head.b));
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

// Waits.

std::int16_t Process::readiness(const shim::Interest& interest) {
  if (const auto found = sockets_.find(interest.fd); found != sockets_.end()) {
    constexpr int kAlways = POLLERR | POLLHUP;
    return static_cast<std::int16_t>(readiness_of(found->second) & (interest.events | kAlways));
  }
  if (const auto found = streams_.find(interest.fd); found != streams_.end()) {
    constexpr int kAlways = POLLERR | POLLHUP;
    return static_cast<std::int16_t>(HostStreams::readiness(*found->second) &
                                     (interest.events | kAlways));
  }
  if (const auto found = timers_.find(interest.fd); found != timers_.end()) {
    return found->second.expirations() > 0 ? interest.events & POLLIN : 0;
  }
  return POLLNVAL;
}

std::optional<TrueTime> Process::next_timer(std::span<const shim::Interest> interests) {
  std::optional<TrueTime> next;
  const auto consider = [&next](const ProcessTimer& timer) {
    const std::optional<TrueTime> look = timer.next_look();
    if (look && (!next || *look < *next)) next = look;
  };
  for (const shim::Interest& interest : interests) {
    const auto found = timers_.find(interest.fd);
    if (found != timers_.end() && (interest.events & POLLIN) != 0) consider(found->second);
  }
  for (const auto& [number, timer] : signal_timers_) consider(timer);
  return next;
}

Task<Process::Answer> Process::wait(ChildRequest request) {
  std::vector<shim::Interest> interests(request.data.size() / sizeof(shim::Interest));
  if (!interests.empty()) {
    std::memcpy(interests.data(), request.data.data(), interests.size() * sizeof interests[0]);
  }
  const WakeTime deadline =
      wake_time(host_, static_cast<shim::Deadline>(request.head.a), request.head.b);
  const bool watches_real = (request.head.flags & shim::kWatchesReal) != 0;
  const std::uint64_t activity = network_.local_activity();
  for (;;) {
    std::int64_t ready = 0;
    for (shim::Interest& interest : interests) {
      interest.ready = readiness(interest);
      ready += interest.ready != 0;
    }
    if (ready > 0 || is_past(host_, deadline) || is_stopped_) {
      Answer answer{.value = ready};
      const auto bytes = std::as_bytes(std::span(interests));
      answer.data.assign(bytes.begin(), bytes.end());
      co_return answer;
    }
    const bool looks_again = watches_real && network_.local_activity() != activity;
    if (looks_again || has_expirations()) {
      co_return Answer{.error = looks_again ? EAGAIN : EINTR,
                       .data = bytes_of(left_ns(host_, deadline))};
    }
    std::optional<TrueTime> look = next_look(host_, deadline);
    const std::optional<TrueTime> timer = next_timer(interests);
    if (timer && (!look || *timer < *look)) look = timer;
    co_await woken_.wait(look);
  }
}

}  // namespace simbench::sim

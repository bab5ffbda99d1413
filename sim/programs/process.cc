#include "sim/programs/process.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "recording/text_fields.h"
#include "sim/programs/requests.h"

namespace simbench::sim {
namespace {

using shim::Call;
using shim::Deadline;

// What a reading of a clock takes where the scenario says less: a program may wait for a tick.
constexpr Nanoseconds kLeastReading(20);

// Times further away are never; sums of two of them still fit.
constexpr std::int64_t kFarthest = std::int64_t{1} << 61;

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
      child_(settings) {
  network_.watch_local_activity(woken_);
}

Process::~Process() { close_sockets(); }

void Process::count_request(Call call) {
  asked_at_once_ = call == Call::kWait && host_.true_now() > waited_ ? 0 : asked_at_once_ + 1;
  if (call == Call::kWait) waited_ = host_.true_now();
  if (asked_at_once_ > kMostAtOnce) throw BadRequest("never waits");
}

Task<void> Process::serve() {
  for (;;) {
    std::optional<ChildRequest> request = child_.next();
    if (!request) break;
    std::optional<Answer> given;
    try {
      count_request(request->head.call);
      given = co_await answer(std::move(*request));
    } catch (const BadRequest& bad) {
      ending_ = bad.what();
    }
    if (!given) break;
    child_.reply(given->value, given->error, given->data);
  }
  network_.report_local_activity();
  co_await close_streams();
  close_sockets();
  const std::string how = child_.ending();
  ending_ = printable_name(ending_.empty() ? how : ending_);
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
      co_return of_socket(request);
    case Call::kSetTimer:
    case Call::kQueryTimer:
    case Call::kReadTimer:
      co_return of_timer(request);
    case Call::kCardStamping:
      co_return card_stamping(request.head.a);
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
      co_return open_socket(request.head.fd, request.head.a);
    case Call::kOpenTimer:
      co_return open_timer(request.head.fd, request.head.a);
    case Call::kClose:
      co_return close(request.head.fd);
    case Call::kNote:
      throw BadRequest(
          std::string(reinterpret_cast<const char*>(request.data.data()), request.data.size()));
  }
  throw BadRequest("asked what the world does not know");
}

shim::Identity Process::identity() const {
  return {.process = static_cast<std::int32_t>(100 + number_),
          .address = network_.address(),
          .netmask = HostNetwork::kNetmask,
          .first_address = HostNetwork::kFirstAddress,
          .hosts = static_cast<std::uint32_t>(network_.hosts()),
          .has_card_clock = host_.nic() != nullptr ? 1U : 0U};
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
  if (reading < 0) co_return Answer{.error = EINVAL};
  if (clock == shim::kCardClock) {
    const int error = co_await card_.set(reading);
    co_return Answer{.error = error};
  }
  if (clock != CLOCK_REALTIME) co_return Answer{.error = EINVAL};
  co_await host_.clock().set(from_epoch_ns(reading));
  kernel_.was_set();
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

// Timers.

Process::Answer Process::open_timer(int fd, std::int64_t clock) {
  if (open_descriptors() >= kMostOpen) return {.error = EMFILE};
  timers_[fd] = {.is_system = is_system(clock)};
  return {};
}

std::int64_t Process::now_of(const Timer& timer) const {
  return timer.is_system ? epoch_ns(host_.system_clock().read(host_.true_now()))
                         : nanoseconds_of(host_.steady_clock().now());
}

void Process::expire(Timer& timer) const {
  if (timer.next == 0) return;
  const std::int64_t late = now_of(timer) - timer.next;
  if (late < 0) return;
  const std::int64_t times = timer.interval > 0 ? late / timer.interval + 1 : 1;
  timer.expirations += times;
  timer.next = timer.interval > 0 ? timer.next + times * timer.interval : 0;
}

Process::Answer Process::of_timer(const ChildRequest& request) {
  const auto found = timers_.find(request.head.fd);
  if (found == timers_.end()) throw BadRequest("used a timer that it never opened");
  Timer& timer = found->second;
  expire(timer);
  if (request.head.call == Call::kReadTimer) {
    const std::int64_t expirations = std::exchange(timer.expirations, 0);
    return {.value = expirations, .error = expirations == 0 ? EAGAIN : 0};
  }
  const shim::TimerSetting before{.left = timer.next == 0 ? 0 : timer.next - now_of(timer),
                                  .interval = timer.interval};
  if (request.head.call == Call::kSetTimer) {
    const auto wanted = read_head<shim::TimerSetting>(request.data);
    if (wanted.left < 0 || wanted.interval < 0) throw BadRequest("set a timer to a negative time");
    const std::int64_t left = std::min(wanted.left, kFarthest);
    const bool is_absolute = request.head.a != 0;
    timer.interval = std::min(wanted.interval, kFarthest);
    timer.expirations = 0;
    timer.next = left == 0 ? 0 : is_absolute ? left : now_of(timer) + left;
  }
  return {.data = bytes_of(before)};
}

// Waits.

std::int16_t Process::readiness(const shim::Interest& interest) {
  if (const auto found = sockets_.find(interest.fd); found != sockets_.end()) {
    const UdpSocket& socket = found->second;
    const int error = socket.departed.empty() ? 0 : POLLERR;
    const int urgent = error != 0 && socket.has_urgent_errors ? POLLPRI : 0;
    const int ready = (socket.arrived.empty() ? 0 : POLLIN) | POLLOUT | urgent;
    return static_cast<std::int16_t>((ready & interest.events) | error);
  }
  if (const auto found = streams_.find(interest.fd); found != streams_.end()) {
    constexpr int kAlways = POLLERR | POLLHUP;
    return static_cast<std::int16_t>(HostStreams::readiness(*found->second) &
                                     (interest.events | kAlways));
  }
  if (const auto found = timers_.find(interest.fd); found != timers_.end()) {
    expire(found->second);
    return found->second.expirations > 0 ? interest.events & POLLIN : 0;
  }
  return POLLNVAL;
}

namespace {

// A system clock may be set while a program waits for it.
constexpr Nanoseconds kLookAgain = std::chrono::seconds(1);

}  // namespace

std::optional<TrueTime> Process::look_at_system_time(std::int64_t at) const {
  const HostTime wanted = from_epoch_ns(at);
  const SystemClock& clock = host_.system_clock();
  if (wanted > clock.read(host_.true_now()) + kLookAgain) return host_.true_now() + kLookAgain;
  return clock.when(wanted, host_.true_now());
}

std::optional<TrueTime> Process::next_look(Deadline kind, std::int64_t at) const {
  switch (kind) {
    case Deadline::kNever:
      return std::nullopt;
    case Deadline::kAtSystemTime:
      return look_at_system_time(at);
    default:
      return host_.next_look(SteadyTime(Nanoseconds(at)));
  }
}

bool Process::is_past(Deadline kind, std::int64_t at) const {
  switch (kind) {
    case Deadline::kNever:
      return false;
    case Deadline::kAtSystemTime:
      return epoch_ns(host_.system_clock().read(host_.true_now())) >= at;
    default:
      return host_.is_past(SteadyTime(Nanoseconds(at)));
  }
}

std::optional<TrueTime> Process::next_timer(std::span<const shim::Interest> interests) {
  std::optional<TrueTime> next;
  for (const shim::Interest& interest : interests) {
    const auto found = timers_.find(interest.fd);
    if (found == timers_.end() || found->second.next == 0) continue;
    const Timer& timer = found->second;
    const Deadline kind = timer.is_system ? Deadline::kAtSystemTime : Deadline::kAtMonotonicTime;
    const std::optional<TrueTime> look = next_look(kind, timer.next);
    if (look && (!next || *look < *next)) next = look;
  }
  return next;
}

Task<Process::Answer> Process::wait(ChildRequest request) {
  std::vector<shim::Interest> interests(request.data.size() / sizeof(shim::Interest));
  if (!interests.empty()) {
    std::memcpy(interests.data(), request.data.data(), interests.size() * sizeof interests[0]);
  }
  auto kind = static_cast<Deadline>(request.head.a);
  std::int64_t at = std::clamp(request.head.b, std::int64_t{0}, kFarthest);
  if (kind == Deadline::kAfter) {
    at += nanoseconds_of(host_.steady_clock().now());
    kind = Deadline::kAtMonotonicTime;
  }
  const bool watches_real = (request.head.flags & shim::kWatchesReal) != 0;
  const std::uint64_t activity = network_.local_activity();
  for (;;) {
    std::int64_t ready = 0;
    for (shim::Interest& interest : interests) {
      interest.ready = readiness(interest);
      ready += interest.ready != 0;
    }
    if (ready > 0 || is_past(kind, at)) {
      Answer answer{.value = ready};
      const auto bytes = std::as_bytes(std::span(interests));
      answer.data.assign(bytes.begin(), bytes.end());
      co_return answer;
    }
    if (watches_real && network_.local_activity() != activity) {
      Answer answer{.value = shim::kLookAgain, .data = std::move(request.data)};
      const Bytes deadline = bytes_of(at);
      answer.data.insert(answer.data.end(), deadline.begin(), deadline.end());
      co_return answer;
    }
    std::optional<TrueTime> look = next_look(kind, at);
    const std::optional<TrueTime> timer = next_timer(interests);
    if (timer && (!look || *timer < *look)) look = timer;
    co_await woken_.wait(look);
  }
}

}  // namespace simbench::sim

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

namespace simbench::sim {
namespace {

using shim::Call;
using shim::Deadline;

// What a reading of a clock takes where the scenario says less: a program may wait for a tick.
constexpr Nanoseconds kLeastReading(20);

// Times further away are never; sums of two of them still fit.
constexpr std::int64_t kFarthest = std::int64_t{1} << 61;
constexpr std::size_t kMostDescriptors = 1024;
constexpr std::size_t kMostNote = 400;  // bytes of it in the row's note

// Linux sets no clock later than that, so that 30 years can follow.
constexpr std::int64_t kLatestSetting = INT64_MAX - 30 * 365 * 86'400 * kSecondNs;

class BadRequest : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

bool is_system(std::int64_t clock) {
  return clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE || clock == CLOCK_TAI ||
         clock == CLOCK_REALTIME_ALARM;
}

template <class T>
Bytes bytes_of(const T& value) {
  const auto bytes = std::as_bytes(std::span(&value, 1));
  return {bytes.begin(), bytes.end()};
}

template <class T>
T read_head(const Bytes& data) {
  if (data.size() < sizeof(T)) throw BadRequest("too little data");
  T value{};
  std::memcpy(&value, data.data(), sizeof value);
  return value;
}

}  // namespace

Process::Process(SimHost& host, HostNetwork& network, KernelClock& kernel,
                 const Child::Settings& settings, std::uint32_t number)
    : host_(host),
      network_(network),
      kernel_(kernel),
      number_(number),
      chance_(host.world().run_seed, host.name(fmt::format("program {}", number))),
      woken_(host.world().context, host.name(fmt::format("program {} waits", number))),
      child_(settings) {}

Process::~Process() {
  for (auto& [fd, socket] : sockets_) network_.close(socket);
}

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
  for (;;) {
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
    child_.reply(given->value, given->error, given->data);
  }
  ending_ = printable_name(child_.ending(ending_));
}

Task<Process::Answer> Process::answer(ChildRequest request) {
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
      co_return of_socket(request);
    case Call::kSetTimer:
    case Call::kQueryTimer:
    case Call::kReadTimer:
      co_return of_timer(request);
    case Call::kHello:
      co_return Answer{.data = bytes_of(identity())};
    case Call::kRandom:
      co_return random_bytes(request.head.a);
    case Call::kOpenSocket:
      co_return open_socket(request.head.fd);
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
  return {.process = static_cast<std::int32_t>(100 + number_), .address = network_.address()};
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
  if (clock < 0) co_return Answer{.error = EOPNOTSUPP};
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
  if (clock != CLOCK_REALTIME) co_return Answer{.error = clock < 0 ? EOPNOTSUPP : EINVAL};
  if (reading < 0 || reading >= kLatestSetting) co_return Answer{.error = EINVAL};
  co_await host_.clock().set(from_epoch_ns(reading));
  kernel_.was_set();
  co_return Answer{};
}

Task<Process::Answer> Process::adjust_clock(ChildRequest request) {
  if (request.head.a != CLOCK_REALTIME) co_return Answer{.error = EOPNOTSUPP};
  const auto wanted = read_head<timex>(request.data);
  const KernelClock::Answer given = co_await kernel_.adjust(wanted);
  co_return Answer{.value = given.state, .error = given.error, .data = bytes_of(given.now)};
}

// Sockets.

UdpSocket& Process::socket_of(int fd) {
  const auto found = sockets_.find(fd);
  if (found == sockets_.end()) throw BadRequest("used a socket that it never opened");
  return found->second;
}

Process::Answer Process::open_socket(int fd) {
  if (sockets_.size() + timers_.size() >= kMostDescriptors) return {.error = EMFILE};
  UdpSocket& socket = sockets_[fd];
  network_.close(socket);  // one that was left open under this number
  socket = {};
  socket.on_arrival = [this] { woken_.notify(); };
  return {};
}

Process::Answer Process::close(int fd) {
  if (const auto found = sockets_.find(fd); found != sockets_.end()) {
    network_.close(found->second);
    sockets_.erase(found);
  }
  timers_.erase(fd);
  return {};
}

Process::Answer Process::of_socket(const ChildRequest& request) {
  UdpSocket& socket = socket_of(request.head.fd);
  switch (request.head.call) {
    case Call::kBind:
      return {.error = network_.bind(socket, read_head<shim::Address>(request.data))};
    case Call::kConnect:
      return {.error = network_.connect(socket, read_head<shim::Address>(request.data))};
    case Call::kName:
      return {.data = bytes_of(socket.local)};
    case Call::kPeerName:
      if (!socket.peer) return {.error = ENOTCONN};
      return {.data = bytes_of(*socket.peer)};
    case Call::kReceive:
      return receive(socket, request.head.a);
    default:
      return set_option(socket, static_cast<shim::SocketOption>(request.head.a),
                        request.head.b != 0);
  }
}

Process::Answer Process::set_option(UdpSocket& socket, shim::SocketOption option, bool on) {
  switch (option) {
    case shim::SocketOption::kReceiveStamps:
      socket.stamps_arrivals = on;
      return {};
    case shim::SocketOption::kTransmitStamps:
      socket.stamps_departures = on;
      return {};
  }
  return {.error = ENOPROTOOPT};
}

Process::Answer Process::receive(UdpSocket& socket, std::int64_t how) {
  std::deque<QueuedDatagram>& queue = (how & 1) != 0 ? socket.departed : socket.arrived;
  if (queue.empty()) return {.error = EAGAIN};
  Answer answer{.data = bytes_of(queue.front().arrival)};
  const Bytes& payload = queue.front().payload;
  answer.data.insert(answer.data.end(), payload.begin(), payload.end());
  if ((how & 2) == 0) queue.pop_front();
  return answer;
}

Task<Process::Answer> Process::send(ChildRequest request) {
  UdpSocket& socket = socket_of(request.head.fd);
  const auto to = read_head<shim::Address>(request.data);
  Bytes payload(request.data.begin() + sizeof to, request.data.end());
  const int error = co_await network_.send(socket, to, std::move(payload));
  co_return Answer{.error = error};
}

// Timers.

Process::Answer Process::open_timer(int fd, std::int64_t clock) {
  if (sockets_.size() + timers_.size() >= kMostDescriptors) return {.error = EMFILE};
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
    const int ready =
        (socket.arrived.empty() ? 0 : POLLIN) | POLLOUT | (socket.departed.empty() ? 0 : POLLPRI);
    const int error = socket.departed.empty() ? 0 : POLLERR;
    return static_cast<std::int16_t>((ready & interest.events) | error);
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
    const bool is_awaited = (interest.events & POLLIN) != 0;
    if (!is_awaited || found == timers_.end() || found->second.next == 0) continue;
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
    std::optional<TrueTime> look = next_look(kind, at);
    const std::optional<TrueTime> timer = next_timer(interests);
    if (timer && (!look || *timer < *look)) look = timer;
    co_await woken_.wait(look);
  }
}

}  // namespace simbench::sim

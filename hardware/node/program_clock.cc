#include "hardware/node/program_clock.h"

#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <stdexcept>
#include <string>

#include "hardware/net/notice.h"
#include "processes/requests.h"

namespace simbench::hardware {
namespace {

using processes::BadRequest;
using processes::bytes_of;
using processes::read_head;
using shim::Call;

constexpr std::size_t kMostNote = 400;

std::int64_t now_reads(const SoftwareClock& clock) {
  return nanoseconds_of(clock.system_at(monotonic_now()));
}

}  // namespace

ProgramClock::ProgramClock(const boost::asio::any_io_executor& executor, SoftwareClock& clock)
    : clock_(clock),
      memory_(memfd_create("clock", MFD_CLOEXEC)),
      kernel_(now_reads(clock)),
      next_second_(executor) {
  void* mapped = MAP_FAILED;
  if (memory_.good() && ftruncate(memory_.number(), sizeof(shim::ClockPage)) == 0) {
    mapped = mmap(nullptr, sizeof(shim::ClockPage), PROT_READ | PROT_WRITE, MAP_SHARED,
                  memory_.number(), 0);
  }
  if (mapped == MAP_FAILED) throw std::runtime_error("no memory for the programs' clock");
  page_ = new (mapped) shim::ClockPage{};
  publish(monotonic_now());
}

ProgramClock::~ProgramClock() { munmap(page_, sizeof(shim::ClockPage)); }

void ProgramClock::publish(MonotonicTime since) {
  const double against_steady = 1 + clock_.present(since).rate_ppb * 1e-9;
  const double against_monotonic = 1 + clock_.oscillator().skew_ppm * 1e-6;
  shim::add_setting(*page_, {.since = nanoseconds_of(since),
                             .reads = nanoseconds_of(clock_.system_at(since)),
                             .rate = against_steady * against_monotonic - 1});
}

ProgramClock::Answer ProgramClock::answer(const processes::ChildRequest& request) {
  if (!request.is_whole) throw BadRequest("sent a request of a wrong size");
  switch (request.head.call) {
    case Call::kHello:
      return {.data = bytes_of(shim::Identity{.only_clock = 1})};
    case Call::kSetClock:
      return set(request.head.a, request.head.b);
    case Call::kAdjustClock:
      return adjust(request);
    case Call::kNote:
      throw BadRequest(std::string(reinterpret_cast<const char*>(request.data.data()),
                                   std::min(request.data.size(), kMostNote)));
    default:
      throw BadRequest("asked for more than the clock");
  }
}

ProgramClock::Answer ProgramClock::set(std::int64_t clock, std::int64_t reading) {
  if (clock != CLOCK_REALTIME || reading < 0 || reading >= clocks::kLatestSetting) {
    return {.error = EINVAL};
  }
  clock_.call([&](SoftwareClock::Steered& steered) {
    steered.set(reading);
    kernel_.forget(steered);
    publish(steered.at());
  });
  next_second_.cancel();
  return {};
}

ProgramClock::Answer ProgramClock::adjust(const processes::ChildRequest& request) {
  const auto wanted = read_head<timex>(request.data);
  if (request.head.a != CLOCK_REALTIME) return {.error = EOPNOTSUPP};
  timex now = wanted;
  const int refusal = clocks::KernelDiscipline::refusal(wanted);
  const long adjtime_before_us = kernel_.adjtime_left_us();
  const SoftwareClock::Steer apply = [&](SoftwareClock::Steered& steered) {
    kernel_.apply(wanted, steered);
    publish(steered.at());
  };
  if (refusal == 0 && kernel_.changes_clock(wanted)) {
    clock_.call(apply);
  } else if (refusal == 0) {
    clock_.steer(apply);
  }
  next_second_.cancel();
  const int state = kernel_.read(now_reads(clock_), wanted, adjtime_before_us, now);
  return {.value = state, .error = refusal, .data = bytes_of(now)};
}

Task<void> ProgramClock::run() {
  for (;;) {
    next_second_.expires_at(boost::asio::steady_timer::time_point::max());
    if (kernel_.is_moving()) {
      const HostTime at(Nanoseconds(kernel_.next_second_ns()));
      next_second_.expires_at(for_timer(clock_.when(at, monotonic_now())));
    }
    co_await ended(next_second_);
    clock_.steer([this](SoftwareClock::Steered& steered) {
      const std::int64_t second = kernel_.next_second_ns();
      kernel_.move_on(steered);
      if (kernel_.next_second_ns() != second) publish(steered.at());
    });
  }
}

}  // namespace simbench::hardware

#include "sim/programs/kernel_clock.h"

namespace simbench::sim {
namespace {

// The host's clock at an instant.
class Steered final : public clocks::AdjustedClock {
 public:
  Steered(SystemClock& clock, TrueTime at) : clock_(clock), at_(at) {}

  std::int64_t epoch_ns() const override { return sim::epoch_ns(clock_.read(at_)); }
  void leap(Nanoseconds offset) override { clock_.leap(at_, offset); }
  void adjust_frequency(double ppb) override { clock_.adjust_frequency(at_, ppb); }

 private:
  SystemClock& clock_;
  TrueTime at_;
};

}  // namespace

KernelClock::KernelClock(SimHost& host)
    : host_(host),
      changed_(host.world().context, host.name("kernel: next second")),
      steered_(host.world().context, host.name("kernel: first steering")),
      kernel_(epoch_ns(host.system_clock().read(host.true_now()))) {}

Task<void> KernelClock::run() {
  SystemClock& clock = host_.system_clock();
  for (;;) {
    std::optional<TrueTime> next;
    if (kernel_.is_moving()) {
      next = clock.when(from_epoch_ns(kernel_.next_second_ns()), host_.true_now());
    }
    co_await changed_.wait(next);
    Steered steered(clock, host_.true_now());
    kernel_.move_on(steered);
  }
}

Task<void> KernelClock::until_steered(std::optional<TrueTime> limit) {
  while (!was_steered() && !(limit && host_.true_now() >= *limit)) co_await steered_.wait(limit);
}

Task<KernelClock::Answer> KernelClock::adjust(timex request) {
  Answer answer{.error = clocks::KernelDiscipline::refusal(request), .now = request};
  const long adjtime_before_us = kernel_.adjtime_left_us();
  const ClockPort::Apply change = [this, &request](SystemClock& clock, TrueTime at) {
    Steered steered(clock, at);
    kernel_.apply(request, steered);
    changed_.notify();
    if (was_steered()) steered_.notify();
  };
  if (answer.error == 0 && kernel_.changes_clock(request)) {
    co_await host_.clock().change(change);
  } else if (answer.error == 0) {
    change(host_.system_clock(), host_.true_now());
  }
  const HostTime reading = co_await host_.clock().now();
  Steered steered(host_.system_clock(), host_.true_now());
  kernel_.move_on(steered);
  answer.state = kernel_.read(epoch_ns(reading), request, adjtime_before_us, answer.now);
  co_return answer;
}

Task<void> KernelClock::set(HostTime reading) {
  const HostTime rounded = host_.clock_interface().set_to(reading);
  const ClockPort::Apply change = [this, rounded](SystemClock& clock, TrueTime at) {
    clock.set(at, rounded);
    Steered steered(clock, at);
    kernel_.forget(steered);
    changed_.notify();
    steered_.notify();
  };
  co_await host_.clock().change(change);
}

}  // namespace simbench::sim

// A node's own clock over the kernel's monotonic clock: what a node disciplines by default.
//
// It changes nothing of the operating system. It begins at the operating system's clock (plus an
// offset, for nodes of tests), at rate 0, and runs on by itself (clocks/disciplined_clock.h has the
// semantics of adjustments and the precision).
//
// Calls of HostClock do not suspend: they act on the present instant. In tests a change may cost
// time, as the operating system's call does where it is slow: the thread is blocked for so long,
// and the change counts after a part of that. A timer of `context` notifies
// the observer of the planned end of a slew; observe(nullptr) ends that timer, so that the context
// can run out of work.
//
//   SoftwareClock clock(context, {.host = 3});
//   SoftwareClock skewed(context, {.host = 3,
//                                  .oscillator = {monotonic_now(), SteadyTime{}, 30},
//                                  .offset = from_ms(-300)});
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <cstdint>
#include <functional>

#include "clocks/disciplined_clock.h"
#include "clocks/kernel_discipline.h"
#include "hardware/clock/node_clock.h"

namespace simbench::hardware {

class SoftwareClock : public NodeClock {
 public:
  // What a change costs in tests, each time anew, and the share of it after which it counts.
  struct SetCost {
    double cost_ms = 0;
    double log_sigma = 0;  // factor exp(N(0, this))
    double effective_fraction = 0;
  };

  struct Settings {
    std::uint32_t host = 0;     // under which adjustments are reported
    NodeOscillator oscillator;  // of tests; the default is the kernel's own
    Nanoseconds offset{};       // of tests: ahead of the operating system's clock at the beginning
    SetCost set_cost{};
    std::function<HostTime()> system_clock = read_system_clock;
  };

  // The clock at the instant of a change, as a kernel steers it.
  class Steered final : public clocks::AdjustedClock {
   public:
    std::int64_t epoch_ns() const override;
    void leap(Nanoseconds offset) override;
    void adjust_frequency(double ppb) override;
    void set(std::int64_t epoch_ns);
    MonotonicTime at() const { return at_; }

   private:
    friend class SoftwareClock;
    Steered(SoftwareClock& clock, MonotonicTime at) : clock_(clock), at_(at) {}
    SoftwareClock& clock_;
    MonotonicTime at_;
  };
  using Steer = std::function<void(Steered&)>;

  // The context must not run after the clock has gone.
  SoftwareClock(boost::asio::io_context& context, Settings settings);
  ~SoftwareClock() override = default;
  SoftwareClock(const SoftwareClock&) = delete;
  SoftwareClock& operator=(const SoftwareClock&) = delete;

  Task<HostTime> now() override;
  Task<void> set(HostTime value) override;
  Task<void> adjust_frequency(double ppb) override;
  Task<void> slew(Nanoseconds offset, double max_rate_ppb) override;

  // What a system call does to the clock (clocks/kernel_discipline.h): it costs what changes cost.
  void call(const Steer& steer);
  // What the kernel does by itself.
  void steer(const Steer& steer);

  const NodeOscillator& oscillator() const override { return clock_.oscillator(); }
  HostTime system_at(MonotonicTime at) const override { return clock_.read(at); }
  MonotonicTime when(HostTime at, MonotonicTime now) const override { return clock_.when(at, now); }
  ClockAdjustment present(MonotonicTime now) const override { return clock_.present(now); }
  void observe(Observer observer) override;
  void restart() override;

 private:
  using Clock = clocks::DisciplinedClock<NodeOscillator>;

  template <class Change>
  void change(const Change& apply);
  void settle_in_time();

  Settings settings_;
  Clock clock_;
  boost::random::mt19937_64 costs_;
  bool observed_ = false;
  boost::asio::steady_timer settle_timer_;
};

}  // namespace simbench::hardware

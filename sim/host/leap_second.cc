#include "sim/host/leap_second.h"

namespace simbench::sim {

Task<void> take_leap_second(scenarios::LeapSecond fault, HostTime zero, SimHost& host,
                            SystemClock& clock) {
  const double second_ms = fault.inserted ? -1e3 : 1e3;
  co_await host.sleep_until(zero + from_ms(fault.at_ms));
  if (fault.smear_ms == 0) {
    clock.leap(host.true_now(), from_ms(second_ms));
    co_return;
  }
  clock.smear(host.true_now(), second_ms / fault.smear_ms * 1e9);
  co_await host.sleep_for(from_ms(fault.smear_ms));
  clock.smear(host.true_now(), 0);
}

}  // namespace simbench::sim

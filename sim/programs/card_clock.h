// The clock of the network card as programs have it (/dev/ptp0): what its driver does.
//
// One for each host, shared by its programs. Calls take the time that the scenario says. Readings
// count from the programs' epoch (sim/programs/kernel_clock.h), within an hour at first.
//
//   ADJ_FREQUENCY    rate = freq / 65536 ppm; ERANGE beyond 62 499 999 ppb
//   ADJ_SETOFFSET    a step, in microseconds or (ADJ_NANO) nanoseconds
//   nothing          freq is the rate in use
// The first of these counts where several modes are set; others are EOPNOTSUPP, and so is all where
// the card has no clock. The clock state is always 0.
//
// Source: clock_adjtime(2); Linux' Documentation/driver-api/ptp.rst.
//
//   CardClock card(host);
//   const CardClock::Reading reading = co_await card.read();
//   timex request{};
//   request.modes = ADJ_FREQUENCY;
//   const KernelClock::Answer answer = co_await card.adjust(request);
#pragma once

#include <cstdint>

#include "shim/protocol.h"
#include "sim/host/sim_host.h"
#include "sim/programs/kernel_clock.h"

namespace simbench::sim {

class CardClock {
 public:
  struct Reading {
    int error = 0;  // an errno
    shim::CardSample sample{};
  };

  // The host must outlive this.
  explicit CardClock(SimHost& host) : host_(host) {}

  Task<Reading> read();
  // An errno, or 0.
  Task<int> set(std::int64_t ns);
  Task<KernelClock::Answer> adjust(timex request);

 private:
  // An errno, or 0.
  int refusal(const timex& request) const;

  SimHost& host_;
  long frequency_ = 0;  // 2^-16 ppm
};

}  // namespace simbench::sim

// A leap second on one host: its system clock takes it when it reads the instant itself.
//
// A clock that is off takes it early or late by its offset, so between two hosts there is an error
// of a second for as long. It steps by a second, as kernels do, or spreads it evenly over smear_ms
// of its oscillator's time. Programs are not told; their settings and slews go on meanwhile.
//
// Source: scenario /faults (leap_second); RFC 8633 section 3.7 (leap seconds, smearing).
//
//   boost::asio::co_spawn(context, take_leap_second(leap, zero, host, leaping_clock),
//                         boost::asio::detached);
#pragma once

#include "algorithms/ports/host.h"
#include "scenarios/scenario.h"
#include "sim/clock/system_clock.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {

// `zero` is the reading from which the fault's time counts. The references must outlive the task.
Task<void> take_leap_second(scenarios::LeapSecond fault, HostTime zero, SimHost& host,
                            SystemClock& clock);

}  // namespace simbench::sim

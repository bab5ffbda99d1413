// The clock of the program's host where that alone is the world's, and all else is the machine's:
// shim::Identity::only_clock. It is read from a page of memory (shim/clock_page.h); settings and
// adjustments ask the world as ever.
//
// The kernel stamps datagrams with the machine's CLOCK_REALTIME. A stamp becomes what the own clock
// read at that instant, right to some 0.1 us; one from before a step of the machine's clock is
// wrong by the step.
//
//   std::int64_t reading_ns = 0;
//   if (is_own_clock(CLOCK_REALTIME)) reading_ns = own_time();
//   const std::int64_t then_ns = own_time_at({.tv_sec = 1'800'000'000, .tv_nsec = 0});
#pragma once

#include <sys/socket.h>
#include <time.h>

#include <cstdint>

namespace simbench::shim {

// Once, before any other of these.
void open_own_clock();

// Whether the world has nothing but the clock, and this is it.
bool is_own_clock(clockid_t clock);
// What it reads now, and what it read when the machine's CLOCK_REALTIME did.
std::int64_t own_time();
std::int64_t own_time_at(const timespec& machine_time);

// The machine's clocks.
int read_machine_clock(clockid_t clock, timespec* time);

// Sleeps until the own clock has this reading, also if it is set meanwhile: returns 0 or EINTR.
int sleep_until_own_time(std::int64_t reading);
// The time on CLOCK_MONOTONIC at which it will have this reading, if it is not adjusted.
timespec machine_time_of(const timespec& reading);

// Replaces the stamps in a received message's control data.
void convert_stamps(msghdr& message);

}  // namespace simbench::shim

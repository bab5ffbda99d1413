// The line with a pulse per second, /dev/pps0, as a descriptor of the simulated world: the requests
// of <linux/pps.h>, by which RFC 2783's time_pps_fetch() and its kin are made.
//
// A fetch with a time waits for the next pulse of simulated time, and fails with ETIMEDOUT or,
// after a handler, EINTR. poll() is ready at the first pulse after the last fetch. There are no
// clear events and no kernel consumer (PPS_KC_BIND: EOPNOTSUPP).
//
//   const int fd = open("/dev/pps0", O_RDWR);
//   pps_fdata fetched{};
//   fetched.timeout = {.sec = 2, .nsec = 0, .flags = 0};
//   const int result = pulse_ioctl(fd, PPS_FETCH, &fetched);
#pragma once

namespace simbench::shim {

int pulse_ioctl(int fd, unsigned long what, void* argument);

}  // namespace simbench::shim

// Kernel stamps of what a socket receives, and none of what it sends: a relay wants no error queue
// to drain. Read with net/kernel_stamps.h. False if the kernel has none.
#ifndef SIMBENCH_HARDWARE_RELAY_RECEIVE_STAMPS_H_
#define SIMBENCH_HARDWARE_RELAY_RECEIVE_STAMPS_H_

#include <linux/net_tstamp.h>
#include <sys/socket.h>

namespace simbench::hardware {

inline bool request_receive_stamps(int socket) {
  const unsigned flags = SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE;
  return setsockopt(socket, SOL_SOCKET, SO_TIMESTAMPING, &flags, sizeof flags) == 0;
}

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_RELAY_RECEIVE_STAMPS_H_

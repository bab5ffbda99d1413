// ioctl(): of the network's interfaces, of devices, and of the world's sockets.
#include <errno.h>
#include <fcntl.h>
#include <linux/sockios.h>
#include <stdarg.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "shim/card.h"
#include "shim/descriptor_errors.h"
#include "shim/interfaces.h"
#include "shim/link.h"
#include "shim/pulses.h"

namespace simbench::shim {
namespace {

int real_ioctl(int fd, unsigned long what, void* argument) {
  return static_cast<int>(syscall(SYS_ioctl, fd, what, argument));
}

// What the next read of a socket would give.
int count_input(int fd, int& count) {
  const std::int64_t size = ask({.call = Call::kCountInput, .fd = fd});
  if (size < 0) return -1;
  count = static_cast<int>(size);
  return 0;
}

// Requests that descriptors of any kind have.
bool is_of_any(unsigned long what) {
  return what == FIOCLEX || what == FIONCLEX || what == FIONBIO || what == FIOASYNC;
}

}  // namespace

SIMBENCH_CALL int ioctl(int fd, unsigned long what, ...) {
  va_list arguments;
  va_start(arguments, what);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  if (!is_simulated()) {
    const bool asks_for_stamp = what == SIOCGSTAMP_OLD || what == SIOCGSTAMPNS_OLD;
    if (has_world() && asks_for_stamp) give_up("ioctl() SIOCGSTAMP");
    return real_ioctl(fd, what, argument);
  }
  const Kind kind = kind_of(fd);
  const bool is_of_world = kind == Kind::kSocket || kind == Kind::kStream;
  if (is_about_interfaces(what)) {
    const bool is_any_socket = is_of_world || kind == Kind::kNetlink || kind == Kind::kLocal;
    return is_any_socket ? interface_ioctl(what, argument) : refuse_descriptor(fd, ENOTTY);
  }
  if (kind == Kind::kCard && !is_of_any(what)) return card_ioctl(fd, what, argument);
  if (kind == Kind::kPulses && !is_of_any(what)) return pulse_ioctl(fd, what, argument);
  if (is_of_world && what == FIONREAD) return count_input(fd, *static_cast<int*>(argument));
  if (is_of_world && what == SIOCOUTQ) {
    *static_cast<int*>(argument) = 0;  // what is sent has left
    return 0;
  }
  // The rest, FIONBIO among it, is the descriptor's own.
  return real_ioctl(fd, what, argument);
}

}  // namespace simbench::shim

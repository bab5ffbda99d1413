#include "shim/senders.h"

#include "shim/children.h"
#include "shim/link.h"
#include "shim/protocol.h"

namespace simbench::shim {
namespace {

bool is_by_process(int code) { return code == SI_USER || code == SI_TKILL || code == SI_QUEUE; }

}  // namespace

void show_sender(siginfo_t& info) {
  const bool is_of_child = info.si_signo == SIGCHLD && info.si_code > 0;
  if (info.si_code == kByWorld || info.si_code == kQueuedByWorld) {
    info.si_code = info.si_code == kByWorld ? SI_USER : SI_QUEUE;
  } else if (is_by_process(info.si_code) || is_of_child) {
    info.si_pid = number_of_process(info.si_pid);
    info.si_uid = 0;
  }
  if (!is_of_child) return;
  info.si_utime = 0;
  info.si_stime = 0;
}

void show_sender(signalfd_siginfo& info) {
  const bool is_of_child = info.ssi_signo == SIGCHLD && info.ssi_code > 0;
  if (info.ssi_code == kByWorld || info.ssi_code == kQueuedByWorld) {
    info.ssi_code = info.ssi_code == kByWorld ? SI_USER : SI_QUEUE;
  } else if (is_by_process(info.ssi_code) || is_of_child) {
    info.ssi_pid = static_cast<std::uint32_t>(number_of_process(static_cast<pid_t>(info.ssi_pid)));
    info.ssi_uid = 0;
  }
  if (!is_of_child) return;
  info.ssi_utime = 0;
  info.ssi_stime = 0;
}

}  // namespace simbench::shim

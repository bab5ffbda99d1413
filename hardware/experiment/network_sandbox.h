// Network namespaces for processes of one machine, joined by veth pairs to a hub: a rig's network
// that changes nothing outside and ends with its processes.
//
//   hub (this thread's namespace)                    member i's own namespace
//   hub_address(i) 10.77.i.1 --- veth "hub<i>" ... "eth0" --- member_address(i) 10.77.i.2
//
//   hub: veth "wire<i>", without an address ... "eth1", 10.0.0.(1 + i) in 10.0.0.0/16
//
// The wire is for members that run programs (docs/your_program.md): a network of their own, with
// the addresses of the simulated one, over which they all are neighbours as far as somebody in the
// hub carries frames from wire to wire (hardware/relay/wires.h). Its members may take ports below
// 1024 without rights.
//
// Members reach the hub only, not each other. All is set up by netlink and ioctl, without other
// programs; the kernel removes a pair when its namespace ends.
//
// Contract
//  - enter() moves the calling thread, and all threads and processes that it starts later, into a
//    fresh namespace for good: call it before there are other threads. An ordinary user also needs
//    a fresh user namespace, which the kernel gives only to processes of one thread. Where that is
//    not permitted it returns the reason and nothing has changed.
//  - leave_hub() is for the member's own process, between fork() and exec(): async-signal-safe.
//  - connect() is called in the hub once the member has left it.
//
// Errors: SandboxError.
//
// Source: namespaces(7), veth(4), rtnetlink(7), netdevice(7).
#pragma once

#include <sys/types.h>

#include <optional>
#include <stdexcept>
#include <string>

namespace simbench::hardware {

class SandboxError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class NetworkSandbox {
 public:
  static constexpr unsigned kMaxMembers = 250;

  // Nothing if the thread is in a fresh namespace now; else the reason why not.
  static std::optional<std::string> enter();

  static std::string hub_address(unsigned member);
  static std::string member_address(unsigned member);
  // The hub's side of a member's wire.
  static std::string wire(unsigned member);
  static constexpr const char* kWireInterface = "eth1";  // the member's side

  // In the member's process: moves it into a namespace of its own. False: not permitted.
  static bool leave_hub();
  // In the hub: makes a pair to the process's namespace and sets the hub's side up. Removes the
  // pair of an earlier member of that number. Throws for a member that is not below kMaxMembers.
  static void connect(unsigned member, pid_t process);
  // Connects the member with the wire in the same way.
  static void connect_wire(unsigned member, pid_t process);
  // In the member's process, after connect(): sets its side up. False: it failed.
  static bool set_up_member(unsigned member);
  static bool set_up_wire(unsigned member);
};

}  // namespace simbench::hardware

// What a descriptor of a simulated program stands for: a socket, a timer, a set of epoll(), a
// device. Copies of the descriptor share it, in the program and in the processes that it forks.
//
// changed() is called by whoever makes it ready: sets of epoll() that watch it are told
// (sim/programs/epoll_set.h). Timers change by themselves: they are looked at.
//
//   auto object = std::make_shared<OpenObject>(UdpSocket{});
//   object->changed(POLLIN);
//   if ((readiness(*object) & POLLIN) != 0) print("data");
#pragma once

#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "sim/programs/host_network.h"
#include "sim/programs/host_streams.h"
#include "sim/programs/process_timers.h"
#include "sim/programs/pulse_devices.h"

namespace simbench::sim {

class EpollSet;

class OpenObject {
 public:
  using What = std::variant<UdpSocket, std::shared_ptr<StreamSocket>, ProcessTimer,
                            std::shared_ptr<EpollSet>, std::shared_ptr<DeviceFile>>;

  explicit OpenObject(What what);
  ~OpenObject();
  OpenObject(const OpenObject&) = delete;
  OpenObject& operator=(const OpenObject&) = delete;

  // Null if it is something else.
  UdpSocket* socket() { return std::get_if<UdpSocket>(&what_); }
  StreamSocket* stream() { return stream_pointer().get(); }
  std::shared_ptr<StreamSocket> stream_pointer() {
    const auto* found = std::get_if<std::shared_ptr<StreamSocket>>(&what_);
    return found != nullptr ? *found : nullptr;
  }
  ProcessTimer* timer() { return std::get_if<ProcessTimer>(&what_); }
  EpollSet* set() {
    const auto* found = std::get_if<std::shared_ptr<EpollSet>>(&what_);
    return found != nullptr ? found->get() : nullptr;
  }
  DeviceFile* device() {
    const auto* found = std::get_if<std::shared_ptr<DeviceFile>>(&what_);
    return found != nullptr ? found->get() : nullptr;
  }

  // It may be ready for these events of poll(). `depth`: how many sets within sets.
  void changed(int events, int depth = 0);
  // Until the watcher is gone.
  void watch(const std::weak_ptr<OpenObject>& set);

 private:
  What what_;
  std::vector<std::weak_ptr<OpenObject>> watchers_{};  // sets
};

// The events of poll() that it is ready for, as bits.
int readiness(OpenObject& object);

}  // namespace simbench::sim

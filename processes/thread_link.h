// The world's end of the link of one thread of a program (shim/protocol.h).
//
// Nothing that comes over it is trusted: is_whole says whether a request is as long as it says. A
// descriptor is taken with the requests that pass one; of others it is closed.
//
//   ThreadLink link(7, std::chrono::seconds(30));
//   const auto goes_on = [](ThreadLink::Waited waited) { return waited < std::chrono::seconds(30);
//   }; while (link.next(goes_on)) link.reply(0, 0, {});
//
// Complexity: a request and its reply are a system call each.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "algorithms/ports/host.h"
#include "shim/protocol.h"

namespace simbench::processes {

struct ChildRequest {
  shim::Request head;
  Bytes data{};
  bool is_whole = false;  // there is a head, and as much data as it says
  int passed = -1;        // a descriptor, which is the receiver's to close; -1: none
  pid_t sender = 0;       // the process, as the kernel says; of the first request, where asked for
};

class ThreadLink {
 public:
  static constexpr std::chrono::milliseconds kLook{20};

  // Owns the descriptor; -1: none.
  explicit ThreadLink(int descriptor = -1,
                      std::chrono::milliseconds patience = std::chrono::milliseconds(0));
  ~ThreadLink();
  ThreadLink(const ThreadLink&) = delete;
  ThreadLink& operator=(const ThreadLink&) = delete;

  int descriptor() const { return descriptor_; }
  // Once, before the other end sends anything: the first request says who sent it.
  void ask_for_sender();
  // Nothing: the other end is closed, may not go on, or is asleep. `goes_on` is asked with the time
  // that it has taken, every kLook and when a request has come; `is_asleep` every kLook, and must
  // say so twice.
  using Waited = std::chrono::steady_clock::duration;
  std::optional<ChildRequest> next(const std::function<bool(Waited)>& goes_on,
                                   const std::function<bool()>& is_asleep = {});
  bool was_asleep() const { return was_asleep_; }
  // Waits until there is a request, an end, or the patience is over.
  void await_request() const;
  // One that is gone is found by next(). One that takes no replies loses them.
  void reply(std::int64_t value, int error, std::span<const std::byte> data);

 private:
  int descriptor_;
  std::chrono::milliseconds patience_;
  bool asks_for_sender_ = false;
  bool was_asleep_ = false;
  Bytes buffer_{};
};

}  // namespace simbench::processes

// A set of epoll(): what it watches of the world's objects, by Linux' own rules.
//
// An object that may have become ready is listed, in the order in which that happened. Who takes
// events gets the listed ones that are ready: those of level-triggered items stay listed, those
// with EPOLLET are listed again by the next change, those with EPOLLONESHOT by the next control. An
// item is an object and the descriptor by which it was added; it ends with the object, when the
// last descriptor of that is closed.
//
//   EpollSet set;
//   const auto object = std::make_shared<OpenObject>(UdpSocket{});
//   set.control(EPOLL_CTL_ADD, object, {.fd = 7, .events = EPOLLIN, .data = 1});
//   for (const shim::EpollItem& each : set.take(16)) print(each.data);
//
// Source: epoll(7), epoll_ctl(2); fs/eventpoll.c of Linux, for the order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <vector>

#include "recording/true_time.h"
#include "shim/protocol.h"
#include "sim/programs/open_object.h"

namespace simbench::sim {

class EpollSet {
 public:
  static constexpr std::size_t kMostItems = 1024;

  // EPOLL_CTL_...; returns an errno, or 0.
  int control(int operation, const std::shared_ptr<OpenObject>& object,
              const shim::EpollItem& wanted);
  // The object may be ready for these events of poll(). Returns whether an item is listed anew.
  bool list(const OpenObject& object, int events);
  bool is_ready();
  // At most so many, with what they are ready for in `events`.
  std::vector<shim::EpollItem> take(std::size_t most);
  // When one of its timers is to be looked at.
  std::optional<TrueTime> next_look();

 private:
  struct Item {
    std::weak_ptr<OpenObject> object{};
    const OpenObject* key = nullptr;
    shim::EpollItem wanted{};
    bool is_listed = false;
    std::int64_t expirations = 0;  // of a timer, when it was looked at
  };
  using Items = std::list<Item>;

  Items::iterator find(const OpenObject* object, int fd);
  void put_last(Items::iterator item);
  // Forgets what is closed, and lists timers that have expired since.
  void look_at_items();
  static std::uint32_t events_of(const Item& item);
  // Whether it watches the other one, by whatever sets between; or too many are.
  bool reaches(const EpollSet& other, int depth) const;

  Items items_{};
  std::vector<Items::iterator> listed_{};
};

}  // namespace simbench::sim

#include "sim/programs/epoll_set.h"

#include <poll.h>
#include <sys/epoll.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace simbench::sim {
namespace {

constexpr std::uint32_t kAlways = EPOLLERR | EPOLLHUP;
// What is no event but says how they are told.
constexpr std::uint32_t kManner = EPOLLET | EPOLLONESHOT | EPOLLWAKEUP | EPOLLEXCLUSIVE;

}  // namespace

EpollSet::Items::iterator EpollSet::find(const OpenObject* object, int fd) {
  return std::ranges::find_if(
      items_, [&](const Item& each) { return each.key == object && each.wanted.fd == fd; });
}

void EpollSet::put_last(Items::iterator item) {
  if (std::exchange(item->is_listed, true)) return;
  listed_.push_back(item);
}

// The kernel's events have poll()'s numbers.
std::uint32_t EpollSet::events_of(const Item& item) {
  const std::shared_ptr<OpenObject> object = item.object.lock();
  // One that has told its event once says nothing, not even errors.
  if (object == nullptr || (item.wanted.events & ~kManner) == 0) return 0;
  return static_cast<std::uint32_t>(readiness(*object)) & (item.wanted.events | kAlways) & ~kManner;
}

void EpollSet::look_at_items() {
  std::erase_if(listed_, [](const auto& each) { return each->object.expired(); });
  std::erase_if(items_, [](const Item& each) { return each.object.expired(); });
  for (auto item = items_.begin(); item != items_.end(); ++item) {
    const std::shared_ptr<OpenObject> object = item->object.lock();
    ProcessTimer* const timer = object->timer();
    EpollSet* const inner = object->set();
    const bool tells_once = (item->wanted.events & EPOLLET) != 0;
    if (inner != nullptr && !item->is_listed && !tells_once && inner->is_ready()) put_last(item);
    if (timer == nullptr) continue;
    const std::int64_t expirations = timer->expirations();
    if (expirations > std::exchange(item->expirations, expirations)) put_last(item);
  }
}

int EpollSet::control(int operation, const std::shared_ptr<OpenObject>& object,
                      const shim::EpollItem& wanted) {
  look_at_items();
  const auto found = find(object.get(), wanted.fd);
  const bool is_there = found != items_.end();
  switch (operation) {
    case EPOLL_CTL_ADD: {
      if (is_there) return EEXIST;
      if (object->set() != nullptr && object->set()->reaches(*this, 0)) return ELOOP;
      if (items_.size() >= kMostItems) return ENOSPC;
      items_.push_back({.object = object, .key = object.get(), .wanted = wanted});
      const auto added = std::prev(items_.end());
      if (ProcessTimer* timer = object->timer()) added->expirations = timer->expirations();
      if (events_of(*added) != 0) put_last(added);
      return 0;
    }
    case EPOLL_CTL_MOD:
      if (!is_there) return ENOENT;
      if ((found->wanted.events & EPOLLEXCLUSIVE) != 0) return EINVAL;
      found->wanted = wanted;
      if (events_of(*found) != 0) put_last(found);
      return 0;
    case EPOLL_CTL_DEL:
      if (!is_there) return ENOENT;
      std::erase(listed_, found);
      items_.erase(found);
      return 0;
    default:
      return EINVAL;
  }
}

bool EpollSet::reaches(const EpollSet& other, int depth) const {
  constexpr int kMostDepth = 4;
  if (this == &other || depth > kMostDepth) return true;
  return std::ranges::any_of(items_, [&](const Item& item) {
    const std::shared_ptr<OpenObject> object = item.object.lock();
    return object != nullptr && object->set() != nullptr &&
           object->set()->reaches(other, depth + 1);
  });
}

bool EpollSet::list(const OpenObject& object, int events) {
  bool is_new = false;
  for (auto item = items_.begin(); item != items_.end(); ++item) {
    const std::uint32_t wanted = item->wanted.events;
    if (item->key != &object || (wanted & ~kManner) == 0) continue;
    if ((static_cast<std::uint32_t>(events) & (wanted | kAlways)) == 0) continue;
    is_new |= !item->is_listed;
    put_last(item);
  }
  return is_new;
}

bool EpollSet::is_ready() {
  look_at_items();
  return std::ranges::any_of(listed_, [](const auto& each) { return events_of(*each) != 0; });
}

std::vector<shim::EpollItem> EpollSet::take(std::size_t most) {
  look_at_items();
  std::vector<shim::EpollItem> taken;
  const std::vector<Items::iterator> before = std::exchange(listed_, {});
  std::vector<Items::iterator> again;
  for (const auto& item : before) {
    if (taken.size() == most) {  // these come first the next time
      listed_.push_back(item);
      continue;
    }
    item->is_listed = false;
    const std::uint32_t events = events_of(*item);
    if (events == 0) continue;
    shim::EpollItem told = item->wanted;
    told.events = events;
    taken.push_back(told);
    const std::uint32_t manner = item->wanted.events;
    if ((manner & EPOLLONESHOT) != 0) {
      item->wanted.events &= kManner;
    } else if ((manner & EPOLLET) == 0) {
      item->is_listed = true;
      again.push_back(item);
    }
  }
  listed_.insert(listed_.end(), again.begin(), again.end());
  return taken;
}

std::optional<TrueTime> EpollSet::next_look() {
  std::optional<TrueTime> next;
  const auto consider = [&next](std::optional<TrueTime> look) {
    if (look && (!next || *look < *next)) next = look;
  };
  for (const Item& item : items_) {
    const std::shared_ptr<OpenObject> object = item.object.lock();
    if (object == nullptr) continue;
    if (const ProcessTimer* timer = object->timer()) consider(timer->next_look());
    if (EpollSet* set = object->set()) consider(set->next_look());
  }
  return next;
}

}  // namespace simbench::sim

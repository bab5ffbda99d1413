// Objects under way by number, with released numbers reused: frames on their way to the host,
// segments on the network.
//
// Numbers fit into the subject of an event (sim/engine/event.h). A released object stays as it is
// until its number is reused, so its allocations are reused too.
//
// Cost: O(1); memory for the largest number of objects under way at once. add() may move the
// objects: a reference does not outlive it.
//
//   Slots<FrameArrival> frames;
//   const std::uint32_t id = frames.add();
//   frames[id].counter = 3;
//   engine.schedule(at, handler, kReadout, id);
//   frames.release(id);
#pragma once

#include <cstdint>
#include <vector>

namespace simbench::sim {

template <class Object>
class Slots {
 public:
  // The number of an object that is as its predecessor left it, or new.
  std::uint32_t add() {
    if (free_.empty()) {
      objects_.emplace_back();
      return static_cast<std::uint32_t>(objects_.size() - 1);
    }
    const std::uint32_t id = free_.back();
    free_.pop_back();
    return id;
  }
  void release(std::uint32_t id) { free_.push_back(id); }

  Object& operator[](std::uint32_t id) { return objects_[id]; }
  const Object& operator[](std::uint32_t id) const { return objects_[id]; }

  bool is_empty() const { return free_.size() == objects_.size(); }

 private:
  std::vector<Object> objects_;
  std::vector<std::uint32_t> free_;
};

}  // namespace simbench::sim

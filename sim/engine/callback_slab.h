// Storage for callables of any type: run once or dropped, never allocated one by one.
//
// A callable lives in the 48 bytes of a slot from emplace() until it has been run or dropped, and
// is destroyed exactly once, also if it throws or is never run. Slots are recycled and do not
// move, so a callable may itself add, run and drop others. A larger capture is a compile-time
// error: capture a pointer to it.
//
//   CallbackSlab slab;
//   const std::uint32_t slot = slab.emplace([&] { ++count; });
//   slab.run(slot);
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "algorithms/ports/assert.h"

namespace simbench::sim {

inline constexpr std::size_t kCallbackBytes = 48;

template <class F>
inline constexpr bool kFitsCallback = sizeof(F) <= kCallbackBytes &&
                                      alignof(F) <= alignof(std::max_align_t);

class CallbackSlab {
 public:
  CallbackSlab() = default;
  CallbackSlab(const CallbackSlab&) = delete;
  CallbackSlab& operator=(const CallbackSlab&) = delete;
  ~CallbackSlab() { clear(); }

  template <class F>
  std::uint32_t emplace(F&& callback) {
    using Callback = std::decay_t<F>;
    static_assert(kFitsCallback<Callback>,
                  "the capture is larger than 48 bytes: capture a pointer to it");
    static_assert(std::is_invocable_v<Callback>, "a callback is called without arguments");
    const std::uint32_t index = free_slot();
    Slot& slot = at(index);
    ::new (static_cast<void*>(slot.storage)) Callback(std::forward<F>(callback));
    // Only now that construction cannot fail any more is the slot taken.
    first_free_ = slot.next_free;
    slot.operate = &operate<Callback>;
    ++live_;
    return index;
  }

  // Runs the callable in the slot, then destroys it and frees the slot.
  void run(std::uint32_t index) {
    Slot& slot = at(index);
    const Release release{*this, slot, index};
    begin(slot)(slot.storage, true);
  }

  // Destroys the callable in the slot without running it. The slot stays taken until release().
  void destroy(std::uint32_t index) {
    Slot& slot = at(index);
    begin(slot)(slot.storage, false);
  }
  void release(std::uint32_t index) { free(at(index), index); }

  // False once the callable runs, has run or was destroyed.
  bool holds(std::uint32_t index) const { return at(index).operate != nullptr; }
  // Changes whenever the slot is used for another callable.
  std::uint32_t generation(std::uint32_t index) const { return at(index).generation; }
  bool exists(std::uint32_t index) const { return index < size_; }
  // Callables waiting to be run.
  std::size_t live() const { return live_; }

  // Destroys all callables, also those that destructors of callables add meanwhile.
  void clear();

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t kChunk = 64;
  using Operate = void (*)(std::byte* storage, bool run);

  struct Slot {
    alignas(std::max_align_t) std::byte storage[kCallbackBytes] = {};
    Operate operate = nullptr;
    std::uint32_t generation = 0;
    std::uint32_t next_free = kNone;
  };

  struct Release {
    CallbackSlab& slab;
    Slot& slot;
    std::uint32_t index;
    ~Release() { slab.free(slot, index); }
  };

  template <class Callback>
  static void operate(std::byte* storage, bool run) {
    struct Destroy {
      Callback& callback;
      ~Destroy() { callback.~Callback(); }
    };
    const Destroy destroy{*std::launder(reinterpret_cast<Callback*>(storage))};
    if (run) std::move(destroy.callback)();
  }

  Slot& at(std::uint32_t index) const { return chunks_[index / kChunk][index % kChunk]; }

  Operate begin(Slot& slot) {
    --live_;
    return std::exchange(slot.operate, nullptr);
  }

  std::uint32_t free_slot() {
    if (first_free_ == kNone) {
      SIMBENCH_ASSERT(size_ < kNone, "more callbacks than the slab can number");
      if (size_ == chunks_.size() * kChunk) chunks_.push_back(std::make_unique<Slot[]>(kChunk));
      first_free_ = size_++;
    }
    return first_free_;
  }

  void free(Slot& slot, std::uint32_t index) {
    ++slot.generation;
    slot.next_free = std::exchange(first_free_, index);
  }

  std::vector<std::unique_ptr<Slot[]>> chunks_;
  std::uint32_t size_ = 0;  // slots that were ever taken
  std::uint32_t first_free_ = kNone;
  std::size_t live_ = 0;
};

}  // namespace simbench::sim

// Which counters of a session's datagrams were accepted: each at most once, and none that is
// kSize or more behind the highest. Pure.
//
// Source: RFC 6479, with blocks of 64 bits.
#ifndef SIMBENCH_HARDWARE_NET_REPLAY_WINDOW_H_
#define SIMBENCH_HARDWARE_NET_REPLAY_WINDOW_H_

#include <array>
#include <cstdint>

namespace simbench::hardware {

class ReplayWindow {
 public:
  static constexpr std::uint64_t kSize = 1024;

  // Neither accepted before nor too old to tell.
  bool is_fresh(std::uint64_t counter) const {
    if (empty_ || counter > highest_) return true;
    return highest_ - counter < kSize && (block(counter) & bit(counter)) == 0;
  }

  // Call it for a fresh counter, once what carries it has proved to be authentic.
  void accept(std::uint64_t counter) {
    if (empty_ || counter > highest_) {
      move_to(counter);
    }
    block(counter) |= bit(counter);
  }

 private:
  // One block more than the window has: the one that the window moves into is cleared as a whole.
  static constexpr std::uint64_t kBlocks = kSize / 64 + 1;

  static std::uint64_t bit(std::uint64_t counter) { return std::uint64_t{1} << (counter % 64); }
  std::uint64_t& block(std::uint64_t counter) { return blocks_[counter / 64 % kBlocks]; }
  const std::uint64_t& block(std::uint64_t counter) const {
    return blocks_[counter / 64 % kBlocks];
  }

  void move_to(std::uint64_t counter) {
    const std::uint64_t steps = empty_ ? kBlocks : counter / 64 - highest_ / 64;
    if (steps >= kBlocks) {
      blocks_.fill(0);
    } else {
      for (std::uint64_t i = 1; i <= steps; ++i) blocks_[(highest_ / 64 + i) % kBlocks] = 0;
    }
    highest_ = counter;
    empty_ = false;
  }

  std::array<std::uint64_t, kBlocks> blocks_{};
  std::uint64_t highest_ = 0;
  bool empty_ = true;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NET_REPLAY_WINDOW_H_

// The engine workloads without an engine: their tables, and what timers, cameras, frames and hosts
// do.
//
// Definitions and check values: docs/reference/event_engine.md section 1. All times in nanoseconds.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace simbench::bench {

struct WorkloadTables {
  std::array<std::int64_t, 4096> hold_ns;                  // E: delays of w1
  std::array<std::array<std::int64_t, 1024>, 5> stage_ns;  // J0..J4: delays of w2
};

// Made once, on first use.
const WorkloadTables& workload_tables();

// First expiry of a timer of w1.
std::int64_t first_expiry_ns(std::uint64_t timer);

// First trigger of a camera of w2.
std::int64_t trigger_phase_ns(std::uint64_t camera);

// Workload w1, hold: N timers, each rearmed when it expires.
class HoldModel {
 public:
  // Timers expire `timers` times in all as warm-up, then `events` times.
  HoldModel(std::uint64_t timers, std::uint64_t events)
      : delays_ns_(workload_tables().hold_ns), warm_up_(timers), end_(timers + events) {}

  // One expiry. Returns the delay until the next one of the same timer.
  std::int64_t expire(std::uint32_t timer) {
    hash_ = hash_ * 0x9E3779B97F4A7C15 + timer;
    ++count_;
    return delays_ns_[next_delay_++ % delays_ns_.size()];
  }

  bool warmed_up() const { return count_ == warm_up_; }
  bool ended() const { return count_ == end_; }
  std::uint64_t checksum() const { return hash_; }

 private:
  const std::array<std::int64_t, 4096>& delays_ns_;
  std::uint64_t warm_up_;
  std::uint64_t end_;
  std::uint64_t count_ = 0;
  std::uint64_t hash_ = 0;
  std::uint64_t next_delay_ = 0;
};

// Workload w2, rig: triggered cameras whose frames pass five stages until a host has them.
//
// Event kinds: 0 triggers a camera (subject: camera); 1 to 5 move a frame to that stage (subject:
// its slot); 5 is the delivery to the host.
class RigModel {
 public:
  static constexpr std::uint16_t kTrigger = 0;
  static constexpr std::uint16_t kDelivery = 5;
  static constexpr std::int64_t kPeriod_ns = 22'222'222;

  explicit RigModel(std::uint32_t cameras)
      : stage_ns_(workload_tables().stage_ns),
        next_frame_(cameras),
        slots_(std::size_t{kSlotsPerCamera} * cameras),
        hosts_(cameras / 3) {
    for (std::uint32_t i = 0; i < slots_.size(); ++i) {
      slots_[i].camera = i / kSlotsPerCamera;
      slots_[i].host = slots_[i].camera % static_cast<std::uint32_t>(hosts_.size());
    }
  }

  // Starts the camera's next frame; returns its slot.
  std::uint32_t trigger(std::uint32_t camera, std::int64_t now_ns) {
    const std::uint32_t frame = next_frame_[camera]++;
    const std::uint32_t slot = camera * kSlotsPerCamera + frame % kSlotsPerCamera;
    slots_[slot].frame = frame;
    slots_[slot].stamps_ns[0] = now_ns;
    return slot;
  }

  // The time that the frame spends in a stage from 0 to 4.
  std::int64_t delay_ns(std::uint32_t stage, std::uint32_t slot) const {
    const Slot& s = slots_[slot];
    return stage_ns_[stage][(131 * s.camera + 17 * s.frame + 7 * stage) % 1024];
  }

  void stamp(std::uint32_t stage, std::uint32_t slot, std::int64_t now_ns) {
    slots_[slot].stamps_ns[stage] = now_ns;
  }

  void deliver(std::uint32_t slot, std::int64_t now_ns) {
    Slot& s = slots_[slot];
    s.stamps_ns[kDelivery] = now_ns;
    Host& host = hosts_[s.host];
    host.latency_ns += static_cast<std::uint64_t>(now_ns - s.stamps_ns[0]);
    host.hash = host.hash * 0x9E3779B97F4A7C15 + s.camera;
  }

  std::uint64_t checksum() const {
    std::uint64_t sum = 0;
    for (const Host& host : hosts_) sum += host.latency_ns;
    return sum;
  }
  std::uint64_t order_checksum() const {
    std::uint64_t mixed = 0;
    for (const Host& host : hosts_) mixed ^= host.hash;
    return mixed;
  }

 private:
  static constexpr std::uint32_t kSlotsPerCamera = 4;  // several frames are under way at once

  struct Slot {
    std::uint32_t camera = 0;
    std::uint32_t host = 0;
    std::uint32_t frame = 0;
    std::array<std::int64_t, 6> stamps_ns{};
  };
  struct Host {
    std::uint64_t latency_ns = 0;
    std::uint64_t hash = 0;
  };

  const std::array<std::array<std::int64_t, 1024>, 5>& stage_ns_;
  std::vector<std::uint32_t> next_frame_;
  std::vector<Slot> slots_;
  std::vector<Host> hosts_;
};

}  // namespace simbench::bench

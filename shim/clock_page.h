// A host's clock as its programs read it without asking: a page of memory that they share with
// whoever serves the clock, as the kernel's clock is read through the vDSO.
//
// It has the newest settings of the clock, each a straight line over CLOCK_MONOTONIC; an instant is
// read under the setting that was valid then, or the oldest that is kept. One process writes, any
// number read: a reader that meets a change reads again. Times are nanoseconds, clock readings
// since 1970. A reading takes some 10 ns.
//
//   ClockPage own{};
//   add_setting(own, {.since = 5000, .reads = 1'800'000'000'000'000'000, .rate = 12e-6});
//   const std::int64_t reading_ns = reading_at(own, 6000);
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace simbench::shim {

struct ClockSetting {
  std::int64_t since = 0;  // CLOCK_MONOTONIC
  std::int64_t reads = 0;  // then
  double rate = 0;         // against CLOCK_MONOTONIC, minus 1
};

struct ClockPage {
  static constexpr std::size_t kKept = 32;
  struct Shared {
    std::atomic<std::int64_t> since;
    std::atomic<std::int64_t> reads;
    std::atomic<double> rate;
  };
  std::atomic<std::uint32_t> version;  // odd while it is written
  std::atomic<std::uint32_t> added;    // settings so far
  Shared settings[kKept];              // a ring
};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

// Settings come in order of time.
inline void add_setting(ClockPage& page, const ClockSetting& setting) {
  const std::uint32_t version = page.version.load(std::memory_order_relaxed);
  const std::uint32_t added = page.added.load(std::memory_order_relaxed);
  page.version.store(version + 1, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);
  ClockPage::Shared& place = page.settings[added % ClockPage::kKept];
  place.since.store(setting.since, std::memory_order_relaxed);
  place.reads.store(setting.reads, std::memory_order_relaxed);
  place.rate.store(setting.rate, std::memory_order_relaxed);
  page.added.store(added + 1, std::memory_order_relaxed);
  page.version.store(version + 2, std::memory_order_release);
}

inline ClockSetting setting_at(const ClockPage& page, std::int64_t monotonic) {
  for (;;) {
    const std::uint32_t version = page.version.load(std::memory_order_acquire);
    const std::uint32_t added = page.added.load(std::memory_order_relaxed);
    ClockSetting found;
    for (std::uint32_t back = 1; back <= added && back <= ClockPage::kKept; ++back) {
      const ClockPage::Shared& place = page.settings[(added - back) % ClockPage::kKept];
      found = {.since = place.since.load(std::memory_order_relaxed),
               .reads = place.reads.load(std::memory_order_relaxed),
               .rate = place.rate.load(std::memory_order_relaxed)};
      if (found.since <= monotonic) break;
    }
    std::atomic_thread_fence(std::memory_order_acquire);
    if (version % 2 == 0 && page.version.load(std::memory_order_relaxed) == version) return found;
  }
}

// What the clock read, or will read, when CLOCK_MONOTONIC does.
inline std::int64_t reading_at(const ClockPage& page, std::int64_t monotonic) {
  const ClockSetting setting = setting_at(page, monotonic);
  const std::int64_t passed = monotonic - setting.since;
  const double ahead = setting.rate * static_cast<double>(passed);
  const auto whole = static_cast<std::int64_t>(ahead);
  return setting.reads + passed + whole - (ahead < static_cast<double>(whole) ? 1 : 0);
}

}  // namespace simbench::shim

#include "sim/usb/host_stack.h"

#include <cmath>

#include "laws/normal_law.h"
#include "sim/engine/normal_process.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kHostJitter("usb/host_jitter");
constexpr ComponentKey kFrameDelays("usb/frame_delays");

}  // namespace

HostJitter::HostJitter(const scenarios::Usb& settings, std::uint64_t seed, std::size_t host,
                       TrueTime capture_start, double period_ns)
    : mean_(settings.host_jitter_transfers),
      correlation_(settings.host_jitter_correlation),
      period_ns_(period_ns),
      start_(capture_start),
      stream_(seed, kHostJitter, host) {}

double HostJitter::at(TrueTime t) {
  if (mean_ <= 0) return 0;
  const auto cell =
      static_cast<std::int64_t>(static_cast<double>((t - start_).count()) / period_ns_);
  for (; cell_ < cell; ++cell_) {
    value_ = correlation_ * value_ + (1 - correlation_) * stream_.exponential(mean_);
  }
  return value_;
}

FrameDelays::FrameDelays(const scenarios::Usb& settings, std::uint64_t seed, std::size_t stream)
    : kernel_copy_mean_ns_(settings.kernel_copy_exponential_ms * 1e6),
      jitter_transfers_(settings.delivery_jitter_transfers),
      spike_probability_(settings.spike_probability),
      spike_max_transfers_(settings.spike_max_transfers),
      table_ms_(settings.delivery_quantiles_ms),
      correlation_(settings.delivery_correlation),
      innovation_(std::sqrt(1 - correlation_ * correlation_)),
      stream_(seed, kFrameDelays, stream),
      frames_(KeyedStreams(seed, kFrameDelays).of(stream)) {}

// Flattened: two ziggurats a frame.
[[gnu::flatten]] FrameDelays::Draw FrameDelays::draw(double transfer_ns) {
  // A stream for each frame, so that a jump more or less moves no other frame's draws.
  if (active_seed_field != nullptr) [[unlikely]]
    stream_ = frames_.stream(++frame_);
  if (!table_ms_.empty()) return {.kernel_copy_ns = 0, .delivery_ns = draw_from_table_ms() * 1e6};
  Draw draw{stream_.exponential(kernel_copy_mean_ns_),
            stream_.exponential(jitter_transfers_ * transfer_ns)};
  if (spike_probability_ > 0 && stream_.chance(spike_probability_)) {
    draw.delivery_ns += stream_.uniform(0, spike_max_transfers_ * transfer_ns);
  }
  return draw;
}

double FrameDelays::draw_from_table_ms() {
  const double fresh = stream_.normal(1);
  variate_ = has_variate_ ? correlation_ * variate_ + innovation_ * fresh : fresh;
  has_variate_ = true;
  return table_ms_.value_at(normal_probability(variate_));
}

}  // namespace simbench::sim

#include "sim/usb/host_stack.h"

#include <algorithm>
#include <cmath>

#include "sim/engine/normal_process.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kHostJitter("usb/host_jitter");
constexpr ComponentKey kFrameDelays("usb/frame_delays");

// By inversion, so that a seed field can move a late draw to a later one.
double movable_exponential(RandomStream& stream, double mean) {
  return -mean * std::log1p(-stream.uniform());
}

}  // namespace

HostJitter::HostJitter(const scenarios::Usb& settings, std::uint64_t seed, std::size_t host,
                       TrueTime capture_start, double period_ns)
    : mean_(settings.host_jitter_transfers),
      correlation_(settings.host_jitter_correlation),
      period_ns_(period_ns),
      start_(capture_start),
      stream_(seed, kHostJitter, host),
      cells_(KeyedStreams(seed, kHostJitter).of(host)) {}

double HostJitter::at(TrueTime t) {
  if (mean_ <= 0) return 0;
  const auto cell =
      static_cast<std::int64_t>(static_cast<double>((t - start_).count()) / period_ns_);
  for (; cell_ < cell; ++cell_) {
    value_ = correlation_ * value_ + (1 - correlation_) * draw();
  }
  return value_;
}

double HostJitter::draw() {
  if (active_seed_field == nullptr) return stream_.exponential(mean_);
  stream_ = cells_.stream(static_cast<std::uint64_t>(cell_) + 2);  // 0 is the component's own
  return movable_exponential(stream_, mean_);
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
  if (active_seed_field != nullptr) [[unlikely]]
    return draw_in_field(transfer_ns);
  if (!table_ms_.empty()) return {.kernel_copy_ns = 0, .delivery_ns = draw_from_table_ms() * 1e6};
  Draw draw{stream_.exponential(kernel_copy_mean_ns_),
            stream_.exponential(jitter_transfers_ * transfer_ns)};
  if (spike_probability_ > 0 && stream_.chance(spike_probability_)) {
    draw.delivery_ns += stream_.uniform(0, spike_max_transfers_ * transfer_ns);
  }
  return draw;
}

// A stream for each number, so that each can be moved (sim/engine/seed_field.h).
[[gnu::noinline]] FrameDelays::Draw FrameDelays::draw_in_field(double transfer_ns) {
  const auto renewed = [this](std::uint64_t number) -> RandomStream& {
    return stream_ = frames_.stream(4 * frame_ + number);
  };
  ++frame_;
  RandomStream& first = renewed(0);
  if (!table_ms_.empty()) return {.kernel_copy_ns = 0, .delivery_ns = draw_from_table_ms() * 1e6};
  Draw draw{.kernel_copy_ns = movable_exponential(first, kernel_copy_mean_ns_), .delivery_ns = 0};
  draw.delivery_ns = movable_exponential(renewed(1), jitter_transfers_ * transfer_ns);
  if (spike_probability_ > 0 && renewed(2).chance(spike_probability_)) {
    draw.delivery_ns += renewed(3).uniform(0, spike_max_transfers_ * transfer_ns);
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

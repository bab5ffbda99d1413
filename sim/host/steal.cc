#include "sim/host/steal.h"

#include <cmath>

namespace simbench::sim {
namespace {

constexpr ComponentKey kStolenSlices("steal: slices");
constexpr ComponentKey kFirstCell("steal: first cell");

}  // namespace

StolenTime::StolenTime(const scenarios::Steal& steal, std::uint64_t run_seed, PeerId host)
    : slice_ns_(steal.slice_ms * 1e6),
      cell_ns_(steal.share > 0 ? slice_ns_ / steal.share : 0),
      first_ns_(RandomStream(run_seed, kFirstCell, host).uniform() * cell_ns_),
      draws_(KeyedStreams(run_seed, kStolenSlices).of(host)) {}

Nanoseconds StolenTime::wait(TrueTime at) const {
  if (cell_ns_ == 0) return Nanoseconds(0);
  const double since_zero_ns = to_ns(at.time_since_epoch()) - first_ns_;
  const double cell = std::floor(since_zero_ns / cell_ns_);
  RandomStream draw = draws_.stream(static_cast<std::uint64_t>(static_cast<std::int64_t>(cell)));
  const double begin_ns = cell * cell_ns_ + draw.uniform() * (cell_ns_ - slice_ns_);
  const bool is_away = since_zero_ns >= begin_ns && since_zero_ns < begin_ns + slice_ns_;
  return is_away ? from_ns(begin_ns + slice_ns_ - since_zero_ns) : Nanoseconds(0);
}

}  // namespace simbench::sim

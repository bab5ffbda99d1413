#include "sim/host/host_load.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kLoadBursts("host: bursts of load");

}  // namespace

HostLoad::HostLoad(const scenarios::Burst& parameters, std::uint64_t run_seed, PeerId host)
    : run_seed_(run_seed),
      latency_ms_(parameters.latency_ms),
      bursts_(parameters, run_seed, kLoadBursts, host) {}

Nanoseconds HostLoad::delay(TrueTime at, ComponentKey what, std::uint64_t a, std::uint64_t b) {
  if (!bursts_.active(at)) return Nanoseconds(0);
  RandomStream draw(run_seed_, what, a, b);
  return from_ms(draw.uniform(0, 2 * latency_ms_));
}

}  // namespace simbench::sim

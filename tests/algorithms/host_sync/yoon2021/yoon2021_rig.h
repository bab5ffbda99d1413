// Common costs for the tests of Algorithms 1 and 2: every number of a session follows from them.
//
// g: occupancy of a send, L: latency, w: wake-up, c: cost of a set, of which the first quarter
// passes before the new value counts. From the reading of T_m to that instant pass g + L + w + c/4:
// the delay really needed. The slave's error is t_d minus that.
#pragma once

#include "algorithms/host_sync/yoon2021/yoon2021.h"
#include "tests/algorithms/host_sync/script_host.h"

namespace simbench {

inline constexpr Nanoseconds kSend{30'000};
inline constexpr Nanoseconds kWake{20'000};
inline constexpr Nanoseconds kSet{4'000'000};
inline constexpr Nanoseconds kSetEffective = kSet / 4;

inline void use_common_costs(ScriptWorld& world, PeerId hosts, Nanoseconds latency) {
  for (PeerId id = 0; id < hosts; ++id) {
    world.host(id).costs = {.send = kSend, .set = kSet, .set_fraction = 0.25, .wake = kWake};
    world.host(id).offset = from_ms(300) * id;
    if (id == 0) continue;
    world.set_latency(0, id, latency);
    world.set_latency(id, 0, latency);
  }
}

inline Yoon2021Settings settings_for(bool network, bool time) {
  Yoon2021Settings settings;
  settings.add_network_delay = network;
  settings.add_time_delay = time;
  return settings;
}

}  // namespace simbench

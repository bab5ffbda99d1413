// A clock service: a host_sync that has run for `service_time` when the capture starts, and goes on
// during it.
//
// Its two sides are coroutines that need not end: one on the master, one on each slave; and, where
// hosts may stand in a chain, a third on a host that has both sides.
//
//   struct TimeSettings {
//     Nanoseconds service_time = from_ms(60e3);
//   };
//   Task<void> serve_time(Host& host, std::vector<PeerId> slaves, TimeSettings settings);
//   Task<void> follow_time(Host& host, PeerId master, TimeSettings settings);
//   using TimeService = ClockService<TimeSettings, serve_time, follow_time>;
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "algorithms/parameter_binder.h"
#include "algorithms/ports/host_sync.h"

namespace simbench {

template <class Settings>
using RelayTime = Task<void> (*)(Host&, PeerId master, std::vector<PeerId> slaves, Settings);

template <class Settings, Task<void> (*serve)(Host&, std::vector<PeerId>, Settings),
          Task<void> (*follow)(Host&, PeerId, Settings), RelayTime<Settings> relay = nullptr>
class ClockService : public HostSync {
 public:
  explicit ClockService(Settings settings) : settings_(std::move(settings)) {}
  std::optional<Nanoseconds> warm_up() const override { return settings_.service_time; }
  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override {
    return serve(host, std::move(slaves), settings_);
  }
  Task<void> run_slave(Host& host, PeerId master) override {
    return follow(host, master, settings_);
  }
  bool can_relay() const override { return relay != nullptr; }
  Task<void> run_relay(Host& host, PeerId master, std::vector<PeerId> slaves) override {
    if constexpr (relay != nullptr) {
      return relay(host, master, std::move(slaves), settings_);
    } else {
      return HostSync::run_relay(host, master, std::move(slaves));
    }
  }

 private:
  Settings settings_;
};

// The parameter warm_up_s, which is the time for which a service has run.
inline void bind_warm_up(ParameterBinder& parameters, Nanoseconds& service_time,
                         const char* source = kAssumption) {
  parameters.number("warm_up_s", service_time, 1, 1e6,
                    "how long the service has run before the capture", source);
}

}  // namespace simbench

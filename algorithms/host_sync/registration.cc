#include "algorithms/host_sync/registration.h"

#include <memory>
#include <string>
#include <utility>

#include "algorithms/host_sync/limits.h"
#include "algorithms/host_sync/ntp/registration_ntp.h"
#include "algorithms/host_sync/ptp/registration_ptp.h"
#include "algorithms/host_sync/pulses/registration_pulse.h"
#include "algorithms/host_sync/two_way/registration_two_way.h"
#include "algorithms/host_sync/yoon2021/yoon2021.h"
#include "algorithms/parameter_specs.h"

namespace simbench {
namespace {

const char* const kNotPublished =
    "not published; a fit (docs/reference/calibration.md section 1, FIT-C)";
const char* const kRepair = "assumption; not part of the printed algorithm";

std::vector<ParameterSpec> yoon2021_parameters() {
  return {
      number_parameter("stamps", 100, 1, 1e6, "n_d, stamps that t_l is the mean of", kNotPublished),
      number_parameter("clock_calls", 100, 1, 1e6,
                       "n_c, calls of get and set that t_t is the mean of", kNotPublished),
      number_parameter("threshold_ms", 100, 0, 1e6, "T_th, largest accepted delay", kNotPublished),
      number_parameter("send_interval_ms", 0, 0, 1e5,
                       "pace of the stamps; 0: as fast as they can be sent",
                       "Yoon et al. 2021, Algorithm 1"),
      number_parameter("pass_limit", 200, 1, 1e6, "passes after which a slave is given up",
                       kRepair),
      number_parameter("session_gap_ms", 1000, 0, 1e6, "pause between the sessions of two slaves",
                       "docs/reference/calibration.md section 1 (gap)"),
      number_parameter("parallel_sessions", 1, 1, 1e4,
                       "groups of slaves that are synchronised concurrently",
                       "Yoon et al. 2021, section 3: slaves in turn"),
      choice_parameter("latency_estimate", {"literal", "intended"},
                       "t_l as printed (mean spacing of the stamps), or half the mean round trip",
                       "docs/reference/paper.md section 4, defect 1"),
      choice_parameter("transport", {"stream", "datagram"}, "what the messages travel over",
                       kNotPublished),
      number_parameter("receive_timeout_ms", 5000, 1, 1e7,
                       "silence that ends a pass; must cover the slave's clock_calls", kRepair),
      number_parameter("turn_timeout_s", 86400, 1, 1e7, "how long a slave waits for its turn",
                       kRepair),
  };
}

Yoon2021Settings yoon2021_settings(const Parameters& parameters) {
  Yoon2021Settings settings;
  settings.stamps = static_cast<std::uint32_t>(parameters.number("stamps"));
  settings.clock_calls = static_cast<std::uint32_t>(parameters.number("clock_calls"));
  settings.threshold = from_ms(parameters.number("threshold_ms"));
  settings.send_interval = from_ms(parameters.number("send_interval_ms"));
  settings.pass_limit = static_cast<std::uint32_t>(parameters.number("pass_limit"));
  settings.session_gap = from_ms(parameters.number("session_gap_ms"));
  settings.parallel_sessions = static_cast<std::uint32_t>(parameters.number("parallel_sessions"));
  settings.ask_for_stamps = parameters.text("latency_estimate") == "intended";
  settings.transport =
      parameters.text("transport") == "stream" ? Transport::kStream : Transport::kDatagram;
  settings.receive_timeout = from_ms(parameters.number("receive_timeout_ms"));
  settings.turn_timeout = from_ms(parameters.number("turn_timeout_s") * 1e3);
  return settings;
}

HostSyncEntry yoon2021(std::string name, std::string summary, bool add_network_delay,
                       bool add_time_delay) {
  HostSyncEntry entry;
  entry.info.name = std::move(name);
  entry.info.family = "yoon2021";
  entry.info.summary = std::move(summary);
  entry.info.source = "Yoon et al. 2021, Sensors 21(18) 6276, Algorithms 1 and 2, Tables 2 and 3";
  entry.info.parameters = yoon2021_parameters();
  entry.make = [add_network_delay, add_time_delay](const Parameters& parameters) {
    Yoon2021Settings settings = yoon2021_settings(parameters);
    settings.add_network_delay = add_network_delay;
    settings.add_time_delay = add_time_delay;
    return std::make_unique<Yoon2021>(settings);
  };
  return entry;
}

HostSyncEntry limit(std::string name, std::string summary, std::string source,
                    InitialClocks initial_clocks) {
  HostSyncEntry entry;
  entry.info.family = name;
  entry.info.name = std::move(name);
  entry.info.summary = std::move(summary);
  entry.info.source = std::move(source);
  entry.make = [initial_clocks](const Parameters&) {
    return std::make_unique<NoHostSync>(initial_clocks);
  };
  return entry;
}

void append(std::vector<HostSyncEntry>& entries, std::vector<HostSyncEntry> more) {
  for (HostSyncEntry& entry : more) entries.push_back(std::move(entry));
}

}  // namespace

std::vector<HostSyncEntry> builtin_host_sync_algorithms() {
  std::vector<HostSyncEntry> entries = {
      yoon2021("yoon2021_network", "the paper's row Network: t_d = t_l", true, false),
      yoon2021("yoon2021_time", "the paper's row Time: t_d = t_t", false, true),
      yoon2021("yoon2021_both", "the paper's proposal: t_d = t_l + t_t", true, true),
      yoon2021("yoon2021_neither", "the paper's protocol without compensation: t_d = 0", false,
               false),
      limit("free_running", "no synchronisation: clocks start at arbitrary offsets",
            "a limit, for comparison", InitialClocks::kUnsynchronised),
      limit("ntp_last_set", "the paper's row None: clocks set hours ago, free-running since",
            "Yoon et al. 2021, Tables 2 and 3; docs/reference/calibration.md section 2",
            InitialClocks::kLastSet),
      limit("oracle", "every host reads the master's clock", "a limit, for comparison",
            InitialClocks::kMaster),
  };
  append(entries, two_way_host_syncs());
  append(entries, ptp_host_syncs());
  append(entries, pulse_host_syncs());
  append(entries, ntp_host_syncs());
  return entries;
}

}  // namespace simbench

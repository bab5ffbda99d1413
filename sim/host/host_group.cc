#include "sim/host/host_group.h"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <string>
#include <utility>
#include <variant>

#include "algorithms/ports/assert.h"
#include "sim/host/leap_second.h"

namespace simbench::sim {
namespace {

constexpr double kMsPerHour = 3.6e6;
constexpr double kMsPerMinute = 6e4;
constexpr double kSteadyEpochMaxMs = kMsPerHour;
constexpr std::size_t kSharedBlocks = 256;  // of noise, of 32 KiB each

std::string host_component(std::size_t host, const char* what) {
  return "host" + std::to_string(host) + ": " + what;
}

// The offset of a slave's clock before synchronisation.
double offset_ms(const scenarios::HostClockModel& clock, std::uint64_t run_seed,
                 InitialClocks initial_clocks, std::size_t host, double skew_against_master) {
  if (initial_clocks == InitialClocks::kLastSet) {
    RandomStream draw(run_seed, host_component(host, "clock since the last set"));
    const double skew_then = draw.normal(clock.last_set.skew_sigma_ppm * 1e-6);
    return skew_then * clock.last_set.hours_ago * kMsPerHour +
           skew_against_master * clock.last_set.minutes_since_baseline * kMsPerMinute;
  }
  if (!clock.initial_offset_of_host_ms.empty()) return clock.initial_offset_of_host_ms[host];
  RandomStream draw(run_seed, host_component(host, "initial offset"));
  return draw.normal(clock.initial_offset_sigma_ms);
}

}  // namespace

OscillatorModel host_oscillator(const scenarios::Hosts& hosts, std::uint64_t run_seed,
                                std::size_t host, std::size_t kept_blocks) {
  if (host == 0 && hosts.master_is_exact) return OscillatorModel(0);
  OscillatorModel oscillator(hosts.clock.oscillator, run_seed, host_component(host, "oscillator"),
                             TrueTime{}, kept_blocks);
  const std::vector<double>& skews_ppm = hosts.clock.skew_of_host_ppm;
  if (!skews_ppm.empty()) oscillator.set_skew(skews_ppm[host] * 1e-6);
  const double coefficient_ppb_per_k = hosts.clock.oscillator.temperature_coefficient_ppb_per_k;
  if (hosts.temperature && coefficient_ppb_per_k != 0) {
    oscillator.set_temperature(
        TemperatureCourse(*hosts.temperature, run_seed, host_component(host, "temperature")),
        coefficient_ppb_per_k);
  }
  return oscillator;
}

OscillatorModel HostOscillators::of(std::uint64_t run_seed, std::size_t host) {
  if (of_seed_.empty() || seed_ != run_seed) {
    seed_ = run_seed;
    of_seed_.clear();
    for (std::size_t each = 0; each < static_cast<std::size_t>(hosts_.count); ++each) {
      of_seed_.push_back(host_oscillator(hosts_, run_seed, each, kSharedBlocks));
    }
  }
  return of_seed_[host];
}

HostGroup::HostGroup(const scenarios::Scenario& scenario, std::uint64_t run_seed,
                     std::string_view load_key, InitialClocks initial_clocks,
                     VirtualContext& context, RecordingSink& sink, HostOscillators* oscillators)
    : context_(context),
      engine_(context.engine()),
      parameters_(scenario.hosts),
      faults_(scenario.faults),
      sink_(sink),
      load_(run_seed, load_key, scenario.hosts, scenario.network),
      outages_(scenario.faults),
      traffic_(scenario.network, scenario.hosts, run_seed,
               static_cast<std::size_t>(scenario.hosts.count)),
      network_(engine_, scenario.network, run_seed, static_cast<std::size_t>(scenario.hosts.count),
               load_, outages_),
      drift_files_(scenario.hosts, run_seed, clocks_) {
  SIMBENCH_ASSERT(scenario.hosts.count >= 1, "a rig has a master");
  if (!traffic_.is_none()) network_.meet(traffic_);
  const std::optional<scenarios::Wifi>& wifi = scenario.network.wifi;
  if (wifi && (wifi->tsf || wifi->ftm)) access_point_.emplace(*wifi, run_seed, clocks_);
  const HostWorld world{.context = context,
                        .hosts = scenario.hosts,
                        .network_parameters = scenario.network,
                        .network = network_,
                        .load = load_,
                        .outages = outages_,
                        .trigger_line = trigger_line_,
                        .drift_files = drift_files_,
                        .frames = frames_,
                        .sink = sink,
                        .run_seed = run_seed,
                        .access_point = access_point_ ? &*access_point_ : nullptr};
  const std::vector<std::size_t> cameras = scenario.cameras_by_host();
  for (PeerId id = 0; id < static_cast<PeerId>(scenario.hosts.count); ++id) {
    make_clock(oscillators != nullptr ? oscillators->of(run_seed, id)
                                      : host_oscillator(scenario.hosts, run_seed, id),
               run_seed, initial_clocks);
    hosts_.emplace_back(world, id, clocks_.back(), cameras[id] > 0);
  }
  if (!scenario.cameras.frame_control) return;
  for (std::int64_t camera = 0; camera < scenario.cameras.count; ++camera) {
    hosts_[static_cast<std::size_t>(scenario.host_of(camera))].add_frame_control(
        static_cast<std::uint32_t>(camera), scenario);
  }
}

void HostGroup::make_clock(OscillatorModel oscillator, std::uint64_t run_seed,
                           InitialClocks initial_clocks) {
  const std::size_t host = clocks_.size();
  RandomStream epoch(run_seed, host_component(host, "steady epoch"));
  const SteadyTime steady_epoch{from_ms(epoch.uniform(0, kSteadyEpochMaxMs))};
  Nanoseconds offset{};
  if (host > 0) {
    const double skew = oscillator.skew() - clocks_[0].oscillator().skew();
    offset = from_ms(offset_ms(parameters_.clock, run_seed, initial_clocks, host, skew));
  }
  clocks_.emplace_back(static_cast<std::uint32_t>(host), std::move(oscillator), offset,
                       steady_epoch);
  if (host > 0 && initial_clocks == InitialClocks::kMaster) clocks_[host].follow(clocks_[0]);
}

std::vector<SystemClock*> HostGroup::clocks() {
  std::vector<SystemClock*> all;
  for (SystemClock& clock : clocks_) all.push_back(&clock);
  return all;
}

void HostGroup::begin_faults() {
  outages_.start(engine_.now());
  for (const scenarios::Fault& fault : faults_) {
    const auto* leap = std::get_if<scenarios::LeapSecond>(&fault);
    if (leap == nullptr) continue;
    for (std::size_t host = 0; host < hosts_.size(); ++host) {
      boost::asio::co_spawn(context_,
                            take_leap_second(*leap, HostTime(engine_.now().time_since_epoch()),
                                             hosts_[host], clocks_[host]),
                            boost::asio::detached);
    }
  }
}

void HostGroup::on_capture_start(const TriggerTree& trigger, std::int64_t last) {
  begin_faults();
  trigger_line_.start(trigger, last);
  for (SimHost& host : hosts_) host.trigger_started();
}

void HostGroup::report_clocks() {
  for (const SystemClock& clock : clocks_) sink_.on_event(clock.present(engine_.now()));
}

}  // namespace simbench::sim

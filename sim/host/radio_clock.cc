#include "sim/host/radio_clock.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/host/sim_host.h"

namespace simbench::sim {
namespace {

constexpr double kCounterEpochMaxMs = 3.6e6;
constexpr double kNsPerUs = 1e3;

constexpr ComponentKey kCounterZero("wifi radio: zero of the counter");
constexpr ComponentKey kAccessPointSkew("wifi access point: oscillator");
constexpr ComponentKey kBeaconStamp("wifi radio: stamp of a beacon");
constexpr ComponentKey kBeaconReceipt("wifi radio: receipt of a beacon");
constexpr ComponentKey kBeaconLoss("wifi radio: loss of a beacon");
constexpr ComponentKey kTsfBefore("wifi radio: call to the TSF");
constexpr ComponentKey kTsfAfter("wifi radio: return from the TSF");
constexpr ComponentKey kCounterBefore("wifi radio: call to the counter");
constexpr ComponentKey kCounterAfter("wifi radio: return from the counter");
constexpr ComponentKey kCalibration("wifi radio: calibration");
constexpr ComponentKey kMultipath("wifi radio: multipath");
constexpr ComponentKey kSession("wifi radio: FTM session");

// A count with a part of a nanosecond, rounded down to the resolution; 0: to the nanosecond.
Nanoseconds counted(Nanoseconds whole, double part_ns, double resolution_ns) {
  const double exact_ns = to_ns(whole) + part_ns;
  if (resolution_ns <= 0) return from_ns(exact_ns);
  return from_ns(std::floor(exact_ns / resolution_ns) * resolution_ns);
}

PeerId device_of(const scenarios::Wifi& wifi) {
  return wifi.access_point_host ? static_cast<PeerId>(*wifi.access_point_host)
                                : AccessPoint::kNoHost;
}

OscillatorModel own_oscillator(const scenarios::Wifi& wifi, std::uint64_t run_seed) {
  const double sigma_ppm = wifi.tsf ? wifi.tsf->access_point_skew_sigma_ppm : 0;
  RandomStream draw(run_seed, kAccessPointSkew);
  return OscillatorModel(draw.normal(sigma_ppm * 1e-6));
}

}  // namespace

RadioCounter::RadioCounter(std::uint64_t run_seed, PeerId device)
    : zero_(from_ms(RandomStream(run_seed, kCounterZero, device).uniform(0, kCounterEpochMaxMs))) {}

AccessPoint::AccessPoint(const scenarios::Wifi& wifi, std::uint64_t run_seed,
                         const std::deque<SystemClock>& clocks)
    : wifi_(wifi),
      run_seed_(run_seed),
      clocks_(clocks),
      device_(device_of(wifi)),
      counter_(run_seed, device_),
      beacons_(wifi, run_seed) {
  if (device_ == kNoHost) own_.emplace(device_, own_oscillator(wifi, run_seed));
}

bool AccessPoint::has_radio(PeerId host) const {
  return host == device_ || std::ranges::find(wifi_.wired_hosts, static_cast<std::int64_t>(host)) ==
                                wifi_.wired_hosts.end();
}

std::optional<std::int64_t> AccessPoint::last_heard(TrueTime t, PeerId station) const {
  const std::int64_t last = beacons_.last(t);
  for (int missed = 0; missed < kBeaconsRemembered; ++missed) {
    const std::int64_t number = last - missed;
    RandomStream draw(run_seed_, kBeaconLoss, station, static_cast<std::uint64_t>(number));
    if (!draw.chance(wifi_.tsf->beacon_loss_probability)) return number;
  }
  return std::nullopt;
}

std::optional<TsfTime> AccessPoint::copy_at(TrueTime t, PeerId station,
                                            const SystemClock& clock) const {
  const std::optional<std::int64_t> heard = last_heard(t, station);
  if (!heard) return std::nullopt;
  const scenarios::WifiTsf& tsf = *wifi_.tsf;
  const double resolution_ns = tsf.resolution_us * kNsPerUs;
  const auto number = static_cast<std::uint64_t>(*heard);
  const TrueTime beacon = beacons_.at(*heard);
  RandomStream stamp_draw(run_seed_, kBeaconStamp, number);
  const Nanoseconds stamp =
      counted(at(beacon).time_since_epoch(),
              stamp_draw.normal(tsf.beacon_stamp_sigma_us * kNsPerUs), resolution_ns);
  RandomStream receipt_draw(run_seed_, kBeaconReceipt, station, number);
  const double error_ns = receipt_draw.normal(tsf.receive_sigma_us * kNsPerUs);
  const Nanoseconds since = clock.steady(t) - clock.steady(beacon);
  return TsfTime(counted(stamp + since, error_ns, resolution_ns));
}

SimRadioClock::SimRadioClock(SimHost& host, const AccessPoint& access_point)
    : host_(host),
      access_point_(access_point),
      counter_(host.world().run_seed, host.id()),
      label_(host.name("radio's clock")) {
  const scenarios::Wifi& wifi = access_point.wifi();
  const std::uint64_t seed = host.world().run_seed;
  if (wifi.tsf) {
    tsf_reads_.emplace(wifi.tsf->read_before, wifi.tsf->read_after, seed, kTsfBefore, kTsfAfter,
                       host.id());
  }
  if (!wifi.ftm) return;
  counter_reads_.emplace(wifi.ftm->counter_before, wifi.ftm->counter_after, seed, kCounterBefore,
                         kCounterAfter, host.id());
  late_ = lateness(*wifi.ftm);
}

bool SimRadioClock::is_access_point() const { return host_.id() == access_point_.device(); }

SimRadioClock::Call SimRadioClock::begin_call(ReadLaw& law) {
  const MessageKey key{.direction = host_.id(), .message = law.calls++};
  const Nanoseconds before = law.before.draw(host_.true_now(), key);
  const Nanoseconds after = law.after.draw(host_.true_now(), key);
  const Cpu::Turn turn = host_.cpu().reserve(before + after);
  return {turn, turn.start + before};
}

Task<void> SimRadioClock::wait_until(TrueTime at) {
  if (at > host_.true_now()) co_await sleep_until(host_.world().context, at, label_);
}

Task<std::optional<TsfReading>> SimRadioClock::read_tsf() {
  if (!tsf_reads_) co_return std::nullopt;
  const Call call = begin_call(*tsf_reads_);
  co_await wait_until(call.turn.end);
  const SystemClock& clock = host_.system_clock();
  std::optional<TsfTime> count;
  if (is_access_point()) {
    const double resolution_ns = access_point_.wifi().tsf->resolution_us * kNsPerUs;
    count = TsfTime(counted(access_point_.at(call.touch).time_since_epoch(), 0, resolution_ns));
  } else {
    count = access_point_.copy_at(call.touch, host_.id(), clock);
  }
  if (!count) co_return std::nullopt;
  co_return TsfReading{
      .before = clock.steady(call.turn.start), .tsf = *count, .after = clock.steady(call.turn.end)};
}

Task<std::optional<CounterReading>> SimRadioClock::read_counter() {
  if (!counter_reads_) co_return std::nullopt;
  const Call call = begin_call(*counter_reads_);
  co_await wait_until(call.turn.end);
  const SystemClock& clock = host_.system_clock();
  co_return CounterReading{.before = clock.steady(call.turn.start),
                           .counter = counter_.at(call.touch, clock),
                           .after = clock.steady(call.turn.end)};
}

SimRadioClock::Lateness SimRadioClock::lateness(const scenarios::WifiFtm& ftm) const {
  const std::uint64_t seed = host_.world().run_seed;
  const auto of_device_ns = [&](PeerId device) {
    return RandomStream(seed, kCalibration, device).normal(ftm.calibration_sigma_ns);
  };
  const auto of_way_ns = [&](std::uint64_t is_up) {
    RandomStream draw(seed, kMultipath, host_.id(), is_up);
    return std::abs(draw.normal(ftm.multipath_sigma_ns));
  };
  return {.station_ns = of_device_ns(host_.id()) + of_way_ns(0),
          .access_point_ns = of_device_ns(access_point_.device()) + of_way_ns(1)};
}

std::optional<FtmExchange> SimRadioClock::exchange(TrueTime at, RandomStream& draw) const {
  const scenarios::Wifi& wifi = access_point_.wifi();
  const scenarios::WifiFtm& ftm = *wifi.ftm;
  const bool is_lost = draw.chance(ftm.exchange_loss_probability);
  const double station_ns = late_.station_ns + draw.normal(ftm.stamp_sigma_ns);
  const double access_point_ns = late_.access_point_ns + draw.normal(ftm.stamp_sigma_ns);
  const Outages& outages = host_.world().outages;
  const PeerId other = access_point_.device();
  const bool is_cut = outages.unreachable(host_.id(), at) ||
                      (other != AccessPoint::kNoHost && outages.unreachable(other, at));
  if (is_lost || is_cut) return std::nullopt;
  const TrueTime answered = at + from_us(wifi.sifs_us + wifi.preamble_us);
  const auto of_access_point = [&](TrueTime t, double late_ns) {
    return TsfTime(counted(access_point_.at(t).time_since_epoch(),
                           ftm.access_point_offset_ns + late_ns, ftm.stamp_resolution_ns));
  };
  const auto of_station = [&](TrueTime t, double late_ns) {
    const HardwareTime exact = counter_.at(t, host_.system_clock());
    return HardwareTime(counted(exact.time_since_epoch(), late_ns, ftm.stamp_resolution_ns));
  };
  return FtmExchange{.t1 = of_access_point(at, 0),
                     .t2 = of_station(at, station_ns),
                     .t3 = of_station(answered, 0),
                     .t4 = of_access_point(answered, access_point_ns)};
}

Task<std::vector<FtmExchange>> SimRadioClock::measure_ftm() {
  std::vector<FtmExchange> exchanges;
  if (!counter_reads_ || is_access_point()) co_return exchanges;
  const scenarios::WifiFtm& ftm = *access_point_.wifi().ftm;
  RandomStream draw(host_.world().run_seed, kSession, host_.id(), sessions_++);
  const TrueTime begin = host_.true_now();
  const Nanoseconds session = from_ms(ftm.session_ms);
  co_await wait_until(begin + session);
  if (draw.chance(ftm.session_loss_probability)) co_return exchanges;
  for (std::int64_t i = 0; i < ftm.exchanges; ++i) {
    const TrueTime at = begin + session * (2 * i + 1) / (2 * ftm.exchanges);
    const std::optional<FtmExchange> measured = exchange(at, draw);
    if (measured) exchanges.push_back(*measured);
  }
  co_return exchanges;
}

}  // namespace simbench::sim

#include "sim/network/wifi.h"

#include <algorithm>
#include <utility>

#include "algorithms/ports/time.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kBusyChannel("wifi: bursts on the channel");

// QoS data header 26, LLC and SNAP 8, frame check 4, less Ethernet's header of 14.
constexpr double kBytesBeyondEthernet = 24;
constexpr double kAcknowledgementBytes = 14;

}  // namespace

WifiCell::WifiCell(Engine& engine, const scenarios::Wifi& wifi, std::uint64_t run_seed,
                   std::size_t hosts, Passed passed)
    : engine_(engine),
      wifi_(wifi),
      passed_(std::move(passed)),
      handler_id_(engine.attach(*this)),
      difs_(from_us(wifi.sifs_us + 2 * wifi.slot_us)),
      acknowledgement_(from_us(wifi.sifs_us + wifi.preamble_us) +
                       LineRate(wifi.basic_rate_mbit_per_s).duration(kAcknowledgementBytes)),
      beacons_(wifi, run_seed),
      bursts_(wifi.busy, run_seed, kBusyChannel, 0),
      stations_(hosts),
      contends_at_(hosts + 1, TrueTime::min()) {
  for (const std::int64_t host : wifi.wired_hosts) {
    stations_[static_cast<std::size_t>(host)].is_station = false;
  }
  if (wifi.access_point_host) {
    stations_[static_cast<std::size_t>(*wifi.access_point_host)].is_station = false;
  }
}

Nanoseconds WifiCell::airtime(double bytes, double rate_mbit_per_s) const {
  return from_us(wifi_.preamble_us) +
         LineRate(rate_mbit_per_s).duration(bytes + kBytesBeyondEthernet);
}

bool WifiCell::any_sleeps(TrueTime at) const {
  return std::ranges::any_of(stations_, [this, at](const Station& station) {
    return station.is_station && !is_awake(station, at);
  });
}

void WifiCell::keep_awake(PeerId station, TrueTime at) {
  if (!wifi_.power_save) return;
  TrueTime& awake_until = stations_[station].awake_until;
  awake_until = std::max(awake_until, at + from_ms(wifi_.power_save->idle_ms));
}

TrueTime WifiCell::wake(PeerId station_id) {
  const TrueTime now = engine_.now();
  if (!wifi_.power_save) return now;
  Station& station = stations_[station_id];
  if (now >= station.awake_from && now >= station.awake_until) {
    station.awake_from = now + from_ms(wifi_.power_save->wake_up_ms);
    engine_.schedule(station.awake_from, handler_id_, kWakes, station_id);
  }
  const TrueTime can_send = std::max(now, station.awake_from);
  keep_awake(station_id, can_send);
  return can_send;
}

void WifiCell::hold(HopId id) {
  const PeerId station_id = hops_[id].hop.station;
  Station& station = stations_[station_id];
  station.held.push_back(id);
  const bool wakes_already = station.held.size() > 1 || engine_.now() < station.awake_from;
  if (!wakes_already) {
    engine_.schedule(next_beacon(engine_.now()), handler_id_, kWakes, station_id);
  }
}

// The station is awake, for a beacon or to send: the access point sends what it holds for it.
void WifiCell::release(PeerId station_id) {
  Station& station = stations_[station_id];
  // It may have slept again since a beacon was awaited, or have been served before it.
  if (station.held.empty() || engine_.now() < station.awake_from) return;
  if (!is_awake(station, engine_.now())) station.awake_from = engine_.now();
  keep_awake(station_id, engine_.now());
  for (const HopId id : std::exchange(station.held, {})) ready(id);
}

double WifiCell::rate_mbit_per_s(const WifiHop& hop) const {
  if (hop.is_group) return wifi_.basic_rate_mbit_per_s;
  return hop.is_up ? wifi_.uplink_rate_mbit_per_s.value_or(wifi_.rate_mbit_per_s)
                   : wifi_.rate_mbit_per_s;
}

// A foreign frame meets the least contention window's mean.
Nanoseconds WifiCell::draw_queue(const WifiHop& hop, RandomStream& draw) const {
  if (hop.is_up || wifi_.downlink_traffic_share == 0) return Nanoseconds(0);
  const double slots = static_cast<double>(wifi_.contention_window_min) / 2;
  const Nanoseconds frame = difs_ + from_us(slots * wifi_.slot_us) +
                            airtime(wifi_.downlink_frame_bytes, wifi_.rate_mbit_per_s) +
                            acknowledgement_;
  double wait_ms = 0;
  while (draw.chance(wifi_.downlink_traffic_share)) wait_ms += draw.uniform(0, to_ms(frame));
  return from_ms(wait_ms);
}

bool WifiCell::draw_attempts(const WifiHop& hop, RandomStream& draw, Nanoseconds& took) const {
  const Nanoseconds frame = airtime(hop.bytes, rate_mbit_per_s(hop));
  const std::int64_t attempts = hop.is_group ? 1 : wifi_.retry_limit;
  std::int64_t window = wifi_.contention_window_min;
  for (std::int64_t attempt = 0; attempt < attempts; ++attempt) {
    const std::uint64_t slots = draw.below(static_cast<std::uint64_t>(window) + 1);
    took += difs_ + from_us(static_cast<double>(slots) * wifi_.slot_us) + frame;
    if (!hop.is_group) took += acknowledgement_;
    if (!draw.chance(wifi_.collision_probability)) return false;
    window = std::min(2 * window + 1, wifi_.contention_window_max);
  }
  return true;
}

WifiCell::Drawn WifiCell::drawn(const WifiHop& hop, RandomStream& draw) const {
  Drawn drawn{.hop = hop};
  drawn.wait = from_ms(draw.exponential(wifi_.busy.latency_ms));
  if (!hop.is_group) drawn.acknowledgement = acknowledgement_;
  drawn.is_lost = draw_attempts(hop, draw, drawn.occupied);
  double timeout_ms = hop.timeout_ms;
  for (int i = 0; drawn.is_lost && i < hop.retransmissions; ++i, timeout_ms *= 2) {
    drawn.timeouts += from_ms(timeout_ms);
    drawn.is_lost = draw_attempts(hop, draw, drawn.timeouts);
  }
  drawn.queued = draw_queue(hop, draw);
  return drawn;
}

void WifiCell::send(const WifiHop& hop, RandomStream draw) {
  const TrueTime now = engine_.now();
  const HopId id = hops_.add();
  hops_[id] = drawn(hop, draw);
  TrueTime at = now;
  if (hop.is_group) {
    if (wifi_.power_save && any_sleeps(now)) at = next_beacon(now);
  } else if (hop.is_up) {
    at = wake(hop.station);
  } else if (wifi_.power_save && !is_awake(stations_[hop.station], now)) {
    return hold(id);
  }
  if (at == now) return ready(id);
  engine_.schedule(at, handler_id_, kReady, id);
}

// The transmission contends for the channel, after the foreign traffic and what its transmitter has
// before it.
void WifiCell::ready(HopId id) {
  const TrueTime now = engine_.now();
  const Drawn& drawn = hops_[id];
  const std::size_t transmitter = drawn.hop.is_up ? drawn.hop.station : stations_.size();
  TrueTime& contends_at = contends_at_[transmitter];
  const TrueTime queued = now + drawn.queued;
  contends_at = std::max(contends_at, bursts_.active(now) ? queued + drawn.wait : queued);
  if (contends_at == now) return transmit(id);
  engine_.schedule(contends_at, handler_id_, kContends, id);
}

void WifiCell::transmit(HopId id) {
  const Drawn& drawn = hops_[id];
  const WifiHop& hop = drawn.hop;
  TrueTime at = channel_.pass(engine_.now(), drawn.occupied) - drawn.acknowledgement;
  if (!hop.is_group) keep_awake(hop.station, at);
  if (hop.retransmissions > 0) {
    TrueTime& last =
        passed_at_.try_emplace(2 * hop.in_order + (hop.is_up ? 1 : 0), at).first->second;
    at = last = std::max(last, at + drawn.timeouts);
  }
  engine_.schedule(at, handler_id_, kPassed, id);
}

void WifiCell::handle(Event event) {
  switch (static_cast<EventKind>(event.kind)) {
    case kReady:
      ready(event.subject);
      break;
    case kContends:
      transmit(event.subject);
      break;
    case kWakes:
      release(event.subject);
      break;
    case kPassed: {
      const std::uint32_t ticket = hops_[event.subject].hop.ticket;
      const bool is_lost = hops_[event.subject].is_lost;
      hops_.release(event.subject);
      passed_(ticket, is_lost);
      break;
    }
  }
}

}  // namespace simbench::sim

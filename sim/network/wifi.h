// A wireless cell: the stations and the access point take turns on one channel (IEEE 802.11, DCF).
//
// A message goes over the air from a station to the access point or back; from station to station
// it takes both ways, one after the other. What the wired network adds (latency, loss and the like)
// is the network's (sim/network/network.h), after the last way.
//
// Medium access. A transmission is a number of attempts, the k-th of which takes
//
//   DIFS + U{0, ..., W_k} slots + preamble + bytes / rate + SIFS + acknowledgement
//
// where DIFS = SIFS + 2 slots, W_1 is the least contention window and W_k + 1 doubles with each
// attempt up to the largest; bytes are the message's, with the headers that the scenario states and
// those that 802.11 has beyond Ethernet's. An attempt fails with the collision probability; after
// retry_limit failures a datagram is lost. The ways may have rates of their own. A stream sends it
// again after its timeout, doubled each time, until its retransmissions are used up, and what is
// behind it waits. The channel serves one transmission after the other in the order in which they
// become ready: half duplex, for all.
//
// Contention. In a burst of foreign traffic, a process in true time of the whole cell, each
// transmission first waits Exp(busy/latency_ms): both directions of a link are hit together. Those
// of one transmitter wait in order, those of several beside each other, as the foreign frames keep
// all of them waiting at once.
//
// Foreign traffic of the access point: what it has for a station waits as a stationary M/D/1 queue
// lets it, busy for downlink_traffic_share r with frames that take S each: the sum of N draws from
// U(0, S), where P(N >= n) = r^n. What comes up does not wait, so the ways differ.
//
// Power save. A station sleeps idle_ms after its last transmission in either direction. What is for
// a sleeping one is held by the access point until the next beacon with a DTIM or until the station
// wakes up to send, which takes it wake_up_ms. The way to a quiet station thus takes up to
// beacon_interval_ms * dtim_period longer, uniformly, and the way back does not; a station that
// polls more often than each idle_ms sees none of it.
//
// Broadcasts and multicasts go up as other messages do and down once for all, at the basic rate, in
// one attempt without an acknowledgement, which all receive or none; if any station sleeps then, at
// the next beacon with a DTIM.
//
// Assumptions: an attempt on an idle channel draws its backoff too (pessimistic: the standard lets
// the first one go after DIFS); collisions are independent of each other and of the cell's own
// traffic, and take as long as a success; a stream's retransmissions find the channel idle; the
// stations' power saving is that of Linux (dynamic power save), and they hear every beacon.
//
// Left out: frame aggregation, block acknowledgements, EDCA's classes, RTS/CTS, rate adaptation,
// distance, roaming and scans, the beacons' own airtime, the drift of the access point's beacons,
// and whole symbols (4 us). Cards do not stamp the transmission itself: a transmit stamp of the
// card is of the instant at which it has the message, before it contends.
//
// All random numbers of a message are keyed by (link, direction, transport, number of the message);
// queues and sleep alone depend on other messages. Deterministic.
//
// Source: IEEE 802.11-2020, 10.3.4 (DCF), 11.2.3 (power management), table 17-21 (constants; also
// in ns-3's wifi-standard-constants.h); Bianchi, "Performance analysis of the IEEE 802.11
// distributed coordination function", IEEE JSAC 18(3), 2000; Linux, net/mac80211
// (dynamic_ps_timeout, ieee80211_get_buffered_bc); Kleinrock, "Queueing Systems" vol. 1, section
// 5.7; scenario /network/wifi. Cost: two events a
// transmission, three with a wait; memory for the hosts and the messages under way.
//
//   WifiCell cell(engine, wifi, seed, host_count, [](std::uint32_t ticket, bool is_lost) {});
//   cell.send({.ticket = 7, .station = 3, .is_up = true, .bytes = 100}, stream);
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "algorithms/ports/exchange.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/engine.h"
#include "sim/engine/random.h"
#include "sim/engine/slots.h"
#include "sim/network/beacons.h"
#include "sim/network/load.h"
#include "sim/network/port.h"

namespace simbench::sim {

// A message's way between a station and the access point.
struct WifiHop {
  std::uint32_t ticket = 0;    // the caller's
  PeerId station = 0;          // at its other end; of a group: of none
  bool is_up = false;          // from the station
  bool is_group = false;       // from the access point to all stations
  double bytes = 0;            // with the headers that the scenario states
  int retransmissions = 0;     // of a stream, at most; 0: a datagram
  double timeout_ms = 0;       // of the first of these
  std::uint64_t in_order = 0;  // streams: messages with the same number and way keep their order
};

class WifiCell : private EventHandler {
 public:
  // Called when the receiver has the message or, if it is lost, when it was given up.
  using Passed = std::function<void(std::uint32_t ticket, bool is_lost)>;

  // `engine` and `wifi` must outlive the cell.
  WifiCell(Engine& engine, const scenarios::Wifi& wifi, std::uint64_t run_seed, std::size_t hosts,
           Passed passed);
  WifiCell(const WifiCell&) = delete;
  WifiCell& operator=(const WifiCell&) = delete;
  ~WifiCell() override = default;

  bool is_station(PeerId host) const { return stations_[host].is_station; }
  // A station or the access point: its messages to the others of these pass no wire.
  bool has_radio(PeerId host) const {
    return is_station(host) || wifi_.access_point_host == static_cast<std::int64_t>(host);
  }

  // The transmitter has the message now. `draw` is the hop's own.
  void send(const WifiHop& hop, RandomStream draw);

  // How long the frame itself is on the air.
  Nanoseconds airtime(double bytes, double rate_mbit_per_s) const;
  // The first beacon after `at` for which stations wake.
  TrueTime next_beacon(TrueTime at) const { return beacons_.at(beacons_.last(at) + 1); }

 private:
  using HopId = std::uint32_t;
  enum EventKind : std::uint16_t { kReady, kContends, kPassed, kWakes };
  struct Station {
    bool is_station = true;
    TrueTime awake_from = TrueTime::min();
    TrueTime awake_until = TrueTime::min();
    std::vector<HopId> held{};  // by the access point, while it sleeps
  };
  // A hop with its draws.
  struct Drawn {
    WifiHop hop;
    Nanoseconds wait{};             // if it begins in a burst
    Nanoseconds queued{};           // behind the access point's foreign traffic
    Nanoseconds occupied{};         // the channel, by all attempts
    Nanoseconds acknowledgement{};  // the last part of that, after the receiver has it
    Nanoseconds timeouts{};         // of a stream
    bool is_lost = false;
  };

  void handle(Event event) override;

  bool is_awake(const Station& station, TrueTime at) const {
    return station.awake_from <= at && at < station.awake_until;
  }
  bool any_sleeps(TrueTime at) const;
  // The station keeps awake after a message at `at`.
  void keep_awake(PeerId station, TrueTime at);
  // When the station can send.
  TrueTime wake(PeerId station);
  void hold(HopId id);
  void release(PeerId station);

  Drawn drawn(const WifiHop& hop, RandomStream& draw) const;
  // The rate of its frames.
  double rate_mbit_per_s(const WifiHop& hop) const;
  // How long it waits for the access point's foreign traffic.
  Nanoseconds draw_queue(const WifiHop& hop, RandomStream& draw) const;
  // Draws the attempts of one transmission; whether it fails.
  bool draw_attempts(const WifiHop& hop, RandomStream& draw, Nanoseconds& took) const;

  void ready(HopId id);
  void transmit(HopId id);

  Engine& engine_;
  const scenarios::Wifi& wifi_;
  Passed passed_;
  HandlerId handler_id_;
  Nanoseconds difs_;
  Nanoseconds acknowledgement_;  // SIFS and the acknowledgement
  Beacons beacons_;
  BurstProcess bursts_;
  Port channel_;
  std::vector<Station> stations_;      // by host
  std::vector<TrueTime> contends_at_;  // the last one of each host, and of the access point
  std::unordered_map<std::uint64_t, TrueTime> passed_at_;  // the last one of each stream and way
  Slots<Drawn> hops_;
};

}  // namespace simbench::sim

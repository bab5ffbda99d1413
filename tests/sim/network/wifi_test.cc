#include "sim/network/wifi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <vector>

#include "tests/sim/network/probe.h"

namespace simbench::sim {
namespace {

constexpr std::uint64_t kCellSeed = 31;
constexpr ComponentKey kTestDraws("test: hops");

// The constants of 802.11a and no disturbance.
scenarios::Wifi quiet_cell() {
  scenarios::Wifi wifi;
  wifi.rate_mbit_per_s = 54;
  wifi.basic_rate_mbit_per_s = 6;
  wifi.preamble_us = 20;
  wifi.sifs_us = 16;
  wifi.slot_us = 9;
  wifi.contention_window_min = 15;
  wifi.contention_window_max = 1023;
  wifi.retry_limit = 7;
  return wifi;
}

// Without chance: a transmission takes kDifsUs + frame_us() and, until the channel is free, kAckUs.
scenarios::Wifi fixed_cell() {
  scenarios::Wifi wifi = quiet_cell();
  wifi.contention_window_min = 0;
  wifi.contention_window_max = 0;
  return wifi;
}

scenarios::WifiPowerSave power_save(std::int64_t dtim_period = 1) {
  return {.idle_ms = 100, .beacon_interval_ms = 102.4, .dtim_period = dtim_period, .wake_up_ms = 2};
}

constexpr double kDifsUs = 34;
constexpr double kAckUs = 16 + 20 + 8 * 14 / 6.0;
constexpr double frame_us(double bytes) { return 20 + 8 * (bytes + 24) / 54; }

struct Passage {
  std::uint32_t ticket = 0;
  bool is_lost = false;
  TrueTime at{};
};

// A cell of eight stations in which hops begin at given times; the ticket is the key of the draws.
class Cell {
 public:
  explicit Cell(const scenarios::Wifi& wifi, std::uint64_t seed = kCellSeed)
      : wifi_(wifi),
        seed_(seed),
        cell_(engine_, wifi_, seed, 8, [this](std::uint32_t ticket, bool is_lost) {
          passed.push_back({ticket, is_lost, engine_.now()});
        }) {}

  WifiCell& cell() { return cell_; }
  void send_at(TrueTime at, const WifiHop& hop) {
    const WifiHop& kept = hops_.emplace_back(hop);
    engine_.call_at(
        at, [this, &kept] { cell_.send(kept, RandomStream(seed_, kTestDraws, kept.ticket)); });
  }
  void run() { engine_.run(); }

  std::vector<Passage> passed;

 private:
  scenarios::Wifi wifi_;
  std::uint64_t seed_;
  Engine engine_;
  WifiCell cell_;
  std::deque<WifiHop> hops_;
};

double to_us(Nanoseconds duration) { return to_ms(duration) * 1e3; }

// How long each of `count` hops took that began `interval_ms` apart.
std::vector<double> delays_us(Cell& cell, WifiHop hop, std::uint32_t count, double interval_ms) {
  for (std::uint32_t i = 0; i < count; ++i) {
    hop.ticket = i;
    cell.send_at(at_ms(i * interval_ms), hop);
  }
  cell.run();
  std::vector<double> delays;
  delays.reserve(cell.passed.size());
  for (const Passage& passage : cell.passed) {
    delays.push_back(to_us(passage.at - at_ms(passage.ticket * interval_ms)));
  }
  EXPECT_EQ(delays.size(), count);
  return delays;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// Kolmogorov and Smirnov: more than this has a probability of 2e-12.
void expect_uniform(std::vector<double> values, double low, double high) {
  std::ranges::sort(values);
  const auto count = static_cast<double>(values.size());
  double distance = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double law = std::clamp((values[i] - low) / (high - low), 0.0, 1.0);
    const auto rank = static_cast<double>(i);
    distance = std::max({distance, law - rank / count, (rank + 1) / count - law});
  }
  EXPECT_LT(distance, std::sqrt(12 * std::log(10.0) / (2 * count)))
      << "from " << values.front() << " to " << values.back() << ", seed " << kCellSeed;
}

TEST(WifiCellTest, AirtimeIsThePreambleAndTheBytes) {
  Cell cell(quiet_cell());
  EXPECT_NEAR(to_us(cell.cell().airtime(100, 54)), 20 + 8 * 124 / 54.0, 1e-3);
  EXPECT_NEAR(to_us(cell.cell().airtime(1500, 6)), 20 + 8 * 1524 / 6.0, 1e-3);
}

// A two-way estimate is half of the difference of the ways wrong.
TEST(WifiCellTest, WaysOfUnequalRatesDifferByTheirFrames) {
  scenarios::Wifi wifi = fixed_cell();
  wifi.uplink_rate_mbit_per_s = 6;
  Cell up(wifi);
  Cell down(wifi);
  const double up_us = mean_of(delays_us(up, {.station = 1, .is_up = true, .bytes = 100}, 10, 10));
  const double down_us =
      mean_of(delays_us(down, {.station = 1, .is_up = false, .bytes = 100}, 10, 10));
  EXPECT_NEAR(up_us - down_us, 8 * 124 / 6.0 - 8 * 124 / 54.0, 0.01);
}

// The mean wait in an M/D/1 queue is r S / (2 (1 - r)): Pollaczek and Khinchine.
TEST(WifiCellTest, TheWayDownWaitsForTheAccessPointsTraffic) {
  scenarios::Wifi wifi = fixed_cell();
  wifi.downlink_traffic_share = 0.5;
  wifi.downlink_frame_bytes = 1500;
  Cell up(wifi);
  Cell down(wifi);
  const double idle_us = kDifsUs + frame_us(100);
  const double service_us = kDifsUs + frame_us(1500) + kAckUs;
  constexpr std::uint32_t kCount = 20'000;
  const double waits_us =
      mean_of(delays_us(down, {.station = 1, .is_up = false, .bytes = 100}, kCount, 20)) - idle_us;
  EXPECT_NEAR(waits_us, service_us / 2, 0.05 * service_us / 2) << "seed " << kCellSeed;
  EXPECT_NEAR(mean_of(delays_us(up, {.station = 1, .is_up = true, .bytes = 100}, 100, 20)), idle_us,
              0.01);
}

// DIFS, 0 to 15 slots with the same probability, the frame.
TEST(WifiCellTest, AnIdleChannelTakesDifsABackoffAndTheFrame) {
  Cell cell(quiet_cell());
  constexpr std::uint32_t kCount = 16'000;
  const std::vector<double> delays =
      delays_us(cell, {.station = 1, .is_up = true, .bytes = 100}, kCount, 10);
  std::vector<int> slots(16);
  for (const double delay : delays) {
    const double slot = (delay - kDifsUs - frame_us(100)) / 9;
    ASSERT_NEAR(slot, std::round(slot), 1e-3);
    ++slots.at(static_cast<std::size_t>(std::lround(slot)));
  }
  for (const int count : slots) {
    EXPECT_NEAR(count, kCount / 16.0, 6 * std::sqrt(kCount / 16.0)) << "seed " << kCellSeed;
  }
  const double sigma_us = 9 * std::sqrt((16 * 16 - 1) / 12.0);
  EXPECT_NEAR(mean_of(delays), kDifsUs + 7.5 * 9 + frame_us(100), 6 * sigma_us / std::sqrt(kCount))
      << "seed " << kCellSeed;
}

// Windows of 15, 31 and 63 slots; half of the attempts fail, an eighth of three.
TEST(WifiCellTest, RetriesDoubleTheWindowUntilTheLimit) {
  scenarios::Wifi wifi = quiet_cell();
  wifi.collision_probability = 0.5;
  wifi.retry_limit = 3;
  Cell cell(wifi);
  constexpr std::uint32_t kCount = 20'000;
  const std::vector<double> delays =
      delays_us(cell, {.station = 1, .is_up = true, .bytes = 100}, kCount, 10);
  const auto lost = std::ranges::count(cell.passed, true, &Passage::is_lost);
  EXPECT_NEAR(static_cast<double>(lost), kCount / 8.0, 6 * std::sqrt(kCount * 7 / 64.0))
      << "seed " << kCellSeed;
  const double attempt_us = kDifsUs + frame_us(100) + kAckUs;
  const double expected_us =
      (attempt_us + 7.5 * 9) + (attempt_us + 15.5 * 9) / 2 + (attempt_us + 31.5 * 9) / 4 - kAckUs;
  // No transmission takes more than 1.5 ms.
  EXPECT_NEAR(mean_of(delays), expected_us, 6 * 400 / std::sqrt(kCount)) << "seed " << kCellSeed;
  EXPECT_GT(mean_of(delays), expected_us - 20);
}

TEST(WifiCellTest, TheWindowStopsAtItsLargest) {
  scenarios::Wifi wifi = quiet_cell();
  wifi.contention_window_max = 31;
  wifi.collision_probability = 1;
  Cell cell(wifi);
  const std::vector<double> delays = delays_us(cell, {.station = 1, .bytes = 100}, 2'000, 20);
  const double least_us = 7 * (kDifsUs + frame_us(100)) + 6 * kAckUs;
  for (const double delay : delays) {
    ASSERT_GE(delay, least_us - 1e-2);
    ASSERT_LE(delay, least_us + (15 + 6 * 31) * 9 + 1e-2);
  }
  EXPECT_GT(*std::ranges::max_element(delays), least_us + (15 + 3 * 31) * 9);
  EXPECT_EQ(std::ranges::count(cell.passed, true, &Passage::is_lost), 2'000);
}

TEST(WifiCellTest, AllShareOneChannelInTheirOrder) {
  Cell cell(fixed_cell());
  cell.send_at(at_ms(1), {.ticket = 0, .station = 1, .is_up = true, .bytes = 1000});
  cell.send_at(at_ms(1), {.ticket = 1, .station = 2, .is_up = true, .bytes = 100});
  cell.send_at(at_ms(1), {.ticket = 2, .station = 1, .is_up = false, .bytes = 100});
  cell.send_at(at_ms(9), {.ticket = 3, .station = 2, .is_up = false, .bytes = 100});
  cell.run();
  double expected_us = 1000;
  ASSERT_EQ(cell.passed.size(), 4u);
  for (const std::uint32_t i : {0u, 1u, 2u}) {
    expected_us += kDifsUs + frame_us(i == 0 ? 1000 : 100);
    EXPECT_EQ(cell.passed[i].ticket, i);
    EXPECT_NEAR(ms_of(cell.passed[i].at) * 1e3, expected_us, 1e-2) << i;
    expected_us += kAckUs;
  }
  EXPECT_NEAR(ms_of(cell.passed[3].at) * 1e3, 9000 + kDifsUs + frame_us(100), 1e-2);
}

// Half of the attempts are retransmitted, after 200, 400, ... ms; what is behind them waits.
TEST(WifiCellTest, StreamsRetransmitInOrder) {
  scenarios::Wifi wifi = fixed_cell();
  wifi.collision_probability = 0.5;
  wifi.retry_limit = 1;
  const WifiHop hop{.station = 1, .bytes = 100, .retransmissions = 15, .timeout_ms = 200};
  Cell apart(wifi);
  constexpr std::uint32_t kCount = 4'000;
  const std::vector<double> delays = delays_us(apart, hop, kCount, 5e6);
  int at_once = 0;
  int after_one = 0;
  for (const double delay : delays) {
    const double timeouts = std::floor(delay / 200e3);  // 0, 1, 1 + 2, 1 + 2 + 4, ...
    at_once += timeouts == 0 ? 1 : 0;
    after_one += timeouts == 1 ? 1 : 0;
  }
  EXPECT_NEAR(at_once, kCount / 2.0, 6 * std::sqrt(kCount / 4.0)) << "seed " << kCellSeed;
  EXPECT_NEAR(after_one, kCount / 4.0, 6 * std::sqrt(kCount * 3 / 16.0)) << "seed " << kCellSeed;
  EXPECT_EQ(std::ranges::count(apart.passed, true, &Passage::is_lost), 0);

  Cell close(wifi);
  delays_us(close, hop, 100, 10);
  EXPECT_TRUE(std::ranges::is_sorted(close.passed, {}, &Passage::ticket));
  EXPECT_FALSE(std::ranges::is_sorted(delays));
}

TEST(WifiCellTest, BurstsHitBothDirectionsAtTheSameTimes) {
  scenarios::Wifi wifi = quiet_cell();
  wifi.busy = {.rate_hz = 0.5, .duration_exponential_ms = 1000, .latency_ms = 1000};
  Cell cell(wifi);
  constexpr std::uint32_t kInstants = 4'000;
  constexpr double kApartMs = 60'000;
  for (std::uint32_t i = 0; i < kInstants; ++i) {
    cell.send_at(at_ms(i * kApartMs), {.ticket = 2 * i, .station = 1, .is_up = true});
    cell.send_at(at_ms(i * kApartMs), {.ticket = 2 * i + 1, .station = 1, .is_up = false});
  }
  cell.run();
  std::vector<double> delay_ms(2 * kInstants);
  for (const Passage& passage : cell.passed) {
    delay_ms[passage.ticket] = ms_of(passage.at) - passage.ticket / 2 * kApartMs;
  }
  int hit = 0;
  int apart = 0;
  double wait_ms = 0;
  for (std::uint32_t i = 0; i < kInstants; ++i) {
    const bool up = delay_ms[2 * i] > 1;
    const bool down = delay_ms[2 * i + 1] > 1;
    hit += up ? 1 : 0;
    apart += up != down ? 1 : 0;
    wait_ms += up ? delay_ms[2 * i] : 0;
  }
  const double share = 1 - std::exp(-0.5);
  EXPECT_NEAR(hit, kInstants * share, 6 * std::sqrt(kInstants * share * (1 - share)))
      << "seed " << kCellSeed;
  // A wait of less than 1 ms, once in a thousand, is not told from none.
  EXPECT_LE(apart, 20) << "seed " << kCellSeed;
  EXPECT_NEAR(wait_ms / hit, 1000, 6 * 1000 / std::sqrt(hit)) << "seed " << kCellSeed;
}

TEST(WifiCellTest, ForeignTrafficKeepsStationsWaitingBesideEachOther) {
  scenarios::Wifi wifi = fixed_cell();
  wifi.busy = {.rate_hz = 1e4, .duration_exponential_ms = 1e6, .latency_ms = 100};  // always
  std::vector<double> last_ms;
  for (std::uint32_t run = 0; run < 200; ++run) {
    Cell cell(wifi, kCellSeed + run);
    for (std::uint32_t i = 0; i < 8; ++i) {
      cell.send_at(at_ms(0), {.ticket = i, .station = i, .is_up = true});
    }
    cell.run();
    last_ms.push_back(ms_of(cell.passed.back().at));
  }
  // The mean of the largest of eight is the eighth harmonic number, its variance below 1.6.
  EXPECT_NEAR(mean_of(last_ms), 271.8, 6 * 100 * std::sqrt(1.6 / 200));
}

TEST(WifiCellTest, WhatIsForASleepingStationWaitsForTheBeacon) {
  for (const std::int64_t dtim_period : {1, 3}) {
    scenarios::Wifi wifi = fixed_cell();
    wifi.power_save = power_save(dtim_period);
    Cell cell(wifi);
    const std::vector<double> delays = delays_us(cell, {.station = 1, .bytes = 100}, 4'000, 1017.3);
    const double air_us = kDifsUs + frame_us(100);
    EXPECT_GE(*std::ranges::min_element(delays), air_us);
    expect_uniform(delays, air_us, air_us + 102.4e3 * static_cast<double>(dtim_period));
  }
}

TEST(WifiCellTest, TheWayFromASleepingStationTakesItsWakeUp) {
  scenarios::Wifi wifi = fixed_cell();
  wifi.power_save = power_save();
  Cell cell(wifi);
  for (const double delay :
       delays_us(cell, {.station = 1, .is_up = true, .bytes = 100}, 100, 1017.3)) {
    ASSERT_NEAR(delay, 2000 + kDifsUs + frame_us(100), 1e-2);
  }
}

// Messages each 90 ms keep a station awake for 100: only the first one meets it asleep.
TEST(WifiCellTest, AChattyStationSeesNothingOfPowerSave) {
  scenarios::Wifi wifi = fixed_cell();
  wifi.power_save = power_save();
  for (const bool is_up : {true, false}) {
    Cell cell(wifi);
    std::vector<double> delays =
        delays_us(cell, {.station = 1, .is_up = is_up, .bytes = 100}, 100, 90);
    EXPECT_GT(delays.front(), 500 + kDifsUs + frame_us(100));
    delays.erase(delays.begin(), delays.begin() + 2);  // the second may queue behind the first
    for (const double delay : delays) ASSERT_NEAR(delay, kDifsUs + frame_us(100), 1e-2);
  }
}

TEST(WifiCellTest, AStationThatSendsGetsWhatIsHeldForIt) {
  scenarios::Wifi wifi = fixed_cell();
  wifi.power_save = power_save();
  Cell cell(wifi);
  const TrueTime beacon = cell.cell().next_beacon(at_ms(5000));
  EXPECT_EQ(cell.cell().next_beacon(beacon), beacon + from_ms(102.4));
  cell.send_at(beacon + from_ms(5), {.ticket = 0, .station = 1, .bytes = 100});
  cell.send_at(beacon + from_ms(6), {.ticket = 1, .station = 2, .bytes = 100});
  cell.send_at(beacon + from_ms(20), {.ticket = 2, .station = 1, .is_up = true, .bytes = 100});
  cell.send_at(beacon + from_ms(21), {.ticket = 3, .station = 1, .bytes = 100});
  cell.run();
  ASSERT_EQ(cell.passed.size(), 4u);
  std::vector<double> after_ms(4);
  for (const Passage& passage : cell.passed) {
    after_ms[passage.ticket] = to_ms(passage.at - beacon);
  }
  EXPECT_NEAR(after_ms[0], 22, 0.5);  // awake at 22
  EXPECT_NEAR(after_ms[2], 22, 0.5);
  EXPECT_NEAR(after_ms[3], 22, 0.5);
  EXPECT_GT(after_ms[3], after_ms[0]);
  EXPECT_NEAR(after_ms[1], 102.4, 0.5) << "the other station sleeps on";
}

TEST(WifiCellTest, AGroupHasOneFrameAtTheBasicRateAfterTheBeacon) {
  scenarios::Wifi wifi = fixed_cell();
  const WifiHop hop{.is_group = true, .bytes = 100};
  const double air_us = kDifsUs + 20 + 8 * 124 / 6.0;
  Cell awake(wifi);
  for (const double delay : delays_us(awake, hop, 10, 100)) ASSERT_NEAR(delay, air_us, 1e-2);
  wifi.power_save = power_save(2);
  Cell asleep(wifi);
  expect_uniform(delays_us(asleep, hop, 2'000, 1017.3), air_us, air_us + 2 * 102.4e3);
  wifi.power_save.reset();
  wifi.collision_probability = 0.25;
  Cell disturbed(wifi);
  delays_us(disturbed, hop, 4'000, 100);
  EXPECT_NEAR(static_cast<double>(std::ranges::count(disturbed.passed, true, &Passage::is_lost)),
              1000, 6 * std::sqrt(4'000 * 3 / 16.0))
      << "one attempt, seed " << kCellSeed;
}

TEST(WifiCellTest, DrawsDependOnTheMessageAlone) {
  scenarios::Wifi wifi = quiet_cell();
  wifi.collision_probability = 0.3;
  const WifiHop hop{.station = 1, .is_up = true, .bytes = 100};
  Cell one(wifi);
  const std::vector<double> delays = delays_us(one, hop, 200, 100);
  Cell same(wifi);
  EXPECT_EQ(delays_us(same, hop, 200, 100), delays);
  Cell other(wifi, kCellSeed + 1);
  EXPECT_NE(delays_us(other, hop, 200, 100), delays);
  Cell with_more(wifi);
  for (std::uint32_t i = 0; i < 200; ++i) {
    with_more.send_at(at_ms(i * 100.0 + 50), {.ticket = 1000 + i, .station = 2});
  }
  for (std::uint32_t i = 0; i < 200; ++i) {
    with_more.send_at(at_ms(i * 100.0), {.ticket = i, .station = 1, .is_up = true, .bytes = 100});
  }
  with_more.run();
  std::vector<double> beside;
  for (const Passage& passage : with_more.passed) {
    if (passage.ticket >= 1000) continue;
    beside.push_back(to_us(passage.at - at_ms(passage.ticket * 100.0)));
  }
  EXPECT_EQ(beside, delays);
}

// Latency 1 ms and the cell.
scenarios::Network network_with(const scenarios::Wifi& wifi) {
  scenarios::Network network = plain_network();
  network.wifi = wifi;
  return network;
}

constexpr double kHopMs = (kDifsUs + frame_us(100)) * 1e-3;
constexpr double kAckMs = kAckUs * 1e-3;

// Hosts 0 (the access point) and 7 (on its wire), 1 and 2 stations.
TEST(WifiNetworkTest, AMessagePassesTheAirOncePerStation) {
  scenarios::Wifi wifi = fixed_cell();
  wifi.access_point_host = 0;
  wifi.wired_hosts = {7};
  scenarios::Network parameters = network_with(wifi);
  parameters.bandwidth_mbit_per_s = 10;  // 100 bytes: 0.08 ms
  for (const Transport transport : {Transport::kStream, Transport::kDatagram}) {
    World world(parameters);
    const auto arrival_ms = [&](double at, PeerId from, PeerId to) -> Probe& {
      Probe& receiver = world.probe(to, from, transport);
      world.send_at(at, world.probe(from, to, transport), 1, 100);
      return receiver;
    };
    const Probe& between_stations = arrival_ms(10, 1, 2);
    const Probe& to_access_point = arrival_ms(20, 1, 0);
    const Probe& from_access_point = arrival_ms(30, 0, 2);
    const Probe& to_wire = arrival_ms(40, 2, 7);
    const Probe& from_wire = arrival_ms(50, 7, 1);
    const Probe& on_wire = arrival_ms(60, 0, 7);
    world.run();
    EXPECT_NEAR(between_stations.arrived.at(0).at_ms, 10 + 2 * kHopMs + kAckMs + 1, 1e-4);
    EXPECT_NEAR(to_access_point.arrived.at(0).at_ms, 20 + kHopMs + 1, 1e-4);
    EXPECT_NEAR(from_access_point.arrived.at(0).at_ms, 30 + kHopMs + 1, 1e-4);
    EXPECT_NEAR(to_wire.arrived.at(0).at_ms, 40 + kHopMs + 0.08 + 1, 1e-4);
    EXPECT_NEAR(from_wire.arrived.at(0).at_ms, 50 + 0.08 + kHopMs + 1, 1e-4);
    EXPECT_NEAR(on_wire.arrived.at(0).at_ms, 60 + 2 * 0.08 + 1, 1e-4);
  }
}

TEST(WifiNetworkTest, HeadersGoOverTheAirToo) {
  scenarios::Wifi wifi = fixed_cell();
  wifi.access_point_host = 0;
  scenarios::Network parameters = network_with(wifi);
  parameters.overhead_bytes = 66;
  World world(parameters);
  Probe& station = world.probe(1, 0);
  Probe& access_point = world.probe(0, 1);
  world.send_at(0, station, 1, 100);
  world.run();
  EXPECT_NEAR(access_point.arrived.at(0).at_ms, (kDifsUs + frame_us(166)) * 1e-3 + 1, 1e-4);
}

TEST(WifiNetworkTest, AfterTheRetryLimitDatagramsAreLostAndStreamsBreak) {
  scenarios::Wifi wifi = quiet_cell();
  wifi.collision_probability = 1;
  for (const Transport transport : {Transport::kStream, Transport::kDatagram}) {
    World world(network_with(wifi));
    Probe& sender = world.probe(1, 2, transport);
    Probe& receiver = world.probe(2, 1, transport);
    for (int i = 0; i < 3; ++i) world.send_at(i, sender, 1);
    world.run();
    EXPECT_TRUE(receiver.arrived.empty());
    EXPECT_EQ(sender.left_ms.size(), 3u);
  }
  wifi.collision_probability = 0.5;
  wifi.retry_limit = 2;
  World world(network_with(wifi));
  Probe& stream = world.probe(1, 2);
  Probe& stream_end = world.probe(2, 1);
  Probe& datagrams = world.probe(3, 4, Transport::kDatagram);
  Probe& datagrams_end = world.probe(4, 3, Transport::kDatagram);
  std::vector<std::uint8_t> all;
  for (std::uint8_t i = 0; i < 250; ++i) {
    world.send_at(i * 10, stream, i);
    world.send_at(i * 10, datagrams, i);
    all.push_back(i);
  }
  world.run();
  EXPECT_EQ(numbers(stream_end.arrived), all);
  // Each of two ways loses a quarter.
  EXPECT_NEAR(static_cast<double>(datagrams_end.arrived.size()), 250 * 9 / 16.0,
              6 * std::sqrt(250 * 63 / 256.0))
      << "seed " << kNetworkSeed;
}

// From a station up, then once to all stations; to the access point and its wire without the
// second.
TEST(WifiNetworkTest, AGroupHasOneTransmissionEachWay) {
  scenarios::Wifi wifi = fixed_cell();
  wifi.access_point_host = 0;
  wifi.wired_hosts = {7};
  World world(network_with(wifi));
  std::vector<Probe*> senders;
  std::vector<Probe*> members;
  for (const PeerId to : {0u, 2u, 3u, 7u}) {
    senders.push_back(&world.probe(1, to, Transport::kDatagram));
    members.push_back(&world.probe(to, 1, Transport::kDatagram));
  }
  world.send_to_group_at(0, *senders[0], senders, 9, 100);
  world.run();
  const double down_ms = (kDifsUs + 20 + 8 * 124 / 6.0) * 1e-3;
  const double twice_ms = kHopMs + kAckMs + down_ms;
  const std::vector<double> expected_ms = {kHopMs, twice_ms, twice_ms, kHopMs};
  for (std::size_t i = 0; i < members.size(); ++i) {
    ASSERT_EQ(members[i]->arrived.size(), 1u) << "member " << i;
    EXPECT_NEAR(members[i]->arrived[0].at_ms, 1 + expected_ms[i], 1e-4) << "member " << i;
  }
  EXPECT_EQ(senders[0]->left_ms, std::vector<double>{0});
}

TEST(WifiNetworkTest, ALostGroupIsLostForAllStations) {
  scenarios::Wifi wifi = fixed_cell();
  wifi.access_point_host = 0;
  wifi.collision_probability = 1;
  World world(network_with(wifi));
  std::vector<Probe*> senders;
  std::vector<Probe*> members;
  for (const PeerId to : {1u, 2u}) {
    senders.push_back(&world.probe(0, to, Transport::kDatagram));
    members.push_back(&world.probe(to, 0, Transport::kDatagram));
  }
  world.send_to_group_at(0, *senders[0], senders, 9, 100);
  world.run();
  for (const Probe* member : members) EXPECT_TRUE(member->arrived.empty());
}

// The leader asks once a second, the sleeping phone answers: the way out takes half a beacon
// interval longer on the mean, the way back only the wake-up that is over by then.
TEST(WifiNetworkTest, PowerSaveMakesAPollOfASleepingStationAsymmetric) {
  scenarios::Wifi wifi = fixed_cell();
  wifi.access_point_host = 0;
  wifi.power_save = power_save();
  World world(network_with(wifi));
  Probe& leader = world.probe(0, 1, Transport::kDatagram);
  Probe& phone = world.probe(1, 0, Transport::kDatagram);
  for (int i = 0; i < 200; ++i) {
    world.send_at(i * 1017.3, leader, 1);
    world.send_at(i * 1017.3 + 150, phone, 2);  // after the beacon, before it sleeps again
  }
  world.run();
  double out_ms = 0;
  double back_ms = 0;
  ASSERT_EQ(phone.arrived.size(), 200u);
  ASSERT_EQ(leader.arrived.size(), 200u);
  for (std::size_t i = 0; i < 200; ++i) {
    const double sent_ms = static_cast<double>(i) * 1017.3;
    out_ms += (phone.arrived[i].at_ms - sent_ms) / 200;
    back_ms += (leader.arrived[i].at_ms - sent_ms - 150) / 200;
  }
  EXPECT_NEAR(out_ms - 1, 51.2, 6 * 102.4 / std::sqrt(12.0 * 200)) << "seed " << kNetworkSeed;
  EXPECT_LT(back_ms - 1, 2.2);
}

}  // namespace
}  // namespace simbench::sim

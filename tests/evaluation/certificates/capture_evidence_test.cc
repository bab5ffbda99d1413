#include "evaluation/certificates/capture_evidence.h"

#include <gmock/gmock.h>

#include "evaluation/certificates/certify.h"
#include "recording/event.h"

namespace simbench::evaluation {
namespace {

using testing::DoubleNear;
using testing::SizeIs;

constexpr std::uint32_t kHosts = 2;

SteadyTime steady(double ms) { return SteadyTime(from_ms(ms)); }
HostTime system(double ms) { return HostTime(from_ms(ms)); }

// Two hosts with a camera each, whose clocks are read to the microsecond at once; their system
// clocks show 1000 s more than the steady ones.
CaptureEvidence evidence_of(const Assumptions& assumed) {
  CaptureEvidence evidence(assumed, StreamKind::kDepth);
  RigLayout layout{.hosts = kHosts, .cameras = {{0}, {1}}, .frame_rate_hz = 10};
  evidence.on_start(layout);
  for (std::uint32_t host = 0; host < kHosts; ++host) {
    evidence.on_event(ClockAdjustment{host, steady(0), system(1e6), system(1e6), 0});
    evidence.on_event(DevicePoll{host, {100'000}, {}, {}, steady(100), steady(100.001)});
    FrameRecord frame;
    frame.camera = host;
    frame.exposure_us = 1000;
    frame.sensor = {100'000};
    frame.arrival_steady = steady(3000);
    evidence.on_frame(frame, nullptr);
  }
  return evidence;
}

double apart_ms(const CaptureEvidence& evidence) {
  const FactOrder order(evidence);
  const std::vector<EvidenceSet> sets = {{0, 1}};
  const CertifiedCapture found = certify(evidence, order, sets, Horizon::kWhole);
  EXPECT_FALSE(found.contradiction);
  const Picoseconds apart = found.sets.front().apart;
  return ClockGraph::is_bounded(apart) ? to_ms(apart) : -1;
}

PulseSighting pulse(std::uint32_t host, double ms, double gnss_s) {
  return {host, steady(ms), from_ms(gnss_s * 1e3)};
}

// Both hosts see the second within 0.2 ms of it, so their clocks are within 0.2 ms of each other.
TEST(CaptureEvidence, PulsesTieHostsByTheirLateness) {
  Assumptions assumed;
  CaptureEvidence without = evidence_of(assumed);
  without.on_event(pulse(0, 100, 5));
  EXPECT_EQ(without.counts().unused_pulses, 1U);
  EXPECT_EQ(apart_ms(without), -1);
  assumed.pulse_late_us = 200;
  CaptureEvidence with = evidence_of(assumed);
  with.on_event(pulse(0, 100, 5));
  EXPECT_EQ(apart_ms(with), -1);  // one host alone
  with.on_event(pulse(1, 100, 5));
  EXPECT_EQ(with.counts().pulses, 2U);
  EXPECT_THAT(with.outside_clocks(), SizeIs(1));
  EXPECT_THAT(apart_ms(with), DoubleNear(0.2, 0.006));
}

// Pulses half a second apart by both clocks: another second than was announced.
TEST(CaptureEvidence, PulsesThatContradictAreFound) {
  Assumptions assumed;
  assumed.pulse_late_us = 200;
  CaptureEvidence evidence = evidence_of(assumed);
  evidence.on_event(pulse(0, 100, 5));
  evidence.on_event(pulse(0, 600, 6));
  const FactOrder order(evidence);
  const std::vector<EvidenceSet> sets = {{0, 1}};
  EXPECT_TRUE(certify(evidence, order, sets, Horizon::kWhole).contradiction);
}

LoggedExchange logged(double t1_ms, double t2_ms, double t4_ms) {
  LoggedExchange exchange{.server = "192.0.2.1"};
  exchange.t1 = system(1e6 + t1_ms);
  exchange.t2 = exchange.t3 = system(t2_ms);
  exchange.t4 = system(1e6 + t4_ms);
  return exchange;
}

// The server's clock shows 7 s at 100 ms; each host asks for it within 1 ms there and back.
TEST(CaptureEvidence, LoggedExchangesTieHostsThroughTheirServer) {
  CaptureEvidence evidence = evidence_of({});
  ExchangeLog log;
  log.exchanges = {logged(99.5, 7000, 100.5)};
  evidence.add(0, log, {});
  EXPECT_EQ(apart_ms(evidence), -1);
  evidence.add(1, log, {});
  EXPECT_EQ(evidence.counts().messages, 4U);
  ASSERT_THAT(evidence.outside_clocks(), SizeIs(1));
  EXPECT_EQ(evidence.outside_clocks().front().name, "192.0.2.1");
  EXPECT_THAT(apart_ms(evidence), DoubleNear(1.0, 0.006));
}

// The server is host 0, so its stamps are of that host's system clock.
TEST(CaptureEvidence, AServerMayBeAHost) {
  CaptureEvidence evidence = evidence_of({});
  ExchangeLog log;
  log.exchanges = {logged(99.5, 1e6 + 100, 100.5)};
  evidence.add(1, log, {{"192.0.2.1", 0}});
  EXPECT_THAT(evidence.outside_clocks(), SizeIs(0));
  EXPECT_THAT(apart_ms(evidence), DoubleNear(0.5, 0.006));
}

// Estimates count once their error is stated, times in whole seconds cost the clocks' drift in
// them, and what was logged before or after is left out.
TEST(CaptureEvidence, LogsCountAsFarAsTheyAreSure) {
  ExchangeLog log;
  log.exchanges = {logged(1500, 1e6 + 1500, 1501)};
  log.exchanges.front().is_estimated = true;
  log.exchanges.front().common_error = std::chrono::seconds(1);
  CaptureEvidence without = evidence_of({});
  without.add(1, log, {{"192.0.2.1", 0}});
  EXPECT_EQ(without.counts().estimated_exchanges, 1U);
  EXPECT_EQ(apart_ms(without), -1);
  Assumptions assumed;
  assumed.estimated_stamp_ms = 0.01;
  CaptureEvidence with = evidence_of(assumed);
  with.add(1, log, {{"192.0.2.1", 0}});
  // A way of 1 ms, two errors of 10 us, 1.4 s of drift and a second more, 100 ppm each.
  EXPECT_THAT(apart_ms(with), DoubleNear(1 + 0.02 + 0.14 + 0.1, 0.01));
  log.exchanges = {logged(90'000, 1e6 + 90'000, 90'001)};
  with.add(1, log, {{"192.0.2.1", 0}});
  EXPECT_EQ(with.counts().logged_outside, 1U);
}

}  // namespace
}  // namespace simbench::evaluation

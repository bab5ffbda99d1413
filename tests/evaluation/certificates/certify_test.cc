#include "evaluation/certificates/certify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/certificates/clock_graph.h"
#include "evaluation/certificates/contradiction.h"
#include "evaluation/certificates/frontier.h"
#include "evaluation/run/ad_hoc_pipelines.h"
#include "evaluation/run/certificate_run.h"
#include "evaluation/run/pipeline_choice.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"

namespace simbench::evaluation {
namespace {

SteadyTime steady_us(std::int64_t us) { return SteadyTime(Microseconds(us)); }

// Clocks without an error, and stamps that are exact but for the register's step.
Assumptions exact_assumptions() {
  Assumptions assumed;
  assumed.host_rate_ppm = assumed.camera_rate_ppm = 0;
  assumed.host_stamp_ms = assumed.arrival_stamp_ms = 0;
  assumed.sensor_stamp_us = 0;
  return assumed;
}

RigLayout bare_rig(std::uint32_t hosts, std::vector<CameraLayout> cameras) {
  return {.hosts = hosts, .cameras = std::move(cameras), .frame_rate_hz = 30};
}

void add_poll(CaptureEvidence& evidence, std::uint32_t camera, std::uint32_t device_us,
              std::int64_t t0_us, std::int64_t t1_us) {
  evidence.on_event(DevicePoll{.camera = camera,
                               .device = {device_us},
                               .t0_steady = steady_us(t0_us),
                               .t1_steady = steady_us(t1_us)});
}

void add_frame(CaptureEvidence& evidence, std::uint32_t camera, std::uint32_t sensor_us,
               std::int64_t arrival_us) {
  FrameRecord frame;
  frame.camera = camera;
  frame.sensor = {sensor_us};
  frame.arrival_steady = steady_us(arrival_us);
  evidence.on_frame(frame, nullptr);
}

// Two cameras of a host, each read once within 600 us: by symmetry the frames, which both clocks
// have at the time of their reading, are within 600 us of each other, a register's step and the
// nanosecond of the host's readings more.
TEST(Certify, TwoPollsOfOneHostBoundTwoFrames) {
  CaptureEvidence evidence(exact_assumptions(), StreamKind::kDepth);
  evidence.on_start(bare_rig(1, {{0}, {0}}));
  add_poll(evidence, 0, 5'000, 1'000, 1'600);
  add_poll(evidence, 1, 90'000, 1'000, 1'600);
  add_frame(evidence, 0, 5'000, 40'000);
  add_frame(evidence, 1, 90'000, 40'000);
  const FactOrder order(evidence);
  const CertifiedCapture found =
      certify(evidence, order, std::vector<EvidenceSet>{{0, 1}}, Horizon::kWhole);
  ASSERT_FALSE(found.contradiction);
  ASSERT_EQ(found.sets.size(), 1U);
  EXPECT_EQ(found.sets[0].apart, Picoseconds(from_us(602) + Nanoseconds(2)));
  EXPECT_EQ(found.sets[0].weakest.kind, LinkKind::kCamera);
}

// A message each way between two hosts whose clocks differ by an hour: 0.2 ms there and back.
TEST(Certify, MessagesTieHosts) {
  CaptureEvidence evidence(exact_assumptions(), StreamKind::kDepth);
  evidence.on_start(bare_rig(2, {{0}, {1}}));
  for (std::uint32_t host : {0U, 1U}) {
    evidence.on_event(ClockAdjustment{.host = host,
                                      .at = steady_us(0),
                                      .before = HostTime(Microseconds(host * 3'600'000'000)),
                                      .after = HostTime(Microseconds(host * 3'600'000'000))});
  }
  const auto on = [](std::uint32_t host, std::int64_t us) {
    return HostTime(Microseconds(host * 3'600'000'000 + us));
  };
  evidence.on_event(ExchangeEvent{
      1, {.peer = 0, .t1 = on(1, 1000), .t2 = on(0, 1100), .t3 = on(0, 1100), .t4 = on(1, 1200)}});
  add_poll(evidence, 0, 70'000, 2'000, 2'000);
  add_poll(evidence, 1, 80'000, 2'000, 2'000);
  add_frame(evidence, 0, 70'000, 40'000);
  add_frame(evidence, 1, 80'000, 40'000);
  ASSERT_EQ(evidence.messages().size(), 2U);
  const FactOrder order(evidence);
  const CertifiedCapture found =
      certify(evidence, order, std::vector<EvidenceSet>{{0, 1}}, Horizon::kWhole);
  ASSERT_EQ(found.sets.size(), 1U);
  EXPECT_NEAR(to_ms(found.sets[0].apart), 0.1, 0.003);
  EXPECT_EQ(found.sets[0].weakest.kind, LinkKind::kHosts);
}

TEST(Certify, WithoutPollsNothingIsKnown) {
  CaptureEvidence evidence(exact_assumptions(), StreamKind::kDepth);
  evidence.on_start(bare_rig(1, {{0}, {0}}));
  add_frame(evidence, 0, 5'000, 40'000);
  add_frame(evidence, 1, 90'000, 40'000);
  const FactOrder order(evidence);
  const CertifiedCapture found =
      certify(evidence, order, std::vector<EvidenceSet>{{0, 1}}, Horizon::kWhole);
  EXPECT_EQ(found.sets[0].apart, ClockGraph::kUnbounded);
}

// A clock that is read twice and ran 200 ppm too fast between cannot be within 50.
TEST(Certify, AClockThatIsTooFastIsProved) {
  Assumptions assumed = exact_assumptions();
  assumed.host_rate_ppm = assumed.camera_rate_ppm = 50;
  CaptureEvidence evidence(assumed, StreamKind::kDepth);
  evidence.on_start(bare_rig(1, {{0}}));
  add_poll(evidence, 0, 0, 0, 100);
  add_poll(evidence, 0, 10'003'000, 10'000'000, 10'000'100);
  const FactOrder order(evidence);
  const CertifiedCapture found = certify(evidence, order, {}, Horizon::kWhole);
  ASSERT_TRUE(found.contradiction);
  const Contradiction proof = contradiction_of(order, *found.contradiction);
  ASSERT_EQ(proof.facts.size(), 2U);
  EXPECT_EQ(order.facts()[proof.facts[0]].kind, FactKind::kPollRequest);
  EXPECT_EQ(order.facts()[proof.facts[1]].kind, FactKind::kPollReply);
  // 3 ms gained, of which 1 ms is allowed, and 0.1 ms of a round trip on either side.
  EXPECT_NEAR(to_ms(proof.before), 1.9, 0.01);
  EXPECT_EQ(possible_rate_ppm(evidence), 200.0);
}

TEST(Certify, ACommonTriggerLeavesWholePeriods) {
  const CommonTrigger trigger{.period_ms = 22, .rate_error_ppm = 0, .spread_ms = 0.05};
  const auto ms = [](double value) { return Picoseconds(static_cast<std::int64_t>(value * 1e9)); };
  const auto narrow = narrowed({0, 1, ms(-0.8), ms(0.9)}, trigger);
  ASSERT_TRUE(narrow);
  EXPECT_EQ(narrow->least, ms(-0.05));
  EXPECT_EQ(narrow->most, ms(0.05));
  const auto one_off = narrowed({0, 1, ms(21), ms(23)}, trigger);
  ASSERT_TRUE(one_off);
  EXPECT_NEAR(to_ms(one_off->least), 21.95, 1e-9);
  EXPECT_NEAR(to_ms(one_off->most), 22.05, 1e-9);
  const auto either = narrowed({0, 1, ms(-1), ms(30)}, trigger);
  ASSERT_TRUE(either);
  EXPECT_EQ(either->least, ms(-0.05));
  EXPECT_NEAR(to_ms(either->most), 22.05, 1e-9);
  EXPECT_FALSE(narrowed({0, 1, ms(5), ms(6)}, trigger));
  const PairInterval unknown{0, 1, -ClockGraph::kUnbounded, ClockGraph::kUnbounded};
  EXPECT_EQ(narrowed(unknown, trigger)->most, ClockGraph::kUnbounded);
}

// The capture of a small world, with its sets.
struct SmallWorld {
  explicit SmallWorld(const std::vector<std::string>& changes) {
    std::vector<scenarios::Override> overrides = {{"/timeline/frames", "4"},
                                                  {"/timeline/warm_up_ms", "100"},
                                                  {"/timeline/wait_before_capture_ms", "0"},
                                                  {"/cameras/count", "6"},
                                                  {"/hosts/count", "2"}};
    for (std::size_t i = 0; i + 1 < changes.size(); i += 2) {
      overrides.push_back({changes[i], changes[i + 1]});
    }
    scenario = scenarios::load_scenario(
        "18cam_6host_45fps_lan",
        with_ad_hoc_pipelines("18cam_6host_45fps_lan", overrides, {"two_way_hull"}));
  }

  // Its stamps are estimates of its clocks, which nobody else sets.
  Assumptions assumptions() const {
    Assumptions assumed = assumptions_of(scenario);
    assumed.estimated_stamp_ms = 0.02;
    return assumed;
  }

  CertificateRun run(std::uint64_t seeds, Horizon horizon = Horizon::kWhole) const {
    return run(seeds, assumptions(), horizon);
  }

  CertificateRun run(std::uint64_t seeds, const Assumptions& assumed,
                     Horizon horizon = Horizon::kWhole) const {
    const CertificateOptions options{
        .pipelines = {"two_way_hull"}, .seeds = seeds, .horizon = horizon, .assumptions = assumed};
    return certify_pipelines(
        scenario, [&] { return sim::make_simulation(scenario); }, options, nullptr);
  }

  scenarios::Scenario scenario;
};

// The intervals are the shortest paths over all points of the recording.
TEST(Certify, IntervalsAreShortestPathsOfTheWholeGraph) {
  const SmallWorld world({});
  const PipelineChoice choice = choose_pipelines(world.scenario, {"two_way_hull"}).front();
  CaptureEvidence evidence(world.assumptions(), StreamKind::kDepth);
  record_run(*sim::make_simulation(world.scenario), choice, 1, evidence);
  // A frame of each camera, near each other, in three sets.
  std::vector<EvidenceSet> sets(3);
  std::vector<std::size_t> taken(6);
  for (std::size_t i = 0; i < evidence.frames().size(); ++i) {
    const std::size_t number = taken[evidence.frames()[i].camera]++;
    if (number < sets.size()) sets[number].push_back(i);
  }
  const FactOrder order(evidence);
  const std::size_t points = order.points().size();
  ASSERT_LT(points, 6000U);
  // From the least instant of each frame of the sets, by relaxing until nothing changes.
  std::map<std::uint32_t, std::vector<std::int64_t>> known;
  const auto ways_from = [&](std::uint32_t start) -> const std::vector<std::int64_t>& {
    std::vector<std::int64_t>& way = known[start];
    if (!way.empty()) return way;
    way.assign(points, Distances::kFar);
    way[start] = 0;
    for (bool is_changed = true; is_changed;) {
      is_changed = false;
      const auto offer = [&](std::size_t from, std::size_t to, Picoseconds most) {
        if (way[from] >= Distances::kFar || way[from] + most.count() >= way[to]) return;
        way[to] = way[from] + most.count();
        is_changed = true;
      };
      std::vector<std::optional<std::size_t>> last(order.clocks());
      for (std::size_t i = 0; i < points; ++i) {
        const ClockPoint& here = order.points()[i];
        if (const auto before = std::exchange(last[here.clock], i)) {
          const Nanoseconds step = here.local - order.points()[*before].local;
          offer(*before, i, order.rates()[here.clock].most(step));
          offer(i, *before, -order.rates()[here.clock].least(step));
        }
      }
      for (const ClockFact& fact : order.facts()) offer(fact.from, fact.to, fact.most);
    }
    return way;
  };
  std::size_t pairs = 0;
  certify(evidence, order, sets, Horizon::kWhole, [&](std::size_t set, const PairInterval& pair) {
    const FramePoints& first = order.points_of(sets[set][pair.first]);
    const FramePoints& second = order.points_of(sets[set][pair.second]);
    EXPECT_EQ(pair.most.count(), ways_from(first.least)[second.most]);
    EXPECT_EQ(pair.least.count(), -ways_from(second.least)[first.most]);
    ++pairs;
  });
  EXPECT_EQ(pairs, 3U * 15U);
}

// What comes later can only narrow an interval.
TEST(Certify, HindsightNeverWidens) {
  const SmallWorld world({"/timeline/frames", "60"});
  const CertificateRow whole = world.run(2).rows.front();
  const CertificateRow causal = world.run(2, Horizon::kCausal).rows.front();
  ASSERT_EQ(whole.apart_ms.size(), causal.apart_ms.size());
  for (std::size_t i = 0; i < whole.apart_ms.size(); ++i) {
    EXPECT_LE(whole.apart_ms[i], causal.apart_ms[i]);
  }
  EXPECT_LT(whole.certified_ms(1), 5.0);
}

// Whatever else goes wrong in the world, the truth lies within.
TEST(Certify, TheTruthLiesWithin) {
  const std::vector<std::vector<std::string>> worlds = {
      {},
      {"/network/loss_probability", "0.2", "/usb/spike_probability", "0.2"},
      {"/hosts/clock/initial_offset_sigma_ms", "30000"},
      {"/hosts/clock/tick_ms", "15.625", "/hosts/clock/resolution_ms", "1"},
      {"/cameras/drop_probability", "0.1", "/cameras/clock_epoch_max_ms", "4294967"},
      {"/hosts/load_burst/rate_hz", "2", "/hosts/load_burst/duration_exponential_ms", "100",
       "/hosts/load_burst/latency_ms", "20"}};
  for (const std::vector<std::string>& changes : worlds) {
    const CertificateRow row = SmallWorld(changes).run(8).rows.front();
    EXPECT_GT(row.frames, 0U);
    EXPECT_EQ(row.frames_outside, 0U) << (changes.empty() ? "" : changes.front());
    EXPECT_TRUE(row.contradicted.empty()) << (changes.empty() ? "" : changes.front());
  }
}

// A rig whose cameras' clocks nobody read has no bound that the truth could break: no frame counts
// as one for which it lies within.
TEST(Certify, WhatHasNoBoundProvesNothing) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario("18cam_6host_45fps", {{"/timeline/frames", "4"}});
  ASSERT_EQ(scenario.cameras.clock_poll.interval_ms, 0);
  const CertificateOptions options{.pipelines = {"yoon2021_both"}};
  const CertificateRun run = certify_pipelines(
      scenario, [&] { return sim::make_simulation(scenario); }, options, nullptr);
  const CertificateRow& row = run.rows.front();
  ASSERT_GT(row.apart_ms.size(), 0U);
  EXPECT_TRUE(std::isinf(row.apart_ms.front()));
  EXPECT_EQ(row.frames, 0U);
}

// Exchanges whose stamps are estimates prove nothing until their error is stated.
TEST(Certify, EstimatedStampsAreLeftOut) {
  const SmallWorld world({});
  const CertificateRow without = world.run(1, assumptions_of(world.scenario)).rows.front();
  EXPECT_EQ(without.counts.messages, 0U);
  EXPECT_GT(without.counts.estimated_exchanges, 0U);
  EXPECT_TRUE(std::isinf(without.certified_ms(0)));
  const CertificateRow with = world.run(1).rows.front();
  EXPECT_EQ(with.counts.messages, 2 * without.counts.estimated_exchanges);
  EXPECT_EQ(with.counts.estimated_exchanges, 0U);
  EXPECT_TRUE(std::isfinite(with.certified_ms(1)));
}

// Quartzes of 200 ppm under an assumption of 50: found, not certified.
TEST(Certify, AWrongAssumptionIsFound) {
  const SmallWorld world({"/hosts/clock/skew_of_host_ppm", "[200,-200]", "/timeline/frames", "90"});
  Assumptions assumed = world.assumptions();
  EXPECT_GE(assumed.host_rate_ppm, 200);
  assumed.host_rate_ppm = 50;
  const CertificateRow row = world.run(1, assumed).rows.front();
  ASSERT_EQ(row.contradicted.size(), 1U);
  EXPECT_GE(row.contradicted.front().chain.size(), 2U);
  EXPECT_EQ(row.contradicted.front().possible_ppm, 200.0);
  EXPECT_TRUE(row.apart_ms.empty());
}

}  // namespace
}  // namespace simbench::evaluation

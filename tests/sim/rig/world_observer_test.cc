#include "recording/world_observer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/ports/capture_alignment.h"
#include "algorithms/ports/host_sync.h"
#include "algorithms/registry.h"
#include "scenarios/loader.h"
#include "tests/nonempty.h"
#include "tests/sim/rig/ideal_scenario.h"
#include "tests/sim/rig/kept_world.h"
#include "tests/sim/rig/test_world.h"
#include "tests/sim/rig/written_recording.h"

namespace simbench::sim {
namespace {

KeptWorld observe(const scenarios::Scenario& scenario, HostSync* host_sync = nullptr,
                  Nanoseconds interval = Nanoseconds(0)) {
  KeptWorld observed(interval);
  KeptLists kept;
  make_simulation(scenario)->record(
      {.seed = 1, .pipeline = "test", .host_sync = host_sync, .observer = &observed}, kept);
  return observed;
}

struct Choice {
  std::string scenario;
  std::string host_sync;
  std::string capture_alignment{};  // empty: none
};

std::unique_ptr<CaptureAlignment> alignment_of(const Choice& choice) {
  const CaptureAlignmentEntry* entry =
      find_algorithm<CaptureAlignmentEntry>(choice.capture_alignment);
  return entry == nullptr ? nullptr : entry->make(check_parameters(entry->info.parameters, {}));
}

TEST(WorldObserver, ARecordingIsTheSameWithAndWithout) {
  for (const Choice& choice :
       std::vector<Choice>{{"18cam_6host_45fps", "yoon2021_both"},
                           {"18cam_6host_45fps", "w32time_domain"},
                           {"18cam_6host_45fps_lan", "chrony"},
                           {"18cam_6host_45fps_lan", "oracle"},
                           {"18cam_6host_45fps_loss_and_reordering", "yoon2021_both"},
                           {"18cam_6host_45fps_clock_step_during_capture", "yoon2021_both"},
                           {"18cam_6host_45fps_frame_drops_10pct", "yoon2021_both"},
                           {"9cam_3host_30fps_azure_kinect", "yoon2021_neither"},
                           {"18cam_6host_30fps_without_trigger", "oracle", "phase_rate"}}) {
    SCOPED_TRACE(choice.scenario + ", " + choice.host_sync);
    const scenarios::Scenario scenario = scenarios::load_scenario(
        choice.scenario, {{"/timeline/frames", "20"}, {"/timeline/warm_up_ms", "500"}});
    const HostSyncEntry* entry = find_algorithm<HostSyncEntry>(choice.host_sync);
    ASSERT_NE(entry, nullptr);
    const auto record = [&](WorldObserver* observer, WrittenRecording& written) {
      const auto algorithm = entry->make(check_parameters(entry->info.parameters, {}));
      const auto alignment = alignment_of(choice);
      return make_simulation(scenario)->record({.seed = 3,
                                                .pipeline = choice.host_sync,
                                                .host_sync = algorithm.get(),
                                                .capture_alignment = alignment.get(),
                                                .observer = observer},
                                               written);
    };
    WrittenRecording without;
    WrittenRecording with;
    KeptWorld observed(from_ms(7.3));
    const RecordingCost cost_without = record(nullptr, without);
    const RecordingCost cost_with = record(&observed, with);
    EXPECT_TRUE(without.text == with.text);
    EXPECT_GT(with.text.size(), 10'000U);
    EXPECT_EQ(with.text.find("\nalignment,") != std::string::npos,
              !choice.capture_alignment.empty());
    EXPECT_FALSE(observed.frames.empty());
    EXPECT_FALSE(observed.clocks.empty());
    EXPECT_EQ(cost_with.events, cost_without.events);
    EXPECT_EQ(cost_with.trace_hash, cost_without.trace_hash);
  }
}

TEST(WorldObserver, AFrameIsToldWithItsWholeWay) {
  const KeptWorld observed = observe(ideal_scenario());
  EXPECT_EQ(observed.world_starts, std::vector<TrueTime>{TrueTime{}});
  EXPECT_EQ(observed.capture_starts, std::vector<TrueTime>{TrueTime(from_ms(100))});
  ASSERT_FALSE(observed.frames.empty());
  std::map<std::int64_t, TrueTime> pulses;
  for (const ObservedPulse& pulse : observed.pulses) pulses[pulse.pulse] = pulse.at;
  EXPECT_EQ(pulses.size(), observed.pulses.size());
  EXPECT_EQ(pulses.begin()->first, 0) << "the warm-up has pulses too";
  for (const ObservedFrame& frame : observed.frames) {
    EXPECT_EQ(frame.fate, FrameFate::kDelivered);
    EXPECT_EQ(frame.host, frame.camera);
    EXPECT_EQ(frame.exposure_start, pulses.at(frame.pulse));
    EXPECT_EQ(frame.exposure_end, frame.exposure_start + from_ms(4));
    EXPECT_EQ(frame.offered, frame.exposure_end + from_ms(8));
    EXPECT_EQ(frame.transferred, frame.offered + from_ms(2));
    EXPECT_EQ(frame.copied, frame.transferred);
    EXPECT_EQ(frame.delivered, frame.transferred);
  }
}

TEST(WorldObserver, FramesLostInCamerasAreReported) {
  scenarios::Scenario scenario = ideal_scenario();
  scenario.cameras.drop_probability = 0.5;
  const KeptWorld observed = observe(scenario);
  std::map<std::uint32_t, std::vector<std::uint32_t>> counters;
  std::map<FrameFate, std::size_t> fates;
  for (const ObservedFrame& frame : observed.frames) {
    ++fates[frame.fate];
    counters[frame.camera].push_back(frame.counter);
    EXPECT_EQ(frame.exposure_end, frame.exposure_start + from_ms(4));
  }
  EXPECT_GT(fates[FrameFate::kLostInCamera], observed.frames.size() / 3);
  EXPECT_GT(fates[FrameFate::kDelivered], observed.frames.size() / 3);
  for (auto& [camera, all] : nonempty(counters)) {
    std::sort(all.begin(), all.end());
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], i) << "of camera " << camera;
  }
}

TEST(WorldObserver, FramesThatAFullBusRefusesAreReported) {
  scenarios::Scenario scenario = ideal_scenario();
  scenario.usb.bandwidth_mb_per_s = 24;  // 29 ms for a frame every 22 ms
  scenario.usb.buffered_frames = 1;
  const KeptWorld observed = observe(scenario);
  std::size_t refused = 0;
  for (const ObservedFrame& frame : observed.frames) {
    EXPECT_EQ(frame.offered, frame.exposure_end + from_ms(8));
    if (frame.fate == FrameFate::kLostOnUsb) ++refused;
  }
  EXPECT_NEAR(static_cast<double>(refused), static_cast<double>(observed.frames.size()) / 2, 3);
}

// Every host but the master sends it two messages of five bytes.
Service two_messages(Transport transport) {
  return Service([transport](Host& host) -> Task<void> {
    if (host.id() == 0) co_return;
    MessageChannel& channel = host.open_channel(0, transport);
    co_await channel.send(Bytes(5));
    co_await host.sleep_for(from_ms(10));
    co_await channel.send(Bytes(5));
  });
}

TEST(WorldObserver, MessagesAreToldWithBothEnds) {
  for (const Transport transport : {Transport::kDatagram, Transport::kStream}) {
    Service service = two_messages(transport);
    const KeptWorld observed = observe(ideal_scenario(), &service);
    ASSERT_EQ(observed.messages.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      const ObservedMessage& message = observed.messages[i];
      EXPECT_EQ(message.from, 1U);
      EXPECT_EQ(message.to, 0U);
      EXPECT_EQ(message.stream, transport == Transport::kStream);
      EXPECT_EQ(message.id, i);
      EXPECT_EQ(message.bytes, 5U);
      EXPECT_EQ(message.left, TrueTime(from_ms(10.0 * static_cast<double>(i))));
      EXPECT_EQ(message.arrived, message.left + from_ms(0.1));
      EXPECT_FALSE(message.lost);
    }
  }
}

// Both hosts send each other a message every 2 ms.
Service many_messages(int count) {
  return Service([count](Host& host) -> Task<void> {
    MessageChannel& channel = host.open_channel(1 - host.id(), Transport::kDatagram);
    for (int i = 0; i < count; ++i) {
      co_await channel.send(Bytes(5));
      co_await host.sleep_for(from_ms(2));
    }
  });
}

TEST(WorldObserver, MessagesShowTheAsymmetryOfTheirLink) {
  constexpr int kMessages = 1'500;
  constexpr double kExponentialMs = 0.05;
  scenarios::Scenario scenario = ideal_scenario();
  scenario.network.links = {
      {.host = 1, .latency_exponential_ms = kExponentialMs, .asymmetry_ms = 0.06}};
  Service service = many_messages(kMessages);
  const KeptWorld observed = observe(scenario, &service);
  double forward_ms = 0;
  double backward_ms = 0;
  for (const ObservedMessage& message : observed.messages) {
    (message.from == 0 ? forward_ms : backward_ms) += to_ms(message.arrived - message.left);
  }
  ASSERT_EQ(observed.messages.size(), 2U * kMessages);
  const double sigma_ms = kExponentialMs * std::sqrt(2.0 / kMessages);
  EXPECT_NEAR((forward_ms - backward_ms) / kMessages, 0.06, 5 * sigma_ms);
  EXPECT_NEAR((forward_ms + backward_ms) / kMessages / 2, 0.1 + kExponentialMs, 5 * sigma_ms);
}

TEST(WorldObserver, LostMessagesAreToldAndRetransmissionsAreNot) {
  scenarios::Scenario scenario = ideal_scenario();
  scenario.network.loss_probability = 1;
  Service datagrams = two_messages(Transport::kDatagram);
  const KeptWorld lost = observe(scenario, &datagrams);
  ASSERT_EQ(lost.messages.size(), 2U);
  for (const ObservedMessage& message : lost.messages) EXPECT_TRUE(message.lost);

  scenario.network.loss_probability = 0.5;
  Service stream = two_messages(Transport::kStream);
  const KeptWorld late = observe(scenario, &stream);
  ASSERT_EQ(late.messages.size(), 2U);
  for (const ObservedMessage& message : late.messages) {
    EXPECT_FALSE(message.lost);
    EXPECT_GE(message.arrived, message.left + from_ms(0.1));
  }
}

// Nobody knows of messages to a host that has stopped but the sender and the observer.
TEST(WorldObserver, AMessageToAStoppedHostIsLost) {
  scenarios::Scenario scenario = ideal_scenario();
  scenario.faults = {scenarios::HostStops{.host = 0, .at_ms = 0, .duration_ms = 500}};
  Service service([](Host& host) -> Task<void> {
    if (host.id() == 0) co_return;
    MessageChannel& channel = host.open_channel(0, Transport::kDatagram);
    co_await host.sleep_for(from_ms(300));
    co_await channel.send(Bytes(5));
    co_await host.sleep_for(from_ms(500));
    co_await channel.send(Bytes(5));
  });
  const KeptWorld observed = observe(scenario, &service);
  ASSERT_EQ(observed.messages.size(), 2U);
  EXPECT_TRUE(observed.messages[0].lost);
  EXPECT_FALSE(observed.messages[1].lost);
  for (const ObservedFrame& frame : nonempty(observed.frames)) {
    EXPECT_TRUE(frame.host == 1 || frame.delivered >= TrueTime(from_ms(600)));
  }
}

TEST(WorldObserver, ClocksAreSampledAtTheIntervalFromTheStartToTheEnd) {
  Service service([](Host& host) -> Task<void> {
    if (host.id() == 0) co_return;
    co_await host.sleep_for(from_ms(42));
    co_await host.clock().set(HostTime(from_ms(1042)));
  });
  const KeptWorld observed = observe(ideal_scenario(), &service, from_ms(10));
  // Pulses 45 to 134 of 45 Hz are scored; the last frame is delivered 14 ms after its pulse, and
  // two pulses later the capture is over.
  ASSERT_FALSE(observed.clocks.empty());
  const Nanoseconds length = observed.clocks.back().at - TrueTime{};
  EXPECT_NEAR(to_ms(length), 100 + 136 * 1000.0 / 45, 11);
  EXPECT_EQ(observed.clocks.size(), static_cast<std::size_t>(length / from_ms(10)) + 1);
  for (std::size_t i = 0; i < observed.clocks.size(); ++i) {
    const KeptWorld::Clocks& clocks = observed.clocks[i];
    EXPECT_EQ(clocks.at, TrueTime(i * from_ms(10)));
    ASSERT_EQ(clocks.errors.size(), 2U);
    EXPECT_EQ(clocks.errors[0].count(), 0);
    EXPECT_EQ(clocks.errors[1], from_ms(i <= 4 ? 0 : 1000)) << "at " << i * 10 << " ms";
  }
  EXPECT_TRUE(observe(ideal_scenario(), &service).clocks.empty()) << "not asked for";
}

TEST(WorldObserver, AWarmUpOfHoursIsSampledAThousandTimes) {
  scenarios::Scenario scenario = ideal_scenario();
  scenario.hosts.clock.initial_offset_sigma_ms = 300;
  Service service([](Host&) -> Task<void> { co_return; }, std::chrono::hours(20));
  const KeptWorld observed = observe(scenario, &service, from_ms(10));
  EXPECT_EQ(observed.world_starts, std::vector<TrueTime>{TrueTime(-std::chrono::hours(20))});
  const auto before_zero = std::count_if(observed.clocks.begin(), observed.clocks.end(),
                                         [](const auto& c) { return c.at < TrueTime{}; });
  EXPECT_EQ(before_zero, 1000);
  EXPECT_EQ(observed.clocks.front().at, observed.world_starts.front());
  const KeptWorld::Clocks& zero = observed.clocks[1000];
  EXPECT_EQ(zero.at, TrueTime{});
  EXPECT_NE(zero.errors[1].count(), 0);
  for (const KeptWorld::Clocks& clocks : observed.clocks) EXPECT_EQ(clocks.errors, zero.errors);
}

}  // namespace
}  // namespace simbench::sim

// What each form of PTP does in a scripted world: end to end, with peer delays, and SPTP.
#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/host_sync/ptp/ptp.h"
#include "algorithms/host_sync/ptp/ptp_message.h"
#include "algorithms/host_sync/ptp/sptp.h"
#include "tests/algorithms/host_sync/closed_loop.h"
#include "tests/algorithms/host_sync/unreliable_link.h"

namespace simbench {
namespace {

constexpr Nanoseconds kEveryPtpLatency{150'000};

struct PtpForm {
  std::string name;
  std::function<std::unique_ptr<HostSync>(StampSource)> make;
  // Its own; all else is alike.
  Nanoseconds warm_up;
  Nanoseconds unreliable_run;
  std::vector<Nanoseconds> late;   // copies of a late message
  std::size_t garbage_below = 60;  // bytes
};

PtpForm classic(const char* name, bool is_peer_delay) {
  return {.name = name,
          .make =
              [is_peer_delay](StampSource stamps) {
                PtpSettings settings;
                settings.is_peer_delay = is_peer_delay;
                settings.stamps = stamps;
                return std::make_unique<Ptp>(settings);
              },
          .warm_up = from_ms(300e3),
          .unreliable_run = from_ms(120e3),
          .late = {kEveryPtpLatency, kEveryPtpLatency + from_ms(2500)}};
}

PtpForm simple() {
  return {.name = "Sptp",
          .make =
              [](StampSource stamps) {
                SptpSettings settings{
                    .servo_limits = {.max_frequency_ppb = 5e5, .first_step_threshold_ns = 20'000}};
                settings.stamps = stamps;
                return std::make_unique<Sptp>(settings);
              },
          .warm_up = from_ms(60e3),
          .unreliable_run = from_ms(240e3),
          .late = {kEveryPtpLatency + from_ms(2500)},
          .garbage_below = 70};
}

class EveryPtpTest : public testing::TestWithParam<PtpForm> {
 protected:
  EveryPtpTest() {
    world_.connect(kEveryPtpLatency);
    for (const PeerId slave : world_.slaves()) {
      world_.host(slave).offset = from_ms(-400.0 * slave);
      world_.host(slave).uniform = 0.4;
    }
    for (PeerId host = 0; host < 3; ++host) world_.host(host).stamps_departures = true;
  }
  void run(Nanoseconds duration = from_ms(60e3), StampSource stamps = StampSource::kKernel) {
    const auto sync = GetParam().make(stamps);
    EXPECT_EQ(sync->warm_up(), GetParam().warm_up);
    world_.run(*sync, duration);
  }

  ScriptWorld world_{3};
};

TEST_P(EveryPtpTest, StepsTheSlavesToTheMaster) {
  run();
  EXPECT_EQ(world_.unfinished(), 3u);
  expect_locked(world_);
  for (const PeerId slave : nonempty(world_.slaves())) {
    ASSERT_FALSE(world_.host(slave).exchanges.empty());
    const Exchange& exchange = world_.host(slave).exchanges.front();
    EXPECT_EQ((*exchange.t2 - *exchange.t1) + (*exchange.t4 - *exchange.t3), 2 * kEveryPtpLatency);
  }
}

TEST_P(EveryPtpTest, AsymmetryIsInTheResultWithItsHalf) {
  world_.set_latency(1, 0, kEveryPtpLatency + from_ms(0.1));
  run();
  EXPECT_NEAR(lead_us(world_, 1), 50, 0.01);
}

// What a transparent clock does: event messages take longer and say so in their correction.
TEST_P(EveryPtpTest, CorrectionsOfTransparentClocksAreTakenOut) {
  ScriptWorld& world = world_;
  const auto deliver_corrected = [&world](PeerId from, PeerId to, Nanoseconds residence) {
    return [&world, from, to, residence](std::size_t, const Bytes& bytes) {
      const auto message = decode_ptp_message(bytes);
      if (!message || static_cast<int>(message->type) > 3) return std::vector{kEveryPtpLatency};
      PtpMessage corrected = *message;
      corrected.correction += residence.count() * 65'536;
      const Bytes changed = encode(corrected);
      world.call_at(world.now() + kEveryPtpLatency + residence,
                    [&world, from, to, changed] { world.host(to).deliver(from, changed); });
      return std::vector<Nanoseconds>{};
    };
  };
  world_.script_link(0, 1, deliver_corrected(0, 1, from_ms(0.7)));
  world_.script_link(1, 0, deliver_corrected(1, 0, from_ms(0.1)));
  run();
  expect_aligned(world_, {.slave = 1});
}

TEST_P(EveryPtpTest, LossDuplicatesReorderingAndGarbageCostMeasurementsOnly) {
  boost::random::mt19937_64 engine(17);
  const LinkScript unreliable = unreliable_link(
      engine, kEveryPtpLatency, {.twice_after = from_ms(0.3), .late = GetParam().late});
  world_.script_link(0, 1, unreliable);
  world_.script_link(1, 0, unreliable);
  for (int i = 0; i < 1000; ++i) {
    const Bytes bytes = random_bytes(engine, GetParam().garbage_below);
    world_.call_at(from_ms(60.0 * i), [this, bytes] { world_.host(1).deliver(0, bytes); });
    world_.call_at(from_ms(60.0 * i + 9), [this, bytes] { world_.host(0).deliver(1, bytes); });
  }
  SCOPED_TRACE("seed 17");
  run(GetParam().unreliable_run);
  // A duplicate that comes later than its like is taken for it where that one was lost.
  expect_aligned(world_, {.error_us = 0.5, .slave = 1});
  expect_aligned(world_, {.slave = 2});
}

TEST_P(EveryPtpTest, ASilentMasterIsOneOutcome) {
  cut(world_, 0, 2);
  run();
  expect_refused(world_, 2, "has not locked");
  EXPECT_TRUE(world_.host(1).outcomes.at(0).synchronised);
}

TEST_P(EveryPtpTest, StampsThatTheHostDoesNotTakeAreAnOutcomeThatNamesThem) {
  for (const auto& [source, what] : {std::pair{StampSource::kCard, "Host::hardware_clock"},
                                     {StampSource::kKernel, "MessageChannel::transmit_stamp"}}) {
    ScriptWorld world(2);
    world.connect(kEveryPtpLatency);
    const auto sync = GetParam().make(source);
    world.run(*sync, from_ms(60e3));
    expect_refused(world, 1, what);
    EXPECT_TRUE(world.host(1).steps.empty());
    EXPECT_EQ(world.unfinished(), 0u) << what;
  }
}

TEST_P(EveryPtpTest, TheProgramsStampsAreTakenWhereTheyAreAskedFor) {
  for (PeerId host = 0; host < 3; ++host) world_.host(host).stamps_departures = false;
  run(from_ms(60e3), StampSource::kProgram);
  expect_aligned(world_, {.slave = 1});
}

INSTANTIATE_TEST_SUITE_P(Forms, EveryPtpTest,
                         testing::Values(classic("EndToEnd", false), classic("PeerDelay", true),
                                         simple()),
                         [](const auto& service) { return service.param.name; });

}  // namespace
}  // namespace simbench

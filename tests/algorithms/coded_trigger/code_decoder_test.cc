#include "algorithms/coded_trigger/code_decoder.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/algorithms/coded_trigger/coded_frames.h"

namespace simbench {
namespace {

// What a decoder made of a camera's frames.
struct Indices {
  std::vector<std::optional<std::int64_t>> all;  // by frame
  std::size_t found_with = 0;                    // frames until the place was first known
  std::size_t searches = 0;

  std::size_t indexed() const {
    std::size_t count = 0;
    for (const auto& index : all) count += index ? 1 : 0;
    return count;
  }
};

Indices decode(CodeDecoder& decoder, const std::vector<CodedFrame>& frames) {
  Indices indices;
  indices.all.resize(frames.size());
  std::vector<std::size_t> held;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Decoded decoded = decoder.push(frames[i].sensor, frames[i].exposure_us);
    if (decoded.is_refused) continue;
    held.push_back(i);
    held.erase(held.begin(), held.begin() + decoded.given_up);
    for (std::size_t k = 0; k < decoded.indexed; ++k) {
      indices.all[held[k]] =
          decoded.has_found_place ? decoder.found_index(k) : decoder.newest_index();
    }
    held.erase(held.begin(), held.begin() + decoded.indexed);
    if (!decoded.has_found_place) continue;
    if (indices.searches++ == 0) indices.found_with = i + 1;
  }
  return indices;
}

// Every index is the frame's pulse, but for whole cycles that all have in common.
void expect_right(const Indices& indices, const std::vector<CodedFrame>& frames,
                  std::int64_t length, const std::string& context) {
  std::optional<std::int64_t> cycles;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!indices.all[i]) continue;
    const std::int64_t off = *indices.all[i] - frames[i].pulse;
    ASSERT_EQ(off % length, 0) << context << ", frame " << i;
    if (!cycles) cycles = off;
    ASSERT_EQ(off, *cycles) << context << ", frame " << i;
  }
}

TEST(CodeDecoder, NamesEveryFrameOfACleanCamera) {
  const auto pulses = usual_pulses();
  const auto frames = coded_frames(*pulses, {.first = 1234}, 500, 1);
  CodeDecoder decoder(pulses, {});
  const Indices indices = decode(decoder, frames);
  EXPECT_EQ(indices.indexed(), frames.size());
  EXPECT_EQ(*indices.all.front(), 1234) << "of the code's first cycle";
  EXPECT_EQ(*indices.all.back(), 1733);
  // Twelve symbols name a place; so that one that is wrong makes no other, it takes some more.
  EXPECT_GE(indices.found_with, 12U);
  EXPECT_LE(indices.found_with, 30U);
  EXPECT_EQ(decoder.lock().times, 1U);
  EXPECT_EQ(decoder.lock().frames, indices.found_with);
  EXPECT_LE(decoder.lock().error_probability, 1e-9);
}

TEST(CodeDecoder, BearsLossesNoiseClockErrorAndLateStarts) {
  const auto pulses = usual_pulses();
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    const CodedCamera camera{.first = static_cast<std::int64_t>(seed) * 977,
                             .rate_ppm = 5.0 * seed - 150,
                             .offset_us = 1e9 * seed,
                             .noise_us = 4,
                             .loss = 0.01 * (seed % 20)};
    const auto frames = coded_frames(*pulses, camera, 1500, seed);
    CodeDecoder decoder(pulses, {});
    const Indices indices = decode(decoder, frames);
    const std::string context = "seed " + std::to_string(seed);
    expect_right(indices, frames, pulses->code.length(), context);
    EXPECT_EQ(indices.indexed(), frames.size()) << context;
    EXPECT_EQ(indices.searches, 1U) << context;
    EXPECT_LE(indices.found_with, 45U) << context;
  }
}

TEST(CodeDecoder, CountsCyclesOnByTheCamerasClock) {
  const auto pulses = pulses_of(TriggerCode::position(from_ns(1e9 / 90), 6, from_us(50)));
  auto frames = coded_frames(*pulses, {.first = 3, .rate_ppm = 80, .noise_us = 3}, 60'000, 5);
  // Ten minutes of 11 are silent, 800 cycles of 64 pulses.
  std::erase_if(frames,
                [](const CodedFrame& frame) { return frame.pulse > 3000 && frame.pulse < 57'000; });
  CodeDecoder decoder(pulses, {});
  const Indices indices = decode(decoder, frames);
  EXPECT_EQ(indices.indexed(), frames.size());
  EXPECT_EQ(*indices.all.back(), frames.back().pulse);
}

TEST(CodeDecoder, ARegisterThatWrapsIsUnwrappedBefore) {
  const auto pulses = usual_pulses();
  // The stamps of an unwrapped register go on beyond 2^32 us.
  const auto frames = coded_frames(*pulses, {.offset_us = 0x1p32 - 3e6}, 1000, 2);
  CodeDecoder decoder(pulses, {});
  EXPECT_EQ(decode(decoder, frames).indexed(), frames.size());
}

TEST(CodeDecoder, AutoExposureIsNoCode) {
  for (const bool begin_at_pulse : {false, true}) {
    const auto pulses = pulses_of(usual_pulses()->code, begin_at_pulse);
    std::vector<CodedFrame> frames;
    for (std::int64_t pulse = 0; pulse < 600; ++pulse) {
      const auto exposure_us = static_cast<std::uint32_t>(1000 + 613 * (pulse / 7 % 9));
      frames.push_back({.pulse = pulse,
                        .sensor = coded_stamp(*pulses, {.exposure_us = exposure_us}, pulse, 0),
                        .exposure_us = exposure_us});
    }
    CodeDecoder decoder(pulses, {});
    const Indices indices = decode(decoder, frames);
    EXPECT_EQ(indices.indexed(), frames.size());
    expect_right(indices, frames, pulses->code.length(), "");
    // The other end of the exposure is no constant time from the pulse.
    CodeDecoder wrong(pulses_of(pulses->code, !begin_at_pulse), {});
    EXPECT_LT(decode(wrong, frames).indexed(), frames.size() / 2);
  }
}

TEST(CodeDecoder, FreeRunningFramesHaveNoIndex) {
  const auto pulses = usual_pulses();
  const double period_us = to_ns(pulses->code.period()) * 1e-3;
  for (const double rate_ppm : {-500.0, -20.0, 0.0, 20.0, 500.0}) {
    std::vector<CodedFrame> frames;
    for (std::int64_t i = 0; i < 5000; ++i) {
      const double us = static_cast<double>(i) * period_us * (1 + rate_ppm * 1e-6);
      frames.push_back(
          {.pulse = i, .sensor = DeviceTime(Microseconds(static_cast<std::int64_t>(us)))});
    }
    CodeDecoder decoder(pulses, {});
    EXPECT_EQ(decode(decoder, frames).indexed(), 0U) << rate_ppm;
  }
}

TEST(CodeDecoder, ThePlaceIsFoundAgainBehindFreeRunning) {
  const auto pulses = usual_pulses();
  const CodedCamera camera{.first = 50, .rate_ppm = 30, .noise_us = 3};
  auto frames = coded_frames(*pulses, camera, 1000, 3);
  // The trigger pauses for a while: the camera's own frames come at another phase.
  for (CodedFrame& frame : frames) {
    if (frame.pulse < 400 || frame.pulse >= 500) continue;
    frame.sensor = DeviceTime(Microseconds((frame.pulse * 11'100'000 + 4'321'000) / 1000));
  }
  CodeDecoder decoder(pulses, {});
  const Indices indices = decode(decoder, frames);
  std::size_t free_running = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool is_free = frames[i].pulse >= 400 && frames[i].pulse < 500;
    if (is_free && indices.all[i]) ++free_running;
    if (is_free) continue;
    ASSERT_TRUE(indices.all[i].has_value()) << frames[i].pulse;
    EXPECT_EQ(*indices.all[i], frames[i].pulse);
  }
  EXPECT_EQ(free_running, 0U);
  EXPECT_EQ(indices.searches, 2U);
}

TEST(CodeDecoder, AFrameBeforeTheFirstPulseIsNotOfTheCyclesEnd) {
  const auto pulses = usual_pulses();
  auto frames = coded_frames(*pulses, {.offset_us = 1e6}, 200, 1);
  // It ran free, by chance a period ahead of the pulse.
  CodedFrame free_running = frames.front();
  free_running.sensor -= Microseconds(11'130);
  frames.insert(frames.begin(), free_running);
  CodeDecoder decoder(pulses, {});
  const Indices indices = decode(decoder, frames);
  EXPECT_EQ(*indices.all[1], 0);
  EXPECT_EQ(*indices.all.back(), 199);
}

TEST(CodeDecoder, OneFrameInTheWrongPlaceEndsNothing) {
  const auto pulses = usual_pulses();
  auto frames = coded_frames(*pulses, {}, 400, 3);
  frames[200].sensor += Microseconds(700);
  CodeDecoder decoder(pulses, {});
  const Indices indices = decode(decoder, frames);
  EXPECT_FALSE(indices.all[200].has_value());
  EXPECT_EQ(indices.indexed(), frames.size() - 1);
  EXPECT_EQ(indices.searches, 1U);
}

TEST(CodeDecoder, OneWrongSymbolInTheSearchMakesNoOtherPlace) {
  const auto pulses = usual_pulses();
  for (std::size_t wrong = 0; wrong < 25; ++wrong) {
    for (const std::int64_t first : {0, 500, 1900, 3333}) {
      auto frames = coded_frames(*pulses, {.first = first, .noise_us = 2}, 300, 3);
      const bool is_late = pulses->code.shift(frames[wrong].pulse) > Nanoseconds(0);
      frames[wrong].sensor += Microseconds(is_late ? -100 : 100);
      CodeDecoder decoder(pulses, {});
      const Indices indices = decode(decoder, frames);
      expect_right(indices, frames, pulses->code.length(),
                   "wrong " + std::to_string(wrong) + ", first " + std::to_string(first));
      EXPECT_GE(indices.indexed(), frames.size() - 40);
    }
  }
}

TEST(CodeDecoder, AnUnsteadyStartCostsNoSteadyFrame) {
  const auto pulses = usual_pulses();
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    auto frames = coded_frames(*pulses, {.first = 700, .noise_us = 2}, 500, seed);
    boost::random::mt19937 random(seed);
    boost::random::normal_distribution<double> late_us(0, 500);
    for (std::size_t i = 0; i < 300; ++i) {
      frames[i].sensor += Microseconds(std::llround(std::abs(late_us(random))));
    }
    CodeDecoder decoder(pulses, {});
    const Indices indices = decode(decoder, frames);
    expect_right(indices, frames, pulses->code.length(), "seed " + std::to_string(seed));
    for (std::size_t i = 300; i < frames.size(); ++i) {
      EXPECT_TRUE(indices.all[i].has_value()) << "seed " << seed << ", frame " << i;
    }
  }
}

// Frames that scatter as if by a code, of which some lie near some place by chance.
TEST(CodeDecoder, ChanceIsNoPlace) {
  const auto pulses = pulses_of(TriggerCode::frequency(from_ns(1e9 / 45), 10, 2, from_us(100)));
  const double period_us = to_ns(pulses->code.period()) * 1e-3;
  for (const double spread_us : {60.0, 150.0, 250.0, 500.0}) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
      boost::random::mt19937 random(seed);
      boost::random::uniform_01<double> uniform;
      CodeDecoder decoder(pulses, {});
      std::size_t found = 0;
      for (std::int64_t i = 0; i < 2000; ++i) {
        const double us = static_cast<double>(i) * period_us + spread_us * uniform(random);
        const auto whole = static_cast<std::int64_t>(us);
        found += decoder.push(DeviceTime(Microseconds(whole)), 0).has_found_place ? 1 : 0;
      }
      EXPECT_EQ(found, 0U) << spread_us << " us, seed " << seed;
    }
  }
}

TEST(CodeDecoder, AnotherCodeIsNoPlace) {
  const auto pulses = usual_pulses();
  const auto others = pulses_of(TriggerCode::position(pulses->code.period(), 11, from_us(50)));
  CodeDecoder decoder(pulses, {});
  const Indices indices = decode(decoder, coded_frames(*others, {}, 3000, 1));
  // A chance likeness of some frames may be taken for a place, and is soon given up.
  EXPECT_LT(indices.indexed(), 300U);
}

TEST(CodeDecoder, AClockThatWasRestartedBeginsAnew) {
  const auto pulses = usual_pulses();
  auto frames = coded_frames(*pulses, {.offset_us = 5e9}, 200, 1);
  const auto later = coded_frames(*pulses, {.first = 200}, 200, 2);
  frames.insert(frames.end(), later.begin(), later.end());
  CodeDecoder decoder(pulses, {});
  const Indices indices = decode(decoder, frames);
  EXPECT_EQ(indices.indexed(), frames.size());
  expect_right(indices, frames, pulses->code.length(), "");
  EXPECT_EQ(indices.searches, 2U);
}

TEST(CodeDecoder, FramesOutOfOrderAreRefused) {
  const auto pulses = usual_pulses();
  const auto frames = coded_frames(*pulses, {}, 200, 1);
  CodeDecoder decoder(pulses, {});
  decode(decoder, frames);
  EXPECT_TRUE(decoder.push(frames[198].sensor, frames[198].exposure_us).is_refused);
  EXPECT_TRUE(decoder.push(frames[199].sensor, frames[199].exposure_us).is_refused) << "twice";
  EXPECT_EQ(decoder.newest_index(), 199);
}

TEST(CodeDecoder, ReadsEveryKindOfCode) {
  const Nanoseconds period = from_ms(1000.0 / 45);
  for (const TriggerCode& code :
       {TriggerCode::position(period, 10, from_us(30)), TriggerCode::missing(period, 8, 4),
        TriggerCode::frequency(period, 10, 2, from_us(60)),
        TriggerCode::frequency(period, 8, 6, from_us(40))}) {
    const auto pulses = pulses_of(code);
    const auto frames = coded_frames(
        *pulses, {.first = 700, .rate_ppm = -60, .noise_us = 3, .loss = 0.005}, 1500, 4);
    CodeDecoder decoder(pulses, {});
    const Indices indices = decode(decoder, frames);
    expect_right(indices, frames, code.length(), std::to_string(code.length()));
    EXPECT_GE(indices.indexed(), frames.size() - 5) << code.length();
  }
}

TEST(CodeDecoder, MovesByWholeCycles) {
  const auto pulses = usual_pulses();
  const auto frames = coded_frames(*pulses, {.first = 10}, 100, 1);
  CodeDecoder decoder(pulses, {});
  decode(decoder, frames);
  decoder.move_by_cycles(3);
  EXPECT_EQ(decoder.newest_index(), 109 + 3 * 4096);
}

}  // namespace
}  // namespace simbench

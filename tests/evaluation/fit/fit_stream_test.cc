#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "evaluation/fit/fit.h"
#include "evaluation/statistics/statistics.h"
#include "sim/engine/random.h"

namespace simbench::evaluation {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

// Frames of a camera of this rate error whose arrivals are 20 ms and delay_ms(i) late.
FitStream stream_of(std::size_t count, double skew_ppm, const std::function<double(int)>& delay_ms,
                    double period_ms = 1e3 / 30) {
  FitStream stream{.camera = 0, .kind = "depth", .frames = {}};
  for (std::size_t i = 0; i < count; ++i) {
    const double t_ms = static_cast<double>(i) * period_ms;
    const double device_us = std::floor(5e5 + t_ms * 1e3 * (1 + skew_ppm * 1e-6));
    stream.frames.push_back({.counter = i,
                             .sensor = Nanoseconds(static_cast<std::int64_t>(device_us) * 1000),
                             .arrival = from_ms(t_ms + 20 + delay_ms(static_cast<int>(i)))});
  }
  return stream;
}

TEST(FitStream, WithoutDelaysIsTheRateAndNoExcess) {
  const StreamFit fit = fit_stream("a", stream_of(600, 40, [](int) { return 0.0; }));
  // Stamps of whole microseconds over 20 s.
  EXPECT_NEAR(fit.skew_ppm.value, 40, 0.06);
  EXPECT_LT(*std::max_element(fit.excess_ms.begin(), fit.excess_ms.end()), 0.002);
  EXPECT_EQ(fit.frames, 600);
  EXPECT_EQ(fit.account.lost, 0);
  EXPECT_EQ(fit.pairs, 599);
}

TEST(FitStream, GivesBackAUniformDelay) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sim::RandomStream random(seed, "test");
    const StreamFit fit =
        fit_stream("a", stream_of(900, -215, [&](int) { return random.uniform(); }));
    // The lowest of 56 frames is some 1 / 57 above the least delay, and scatters by as much.
    EXPECT_NEAR(fit.skew_ppm.value, -215, 5 * fit.skew_ppm.error) << "seed " << seed;
    EXPECT_LT(fit.skew_ppm.error, 5) << "seed " << seed;
    for (const double p : {0.05, 0.25, 0.5, 0.75, 0.95}) {
      EXPECT_NEAR(quantile(fit.excess_ms, p), p, 5 * std::sqrt(p * (1 - p) / 900))
          << "quantile " << p << ", seed " << seed;
    }
    EXPECT_NEAR(fit.rank_correlation.value, 0, 5 / std::sqrt(900)) << "seed " << seed;
  }
}

// The rate changes by 2 ppm in a minute: a line through all would be off by 30 us.
TEST(FitStream, ARateThatChangesIsNotTakenForDelay) {
  sim::RandomStream random(5, "test");
  const auto delay_ms = [&](int i) {
    const double s = i / 30.0;
    return s * s / 60 * 1e-6 * 1e3 + random.uniform(0, 0.1);
  };
  const StreamFit fit = fit_stream("a", stream_of(1800 * 2, 0, delay_ms));
  EXPECT_NEAR(quantile(fit.excess_ms, 0.5), 0.05, 0.01) << "seed 5";
  EXPECT_GT(fit.rise_ms, 0.02);
}

TEST(FitStream, CountsGapsAndPairs) {
  FitStream stream = stream_of(400, 0, [](int i) { return 0.1 * (i % 3); });
  for (std::size_t i = 200; i < 400; ++i) stream.frames[i].counter += 7;
  stream.frames.erase(stream.frames.begin() + 100);
  stream.account = frame_account(stream.frames, /*counted=*/true);
  const StreamFit fit = fit_stream("a", stream);
  EXPECT_EQ(fit.frames, 399);
  EXPECT_EQ(fit.account.lost, 8);
  EXPECT_EQ(fit.pairs, 396);
}

TEST(FitStream, RefusesTooFewFramesAndAnotherUnit) {
  FitStream stream = stream_of(200, 0, [](int) { return 0.0; });
  stream.frames.resize(99);
  EXPECT_THAT(
      [&] { fit_stream("left", stream); },
      ThrowsMessage<FitError>("camera left, depth: found 99 frames, a fit needs 100 at least"));
  const FitStream percent = stream_of(200, 20'000, [](int) { return 0.0; });
  EXPECT_THAT([&] { fit_stream("left", percent); },
              ThrowsMessage<FitError>(AllOf(HasSubstr("camera left, depth: found a drift of 20000"),
                                            HasSubstr("are both stamps milliseconds"))));
}

TEST(SuccessiveRankCorrelation, OfWhatItIsKnownFor) {
  const std::vector<bool> all(6, true);
  EXPECT_DOUBLE_EQ(successive_rank_correlation({1, 2, 4, 8, 16, 99}, all).value, 1);
  EXPECT_DOUBLE_EQ(successive_rank_correlation({1, 5, 1, 5, 1, 5}, all).value, -1);
  EXPECT_TRUE(std::isnan(successive_rank_correlation({3, 3, 3, 3, 3, 3}, all).value));
  // Only the pairs that are marked count.
  EXPECT_DOUBLE_EQ(
      successive_rank_correlation({1, 2, 9, 3, 4, 5}, {false, true, false, false, true, true})
          .value,
      1);
}

}  // namespace
}  // namespace simbench::evaluation

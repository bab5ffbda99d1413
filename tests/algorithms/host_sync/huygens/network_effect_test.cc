// Which errors of pairs the loops correct, and which they cannot: in numbers.
#include "algorithms/host_sync/huygens/network_effect.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <set>
#include <vector>

#include "tests/nonempty.h"

namespace simbench {
namespace {

// Leads of a full mesh: those of the hosts' offsets, plus errors by pair.
template <class ErrorOfPair>
std::vector<PairLead> full_mesh(const std::vector<double>& offsets, ErrorOfPair error) {
  std::vector<PairLead> pairs;
  for (PeerId b = 1; b < offsets.size(); ++b) {
    for (PeerId a = 0; a < b; ++a) {
      pairs.push_back({a, b, offsets[b] - offsets[a] + error(a, b)});
    }
  }
  return pairs;
}

TEST(NetworkEffectTest, ExactLeadsGiveTheOffsets) {
  const std::vector<double> offsets = {0, 500, -20, 7e6};
  const auto corrected = loop_corrected(full_mesh(offsets, [](PeerId, PeerId) { return 0.0; }), 4);
  for (std::size_t host = 0; host < 4; ++host) {
    EXPECT_NEAR(*corrected[host], offsets[host], 1e-6);
  }
}

TEST(NetworkEffectTest, TheErrorOfOnePairIsSharedOut) {
  // 2 e / n remain on its pair, e / n between either of it and another host.
  for (const std::size_t hosts : {3u, 6u, 20u}) {
    const auto corrected =
        loop_corrected(full_mesh(std::vector<double>(hosts),
                                 [](PeerId a, PeerId b) { return a == 0 && b == 1 ? 600.0 : 0.0; }),
                       hosts);
    const auto n = static_cast<double>(hosts);
    EXPECT_NEAR(*corrected[1], 2 * 600 / n, 1e-9) << hosts;
    EXPECT_NEAR(*corrected[2], 600 / n, 1e-9) << hosts;
  }
}

TEST(NetworkEffectTest, IndependentErrorsOfPairsFallByTheRootOfHalfTheHosts) {
  // Variance v of each pair becomes 2 v / n: a factor of sqrt(n / 2) for the error.
  boost::random::mt19937_64 engine(9);
  boost::random::normal_distribution<double> error(0, 1'000);
  for (const std::size_t hosts : {4u, 6u, 18u}) {
    double squares = 0;
    double count = 0;
    for (int run = 0; run < 2'000; ++run) {
      const auto corrected = loop_corrected(
          full_mesh(std::vector<double>(hosts), [&](PeerId, PeerId) { return error(engine); }),
          hosts);
      for (std::size_t host = 1; host < hosts; ++host) {
        squares += *corrected[host] * *corrected[host];
        ++count;
      }
    }
    const double expected = 1'000 * std::sqrt(2 / static_cast<double>(hosts));
    EXPECT_NEAR(std::sqrt(squares / count), expected, 0.05 * expected) << "seed 9, " << hosts;
  }
}

TEST(NetworkEffectTest, ErrorsOfHostsCloseTheirLoopsAndStay) {
  // A port that delays what goes out by s and what comes in by r makes each lead of its host wrong
  // by (r - s) / 2: a difference of something of each host, around a loop zero.
  const std::vector<double> sent = {100, 900, 0, 300, 50};
  const std::vector<double> received = {700, 100, 200, 300, 0};
  const auto error = [&](PeerId a, PeerId b) {
    const double forth = sent[a] + received[b];
    const double back = sent[b] + received[a];
    return (forth - back) / 2;
  };
  const auto corrected = loop_corrected(full_mesh(std::vector<double>(5), error), 5);
  for (PeerId host = 1; host < 5; ++host) {
    EXPECT_NEAR(*corrected[host], error(0, host), 1e-9);
  }
}

TEST(NetworkEffectTest, ATreeHasNoLoops) {
  const auto corrected = loop_corrected({{0, 1, 5.0}, {1, 2, 7.0}, {0, 3, -2.0}}, 5);
  EXPECT_NEAR(*corrected[1], 5, 1e-12);
  EXPECT_NEAR(*corrected[2], 12, 1e-12);
  EXPECT_NEAR(*corrected[3], -2, 1e-12);
  EXPECT_FALSE(corrected[4]) << "no pair has it";
}

TEST(NetworkEffectTest, PairsWithoutHost0GiveNothing) {
  const auto corrected = loop_corrected({{1, 2, 5.0}}, 3);
  EXPECT_EQ(corrected[0], 0);
  EXPECT_FALSE(corrected[1]);
  EXPECT_FALSE(corrected[2]);
}

TEST(NetworkEffectTest, LinesAreReadEachAtItsOwnClocksReading) {
  // Clocks that have nothing in common: hours apart and some ppm. Host h reads s + h hours + h * 20
  // ppm * s at host 0's s.
  const auto lead_of = [](PeerId host, double s_ns) { return host * 3.6e12 + host * 20e-6 * s_ns; };
  constexpr double kNow = 5e9;
  PairLines lines;
  for (PeerId b = 1; b < 4; ++b) {
    for (PeerId a = 0; a < b; ++a) {
      const double x = kNow + lead_of(a, kNow);
      const double rate_of_a = 1 + a * 20e-6;
      lines[{a, b}] = {.x_ns = std::llround(x - 1e9 * rate_of_a),
                       .lead_ns = std::llround(lead_of(b, kNow - 1e9) - lead_of(a, kNow - 1e9)),
                       .rate = (b - a) * 20e-6 / rate_of_a};
    }
  }
  const auto leads = loop_corrected_leads(lines, std::llround(kNow), 5);
  for (PeerId host = 0; host < 4; ++host) {
    EXPECT_NEAR(static_cast<double>(*leads[host]), lead_of(host, kNow), 2) << host;
  }
  EXPECT_FALSE(leads[4]);
  // Without its direct line host 3 is reached over the others.
  lines.erase({0, 3});
  lines.erase({1, 3});
  EXPECT_NEAR(static_cast<double>(*loop_corrected_leads(lines, std::llround(kNow), 5)[3]),
              lead_of(3, kNow), 3);
  // And backwards: from host 2 to host 1.
  lines.erase({0, 1});
  EXPECT_NEAR(static_cast<double>(*loop_corrected_leads(lines, std::llround(kNow), 5)[1]),
              lead_of(1, kNow), 3);
}

TEST(ProbedPairsTest, SmallRigsProbeAllPairsLargeOnesAConnectedPart) {
  boost::random::mt19937_64 engine(2);
  const auto uniform = [&engine] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
  EXPECT_EQ(probed_pairs(6, 10, uniform).size(), 15u);
  EXPECT_EQ(probed_pairs(11, 10, uniform).size(), 55u);
  EXPECT_TRUE(probed_pairs(1, 10, uniform).empty());
  const auto pairs = probed_pairs(200, 10, uniform);
  EXPECT_EQ(pairs.size(), 1'000u);
  EXPECT_EQ(std::set(pairs.begin(), pairs.end()).size(), pairs.size());
  std::vector<PairLead> leads;
  for (const auto& [a, b] : nonempty(pairs)) {
    EXPECT_LT(a, b);
    EXPECT_LT(b, 200u);
    leads.push_back({a, b, 0.0});
  }
  for (const auto& lead : loop_corrected(leads, 200)) EXPECT_TRUE(lead);
  // A source that repeats itself leaves the ring.
  EXPECT_EQ(probed_pairs(200, 10, [] { return 0.5; }).size(), 200u);
}

}  // namespace
}  // namespace simbench

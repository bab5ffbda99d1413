#include "laws/message_law.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace simbench {
namespace {

// Draws that are stated, and count how many were taken.
class StatedDraws {
 public:
  explicit StatedDraws(std::vector<double> uniforms) : uniforms_(std::move(uniforms)) {}
  double uniform() { return uniforms_.at(taken_++); }
  bool chance(double probability) { return uniform() < probability; }
  double exponential(double mean) { return mean * uniform(); }
  std::size_t taken() const { return taken_; }

 private:
  std::vector<double> uniforms_;
  std::size_t taken_ = 0;
};

constexpr LatencyLaw kLatency{
    .fixed_ms = 2, .exponential_ms = 0.5, .spike_probability = 0.1, .spike_max_ms = 10};

TEST(LatencyLaw, IsFixedPlusExponentialPlusSpike) {
  StatedDraws without({0.5, 0.1, 0.7});
  EXPECT_DOUBLE_EQ(kLatency.draw_ms(without), 2.25);
  StatedDraws with({0.5, 0.0999, 0.7});
  EXPECT_DOUBLE_EQ(kLatency.draw_ms(with), 9.25);
  EXPECT_EQ(without.taken(), with.taken()) << "a spike must not move the draws after it";
}

TEST(LatencyLaw, ATableTakesThePlaceOfTheRandomParts) {
  const std::vector<double> table_ms = {1, 1, 4};
  LatencyLaw law = kLatency;
  law.table_ms = QuantileTable(table_ms);
  StatedDraws draws({0.75});
  EXPECT_DOUBLE_EQ(law.draw_ms(draws), 2 + 2.5);
  EXPECT_EQ(draws.taken(), 1u);
}

constexpr DatagramLaw kDatagrams{.loss_probability = 0.1,
                                 .duplicate_probability = 0.2,
                                 .reorder_probability = 0.3,
                                 .reorder_max_ms = 5};

TEST(DatagramLaw, EachShareHasADrawOfItsOwn) {
  StatedDraws draws({0.05, 0.25, 0.25, 0.5, 0.5, 0.15, 0.35, 0});
  const DatagramFate first = kDatagrams.draw(draws);
  EXPECT_TRUE(first.is_lost);
  EXPECT_FALSE(first.is_duplicated);
  EXPECT_TRUE(first.is_reordered);
  EXPECT_EQ(first.detour_ms, 2.5);
  const DatagramFate second = kDatagrams.draw(draws);
  EXPECT_FALSE(second.is_lost);
  EXPECT_TRUE(second.is_duplicated);
  EXPECT_FALSE(second.is_reordered);
  EXPECT_EQ(second.detour_ms, 0);
}

TEST(DatagramFate, KeepsTheOrderUnlessReordered) {
  const DatagramFate plain;
  const DatagramFate late{.is_reordered = true, .detour_ms = 3};
  Nanoseconds last = from_ms(10);
  // Alone it would arrive before the last one: it waits, and its copy does not overtake it.
  const auto held = plain.arrivals(from_ms(8), from_ms(9), last);
  EXPECT_EQ(held.first, from_ms(10));
  EXPECT_EQ(held.copy, from_ms(10));
  const auto in_order = plain.arrivals(from_ms(12), from_ms(15), last);
  EXPECT_EQ(in_order.first, from_ms(12));
  EXPECT_EQ(in_order.copy, from_ms(15));
  EXPECT_EQ(last, from_ms(12));
  const auto overtaken = late.arrivals(from_ms(13), from_ms(13), last);
  EXPECT_EQ(overtaken.first, from_ms(16));
  EXPECT_EQ(last, from_ms(12)) << "those behind it do not wait";
}

TEST(DirectionOf, TellsDirectionsApart) {
  EXPECT_EQ(direction_of(1, 2), 0x1'0000'0002u);
  EXPECT_NE(direction_of(1, 2), direction_of(2, 1));
}

}  // namespace
}  // namespace simbench

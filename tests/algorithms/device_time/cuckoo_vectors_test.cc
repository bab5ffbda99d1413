// The vectors of cuckoo_time_translator (tests/data/README.md).
//
// Not applicable: unwrapper case 2, whose wrap number grows with the readings (a camera's register
// has a known size, and a reading above it cannot be); the unwrapping within the translator cases,
// whose readings lie 0.8 of the range apart, where the half-range rule rightly sees a late frame;
// the first output of translator case 2, a frame without a transmit stamp of its own; the
// stream_tolerance entry, which has no stream.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "algorithms/device_time/unwrap.h"
#include "laws/lower_hull.h"
#include "tests/data/test_data.h"

namespace simbench {
namespace {

using Json = nlohmann::json;

constexpr double kUnit = 1e6;  // of hull coordinates in one of the vectors'

LinePoint point_of(double x, double y) {
  return {std::llround(x * kUnit), std::llround(y * kUnit)};
}

double at(const SupportLine& line, double x) { return line.at(std::llround(x * kUnit)) / kUnit; }

class CuckooVectors : public ::testing::Test {
 protected:
  Json vectors_ = test_data_json("vectors/cuckoo.json");
};

TEST_F(CuckooVectors, ConvexHull) {
  ASSERT_EQ(vectors_["convex_hull"].size(), 4U);
  for (const Json& vector : vectors_["convex_hull"]) {
    LowerHull hull;
    SupportLine line;
    for (std::size_t i = 0; i < vector["feed"].size(); ++i) {
      const double x = vector["feed"][i][0];
      hull.add(point_of(x, vector["feed"][i][1]));
      line = middle_line(hull.vertices());
      EXPECT_DOUBLE_EQ(at(line, x), vector["out"][i]) << vector << " at " << i;
    }
    EXPECT_EQ(hull.vertices().size(), vector["state"]["stack"]) << vector;
    EXPECT_DOUBLE_EQ(at(line, 0), vector["state"]["offset"]) << vector;
    EXPECT_DOUBLE_EQ(line.slope, vector["state"]["skew"]) << vector;
  }
}

TEST_F(CuckooVectors, SwitchingHullTranslates) {
  const Json& vector = vectors_["switching_hull_period_2s"];
  SwitchingHull hull(std::llround(2 * kUnit));
  for (std::size_t i = 0; i < vector["feed"].size(); ++i) {
    const double x = vector["feed"][i][0];
    hull.add(point_of(x, vector["feed"][i][1]));
    EXPECT_DOUBLE_EQ(at(middle_line(hull.current()), x), vector["out"][i]) << i;
  }
}

// The vector's points lie on one line, where the source keeps all of them and an exact hull the two
// ends only. With a curvature of a millionth every point is a vertex, and the counts are the same.
TEST_F(CuckooVectors, SwitchingHullSwitches) {
  const Json& vector = vectors_["switching_hull_period_2s"];
  SwitchingHull hull(std::llround(2 * kUnit));
  int switches = 0;
  for (std::size_t i = 0; i < vector["feed"].size(); ++i) {
    const double x = vector["feed"][i][0];
    const double y = vector["feed"][i][1];
    hull.add(point_of(x, y + 1e-6 * x * x));
    if (i > 0 && hull.pending().size() == 1) ++switches;
    EXPECT_EQ(switches, vector["switch_count_after"][i]) << i;
    EXPECT_EQ(hull.current().size(), vector["stack_current"][i]) << i;
    EXPECT_EQ(hull.pending().size(), vector["stack_pending"][i]) << i;
  }
}

TEST_F(CuckooVectors, Unwrapper) {
  const Json& vector = vectors_["unwrapper"][0];
  ASSERT_EQ(vector["wrap"], 1000);
  CounterUnwrapper<1000> unwrapper;
  for (std::size_t i = 0; i < vector["feed"].size(); ++i) {
    const std::int64_t ticks = unwrapper.unwrap(vector["feed"][i]);
    EXPECT_EQ(ticks, vector["out"][i]);
    EXPECT_DOUBLE_EQ(static_cast<double>(ticks) / vector["hz"].get<double>(), vector["sec"][i]);
  }
}

TEST_F(CuckooVectors, DeviceTranslatorHull) {
  ASSERT_EQ(vectors_["device_translator_hull"].size(), 2U);
  for (const Json& vector : vectors_["device_translator_hull"]) {
    const double wrap = vector["wrap"];
    const double hz = vector["hz"];
    const bool transmits = vector.contains("transmit");
    LowerHull hull;
    double unwrapped = 0;
    for (std::size_t i = 0; i < vector["event"].size(); ++i) {
      const double event = vector["event"][i];
      double sent = transmits ? vector["transmit"][i].get<double>() : event;
      if (sent < unwrapped) sent += wrap;
      const double event_unwrapped = transmits || event >= unwrapped ? event : event + wrap;
      unwrapped = sent;
      hull.add(point_of(sent / hz, vector["recv"][i]));
      if (transmits && i == 0) continue;
      EXPECT_DOUBLE_EQ(at(middle_line(hull.vertices()), event_unwrapped / hz), vector["out"][i])
          << vector << " at " << i;
    }
  }
}

}  // namespace
}  // namespace simbench

#include "reports/text/metric_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace simbench::reports {
namespace {

using evaluation::metric;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TEST(MetricText, ADurationHasTheUnitThatFits) {
  EXPECT_EQ(metric_text(metric("amd_ms"), 0.0031), "3.10 us");
  EXPECT_EQ(metric_text(metric("amd_ms"), 1610), "1.61 s");
  const auto kind = evaluation::ResultKind::kClockRuns;
  EXPECT_EQ(metric_text(metric("recovery_s", kind), 90), "90.0 s");
  EXPECT_EQ(metric_text(metric("recovery_s", kind), 0.25), "250 ms");
}

TEST(MetricText, OthersHaveTheirOwnForm) {
  EXPECT_EQ(metric_text(metric("recall"), 0.873), "87.3 %");
  EXPECT_EQ(metric_text(metric("packets_per_s"), 14.71), "14.7");
  EXPECT_EQ(metric_text(metric("exposure_drift_ppm"), 20.04), "20.0 ppm");
  EXPECT_EQ(metric_text(metric("disturbed_frames"), 12.5), "12.5");
}

TEST(MetricText, OfADifferenceAndItsInterval) {
  EXPECT_EQ(difference_text(metric("amd_ms"), -0.002), "-2.00 us");
  EXPECT_EQ(difference_text(metric("recall"), -0.02), "-2.00 %");
  EXPECT_EQ(interval_text(metric("amd_ms"), 0.35, 1.2), "[0.350, 1.20] ms");
  EXPECT_EQ(interval_text(metric("recall"), -0.02, 0), "[-2.00, 0] %");
  EXPECT_EQ(interval_text(metric("packets_per_s"), 1, 2), "[1.00, 2.00]");
  EXPECT_EQ(difference_text(metric("exposure_drift_ppm"), -0.5), "-0.500 ppm");
  EXPECT_EQ(interval_text(metric("exposure_drift_ppm"), 1, 2), "[1.00, 2.00] ppm");
}

TEST(MetricText, WhatDoesNotExistIsADash) {
  for (const char* id : {"amd_ms", "recall", "packets_per_s", "exposure_drift_ppm"}) {
    EXPECT_EQ(metric_text(metric(id), kNone), "-");
    EXPECT_EQ(difference_text(metric(id), kNone), "-");
    EXPECT_EQ(interval_text(metric(id), 0, kNone), "-");
  }
}

}  // namespace
}  // namespace simbench::reports

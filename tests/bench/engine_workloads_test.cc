// The engine workloads against the checksums of docs/reference/event_engine.md section 1.
#include <gtest/gtest.h>

#include <stdexcept>

#include "bench/engine_workloads/models.h"
#include "bench/engine_workloads/workload.h"

namespace simbench::bench {
namespace {

TEST(EngineWorkloads, TablesHaveTheirCheckValues) {
  const WorkloadTables& tables = workload_tables();
  EXPECT_EQ(tables.hold_ns[0], 227267805);
  EXPECT_EQ(tables.hold_ns[1], 117328909);
  EXPECT_EQ(tables.hold_ns[2], 11770390);
  EXPECT_EQ(tables.stage_ns[0][0], 2041289);
  EXPECT_EQ(tables.stage_ns[1][0], 3127933);
  EXPECT_EQ(tables.stage_ns[2][0], 1001105);
  EXPECT_EQ(tables.stage_ns[3][0], 1814686);
  EXPECT_EQ(tables.stage_ns[4][0], 201883);
  EXPECT_EQ(trigger_phase_ns(0), 3841);
  EXPECT_EQ(trigger_phase_ns(1), 3399);
  EXPECT_EQ(trigger_phase_ns(2), 5296);
}

void expect_result(const WorkloadResult& result, std::uint64_t events, std::uint64_t checksum,
                   std::uint64_t order_checksum) {
  EXPECT_EQ(result.events, events);
  EXPECT_EQ(result.checksum, checksum);
  EXPECT_EQ(result.order_checksum, order_checksum);
}

TEST(EngineWorkloads, HoldGivesItsChecksums) {
  expect_result(run_hold(24, 1'000'000), 1'000'000, 0xf884765b21a4a47f, 0);
  expect_result(run_hold(1000, 1'000'000), 1'000'000, 0xd7fc17df79732e46, 0);
}

TEST(EngineWorkloads, RigGivesItsChecksums) {
  expect_result(run_rig(18, 20'000), 97'092, 0x0000001ecaf86a5d, 0x59cd8d0d3247f24c);
  expect_result(run_rig(180, 3'000), 144'720, 0x0000002e30bb9ad7, 0x3793dc70d149bc30);
  expect_result(run_rig(1800, 1'000), 475'201, 0x00000099f48d3836, 0x5cc85d641bbd4608);
}

TEST(EngineWorkloads, ReferenceGivesTheSameChecksums) {
  expect_result(run_hold_reference(24, 1'000'000), 1'000'000, 0xf884765b21a4a47f, 0);
  expect_result(run_rig_reference(180, 3'000), 144'720, 0x0000002e30bb9ad7, 0x3793dc70d149bc30);
}

TEST(EngineWorkloads, RefuseARunShorterThanItsWarmUp) {
  EXPECT_THROW(run_rig(18, 10), std::invalid_argument);
  EXPECT_THROW(run_rig_reference(18, 10), std::invalid_argument);
}

}  // namespace
}  // namespace simbench::bench

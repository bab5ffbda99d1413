#include "algorithms/registry.h"

#include <gmock/gmock.h>

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/algorithms/coded_trigger/coded_frames.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;

template <class Entry>
std::vector<std::string> entry_names(const std::vector<Entry>& entries) {
  std::vector<std::string> all;
  all.reserve(entries.size());
  for (const Entry& entry : entries) all.push_back(entry.info.name);
  return all;
}

class Constant : public DeviceTimeEstimator {
 public:
  GlobalTime stamp(const DeviceSample&) override { return GlobalTime(from_ms(1)); }
};

DeviceTimeEntry constant(const std::string& name) {
  return {.info = {.name = name, .family = name, .summary = "", .source = "test", .parameters = {}},
          .make = [](const Parameters&) { return std::make_unique<Constant>(); }};
}

TEST(Registry, ListsTheBuiltInAlgorithmsInOrder) {
  std::vector<std::string> device_time = entry_names(algorithms<DeviceTimeEntry>());
  device_time.resize(23);  // other tests may have registered more
  EXPECT_THAT(device_time,
              ElementsAre("regression_30", "regression_offline", "eq1_printed",
                          "eq1_interval_previous", "eq1_interval_current", "raw_arrival",
                          "sensor_normalised", "oracle", "regression_300", "regression_all",
                          "hull_300", "hull_switch_10s", "hull_switch_60s", "hull_offline",
                          "two_way_poll", "olson_50ppm", "minimum_1s", "theil_sen_300", "kalman",
                          "librealsense_global", "host_stamps", "rocsync_led", "coded"));
  std::vector<std::string> alignments = entry_names(algorithms<CaptureAlignmentEntry>());
  alignments.resize(8);  // likewise
  EXPECT_THAT(alignments,
              ElementsAre("free_run", "oracle", "libsoftwaresync", "rpi_sync", "scheduled_action",
                          "periodic_ptp", "pid_frame_rate", "phase_rate"));
  EXPECT_THAT(entry_names(algorithms<GatheringEntry>()),
              ElementsAre("yoon2021", "genlock", "genlock_printed", "approximate_time",
                          "approximate_time_bounded", "epsilon", "librealsense", "k4a",
                          "phase_binning", "coded_trigger", "certified", "oracle"));
}

TEST(Registry, MakesEveryBuiltInAlgorithm) {
  for (const DeviceTimeEntry& entry : nonempty(algorithms<DeviceTimeEntry>())) {
    EXPECT_FALSE(entry.info.summary.empty() && entry.info.source != "test") << entry.info.name;
    if (entry.info.name == "oracle") {
      EXPECT_FALSE(entry.make) << "only evaluation has the truth";
      continue;
    }
    const auto estimator = entry.make(check_parameters(entry.info.parameters, {}));
    const bool is_rocsync = entry.info.name == "rocsync_led";
    EXPECT_EQ(estimator->offline(), is_rocsync || entry.info.name.ends_with("_offline"))
        << entry.info.name;
    const bool is_relative = is_rocsync || entry.info.name == "sensor_normalised";
    EXPECT_EQ(estimator->relative(), is_relative || entry.info.name == "coded") << entry.info.name;
  }
  const GatheringSetup setup = {.sources = 2,
                                .period = from_ms(20),
                                .interval = from_ms(10),
                                .pulses = pulses_of(short_code())};
  for (const GatheringEntry& entry : nonempty(algorithms<GatheringEntry>())) {
    const auto gatherer = entry.make(check_parameters(entry.info.parameters, {}), setup);
    EXPECT_EQ(gatherer->discarded(), 0U);
    const bool counts = entry.info.family == "genlock" || entry.info.name == "coded_trigger";
    EXPECT_EQ(gatherer->from_first_frame(), counts) << entry.info.name;
  }
}

TEST(Registry, FindsByName) {
  ASSERT_NE(find_algorithm<GatheringEntry>("yoon2021"), nullptr);
  EXPECT_EQ(find_algorithm<GatheringEntry>("yoon2021")->info.name, "yoon2021");
  EXPECT_EQ(find_algorithm<GatheringEntry>("yoon"), nullptr);
  EXPECT_EQ(find_algorithm<DeviceTimeEntry>("yoon2021"), nullptr) << "names belong to a stage";
  EXPECT_EQ(find_algorithm<HostSyncEntry>("regression_30"), nullptr);
}

TEST(Registry, ReplacesAUsersAlgorithmButNoneOfItsOwn) {
  const std::string name = "registry_test_replaced";
  replace_algorithm<DeviceTimeEntry>(constant(name));
  const std::size_t count = algorithms<DeviceTimeEntry>().size();
  DeviceTimeEntry other = constant(name);
  other.info.summary = "another";
  replace_algorithm<DeviceTimeEntry>(other);
  EXPECT_EQ(algorithms<DeviceTimeEntry>().size(), count);
  EXPECT_EQ(find_algorithm<DeviceTimeEntry>(name)->info.summary, "another");
  EXPECT_THROW(replace_algorithm<DeviceTimeEntry>(constant("raw_arrival")), std::invalid_argument);
}

TEST(Registry, TakesAUsersAlgorithmOnce) {
  static int repetition = 0;  // of this test in this program
  const std::string name = "registry_test_constant" + std::to_string(repetition++);
  register_algorithm<DeviceTimeEntry>(constant(name));
  EXPECT_THAT(entry_names(algorithms<DeviceTimeEntry>()), Contains(name));
  const DeviceTimeEntry* entry = find_algorithm<DeviceTimeEntry>(name);
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry->make({})->stamp({}), GlobalTime(from_ms(1)));
  EXPECT_THROW(register_algorithm<DeviceTimeEntry>(constant(name)), std::invalid_argument);
  EXPECT_THROW(register_algorithm<DeviceTimeEntry>(constant("raw_arrival")), std::invalid_argument);
}

}  // namespace
}  // namespace simbench

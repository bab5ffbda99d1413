#include "algorithms/device_time/registration.h"

#include <utility>

#include "algorithms/device_time/equation1.h"
#include "algorithms/device_time/raw_arrival.h"
#include "algorithms/device_time/registration_clock_models.h"
#include "algorithms/device_time/registration_hull.h"
#include "algorithms/device_time/regression.h"
#include "algorithms/device_time/sensor_normalised.h"

namespace simbench {
namespace {

constexpr const char* kEquation1Source =
    "Yoon et al. 2021, eq. (1); docs/reference/paper.md section 3";

AlgorithmInfo info(const char* name, const char* family, const char* summary, const char* source) {
  return {.name = name, .family = family, .summary = summary, .source = source, .parameters = {}};
}

DeviceTimeEntry equation1(const char* name, Equation1Reading reading, const char* summary) {
  return {.info = info(name, "eq1", summary, kEquation1Source),
          .make = [reading](const Parameters&) { return make_equation1(reading); }};
}

DeviceTimeEntry regression(const char* name, std::size_t frames, const char* summary) {
  return {.info = info(name, "regression", summary, kEquation1Source),
          .make = [frames](const Parameters&) { return make_regression({frames}); }};
}

std::vector<DeviceTimeEntry> papers_estimators() {
  return {
      regression("regression_30", 30,
                 "regression of arrival on sensor stamp over the last 30 frames (R3, default)"),
      {.info = info("regression_offline", "regression",
                    "regression of arrival on sensor stamp over the whole recording (R3)",
                    kEquation1Source),
       .make = [](const Parameters&) { return make_offline_regression(); }},
      equation1("eq1_printed", Equation1Reading::kPrinted,
                "eq. (1) as printed, coefficients swapped (R0): nonsense, kept to show it"),
      equation1("eq1_interval_previous", Equation1Reading::kIntervalPrevious,
                "regression of intervals, added to the previous arrival (R1)"),
      equation1("eq1_interval_current", Equation1Reading::kIntervalCurrent,
                "regression of intervals, added to the current arrival (R2): a period late"),
      {.info = info("raw_arrival", "raw_arrival", "the arrival itself (R4)", kEquation1Source),
       .make = [](const Parameters&) { return make_raw_arrival(); }},
      {.info = info("sensor_normalised", "sensor_normalised",
                    "sensor stamp minus the camera's first: GenLock captures only",
                    "Yoon et al. 2021, GenLock; docs/reference/paper.md section 5"),
       .make = [](const Parameters&) { return make_sensor_normalised(); }},
      {.info = info("oracle", "oracle",
                    "the camera's own host's clock at the true mid-exposure: simulation only",
                    "the truth"),
       .make = nullptr},
      regression("regression_300", 300,
                 "regression of arrival on sensor stamp over the last 300 frames (R3)"),
      {.info = info("regression_all", "regression",
                    "regression of arrival on sensor stamp over all frames so far (R3)",
                    kEquation1Source),
       .make = [](const Parameters&) { return make_expanding_regression(); }},
  };
}

}  // namespace

std::vector<DeviceTimeEntry> builtin_device_time_algorithms() {
  std::vector<DeviceTimeEntry> all = papers_estimators();
  for (auto more : {hull_device_times(), clock_model_device_times()}) {
    for (DeviceTimeEntry& entry : more) all.push_back(std::move(entry));
  }
  return all;
}

}  // namespace simbench

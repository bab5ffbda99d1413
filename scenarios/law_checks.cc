#include "scenarios/law_checks.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenarios/loader.h"

namespace simbench::scenarios {

void check_quantiles(const Scenario& scenario, const std::string& pointer,
                     const std::vector<double>& table) {
  if (table.size() == 1) {
    fail_at(scenario, pointer,
            "found 1 number, allowed none or 2 to 1001, from the least to the largest");
  }
  const auto descent = std::is_sorted_until(table.begin(), table.end());
  if (descent == table.end()) return;
  fail_at(scenario, fmt::format("{}/{}", pointer, descent - table.begin()),
          fmt::format("found {}, allowed at least {}, the number before it: a table of quantiles "
                      "ascends",
                      *descent, *(descent - 1)));
}

void check_delay_law(const Scenario& scenario, const std::string& pointer, const DelayLaw& law) {
  check_quantiles(scenario, pointer + "/quantiles_us", law.quantiles_us);
  if (law.common_share == 0 || law.common_time_ms > 0) return;
  fail_at(scenario, pointer + "/common_time_ms",
          "found 0 or nothing, allowed more than 0 where common_share is above 0");
}

}  // namespace simbench::scenarios

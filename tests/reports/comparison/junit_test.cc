#include <gmock/gmock.h>

#include "reports/comparison/gate.h"
#include "tests/reports/sample_archive.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(GateJunit, HasACasePerMetricAndAFailureWithItsCommands) {
  Baseline baseline = make_baseline(sample_archive("before"));
  baseline.path = "b.json";
  Archive now = sample_archive("now");
  scale(now.results.rows[1].amd_ms, 2);
  now.results.rows[0].pipeline = "renamed";
  const std::string xml = gate_junit(gate(now, baseline, GateMode::kExact));
  EXPECT_THAT(xml, HasSubstr("<testsuites tests=\"5\" failures=\"2\" errors=\"0\""));
  EXPECT_THAT(xml, HasSubstr("<testcase classname=\"sample.plain\" name=\"exists\" time=\"0\">"));
  EXPECT_THAT(xml, HasSubstr("<testcase classname=\"sample.good\" name=\"RMDV\" time=\"0\"/>"));
  EXPECT_THAT(xml, HasSubstr("<failure message=\"AMD of good in sample, seeds 1-32: median"));
  EXPECT_THAT(xml, HasSubstr("simbench gate now --baseline b.json"));
  EXPECT_THAT(gate_junit(gate(sample_archive("now"), baseline, GateMode::kExact)),
              Not(HasSubstr("<failure")));
}

}  // namespace
}  // namespace simbench::reports

// A scenario with a studio, for the tests of reconstruction/.
#pragma once

#include "scenarios/loader.h"
#include "scenarios/scenario.h"

namespace simbench::reconstruction {

// 18 cameras at 6 angles and 3 heights, 3 on a host, 2 m around a standing person.
inline scenarios::Scenario studio_scenario() {
  return scenarios::load_scenario("18cam_6host_30fps_studio",
                                  {{.pointer = "/studio/subject/motion", .value = "\"stand\""}});
}

}  // namespace simbench::reconstruction

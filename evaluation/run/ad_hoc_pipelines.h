// Pipelines that a user states by their algorithms, beside those of the scenario:
//
//   two_way_hull+hull_switch_10s+yoon2021        host_sync+device_time+gathering
//   two_way_hull+phase_rate+hull_300+yoon2021    host_sync+capture_alignment+device_time+gathering
//   chrony                                       a host_sync alone, where the command allows it
//
// They become pipelines of the scenario, named by that text, so that archives, recordings and
// workers have them. A name that the scenario has is that pipeline.
//
//   const std::vector<std::string> names = {"oracle", "chrony+hull_300+yoon2021"};
//   const scenarios::Scenario scenario = scenarios::load_scenario(
//       "18cam_6host_45fps", with_ad_hoc_pipelines("18cam_6host_45fps", {}, names));
//   choose_pipelines(scenario, names);
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/loader.h"

namespace simbench::evaluation {

enum class AdHoc : std::uint8_t {
  kAllStages,
  kHostSyncToo,  // a host_sync alone as well, with the other stages of the scenario's first
                 // pipeline
};

// `overrides` and those that append to the scenario the pipelines among `names` that it lacks.
// Throws scenarios::InputError, "--pipelines TEXT: found ..., allowed ...", for another number of
// parts; unknown algorithms are choose_pipelines()'s to refuse.
std::vector<scenarios::Override> with_ad_hoc_pipelines(const std::string& scenario,
                                                       std::vector<scenarios::Override> overrides,
                                                       const std::vector<std::string>& names,
                                                       AdHoc allowed = AdHoc::kAllStages);

// A pipeline of algorithms, as a scenario's /pipelines states it.
std::string pipeline_json(const scenarios::Pipeline& pipeline);

}  // namespace simbench::evaluation

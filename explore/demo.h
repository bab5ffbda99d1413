// A page that needs no server: a grid of worlds that were computed before, over a few parameters.
//
// It is the page of `simbench explore` with sliders for these parameters alone, which move from
// point to point of the grid. Each world has the answer, the overview, the table and the figure
// over the seeds that the served page shows of it. All is in one file, which opens offline.
//
// Stored as JSON, deflated (RFC 1950) and in base64:
//
//   {"subject": as explorer.h has it, "seeds", "parameters": [as parameters_json(), with "steps":
//   the values], "worlds": {"0,2,1": [events of a look (look.h): worlds, picture, figures]}}
//
// Errors: scenarios::InputError: an axis that is none, one of lockstep, one that makes a world that
// cannot be (all are checked first), more than kMostDemoWorlds worlds, a page beyond
// kMostDemoBytes; EvaluationCancelled.
//
//   const std::string html = demo_html({.name = "18cam_6host_45fps"},
//       {.axes = {"/usb/delivery_jitter_transfers=0.01,0.1,1"}, .seeds = 16}, progress);
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "explore/state.h"

namespace simbench::explore {

inline constexpr std::size_t kMostDemoWorlds = 2000;
inline constexpr std::size_t kMostDemoBytes = 5'000'000;

struct DemoRequest {
  std::vector<std::string> axes;  // as evaluation/sweep/sweep_plan.h reads them; one to five
  std::uint64_t seeds = 16;
};

// What is varied where nobody chooses.
std::vector<std::string> usual_axes();

// Progress counts worlds.
std::string demo_html(const PageSubject& subject, const DemoRequest& request,
                      const evaluation::Progress& progress);

}  // namespace simbench::explore

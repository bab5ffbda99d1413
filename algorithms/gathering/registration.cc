#include "algorithms/gathering/registration.h"

#include "algorithms/gathering/genlock.h"
#include "algorithms/gathering/yoon2021.h"

namespace simbench {
namespace {

GatheringEntry genlock(const char* name, GenlockOrder::Variant variant, const char* summary) {
  return {.info = {.name = name,
                   .family = "genlock",
                   .summary = summary,
                   .source = "Yoon et al. 2021, GenLock; reference/paper.md section 8",
                   .parameters = {}},
          .make = [variant](const Parameters&, const GatheringSetup& setup) {
            return make_genlock_gatherer(setup, variant);
          }};
}

}  // namespace

std::vector<GatheringEntry> builtin_gathering_algorithms() {
  return {
      {.info = {.name = "yoon2021",
                .family = "yoon2021",
                .summary = "fronts within T_int are a set, else the earliest front is given up",
                .source = "Yoon et al. 2021, Algorithm 3; reference/paper.md section 5",
                .parameters = {}},
       .make = [](const Parameters&,
                  const GatheringSetup& setup) { return make_yoon2021_gatherer(setup); }},
      genlock("genlock", GenlockOrder::Variant::kReanchored,
              "frames of one trigger pulse, counted from frame to frame"),
      genlock("genlock_printed", GenlockOrder::Variant::kFirstStamp,
              "frames of one trigger pulse, counted from the first stamp: drifts (as printed)"),
  };
}

}  // namespace simbench

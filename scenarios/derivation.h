// What a scenario rests on and how its world differs from that, for every output: a number of a
// changed world must not pass for one of the world whose name it has.
//
// A scenario rests on the nearest built-in scenario in the chain of its bases; without one on the
// built-in scenario of its own name (as the resolved scenario of an archive does), else on its own
// file. Values count if they change the world, the parameters of algorithms or the scores: all but
// name, summary, published values, the choice of pipelines and /evaluation/table. A pipeline that
// keeps its name but not its stages is a change.
//
//   const Scenario s = load_scenario("18cam_6host_45fps", {{"/trigger/rate_hz", "30"}});
//   named(s.name, s.derivation);     // "18cam_6host_45fps (changed)"
//   changed_text(s.derivation);      // "changed: /trigger/rate_hz 45 → 30"
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace simbench::scenarios {

// A value that is no object and no list of objects. As JSON; "": it is not there.
struct Change {
  std::string pointer;
  std::string from;
  std::string to;
};

struct Derivation {
  std::string base{};             // the name of what it rests on; "": it is that itself
  std::vector<Change> changes{};  // in the order of the document; empty without a base
  // The scenario whose published values were left out, since its world is another one; mostly "".
  std::string unpublished{};
};

// "18cam_6host_45fps", "18cam_6host_45fps (changed)", "my_rig (based on 18cam_6host_45fps)".
std::string named(const std::string& scenario, const Derivation& derivation);

// "changed: /trigger/rate_hz 45 → 30, /cameras/count 18 → 12"; "" if nothing is. More than `most`
// changes are cut: "..., and 3 more".
std::string changed_text(const Derivation& derivation,
                         std::size_t most = std::numeric_limits<std::size_t>::max());

// Why there are no published values; "" if none were left out.
std::string unpublished_text(const Derivation& derivation);

// The paragraphs of these two that there are, for the head of a report.
std::vector<std::string> derivation_lines(const Derivation& derivation);

}  // namespace simbench::scenarios

// Loading a scenario: file or built-in name, inheritance, overrides, validation.
//
// A scenario is JSON. "base" names another scenario (built in, or a path relative to the file)
// whose members it inherits by RFC 7386 merge; its pipelines may come from another scenario
// (included_pipelines.h); --set overrides apply last. The result is validated
// against scenarios/schema.json and then by the checks that a schema cannot express. The first
// mistake is thrown as an InputError; nothing is guessed.
//
// What holds in one world alone goes when a later file or --set changes that world: published
// values are left out, and a summary is replaced by world_text(). Scenario::derivation has the
// changes.
//
// The scenarios of the distribution are built into the program, so they need no installed files.
//
//   Scenario s = load_scenario("18cam_6host_45fps", {{"/timeline/frames", "100"}});
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace simbench::scenarios {

// Bad input. what() is the message for the user: "FILE:LINE: /json/pointer: found ..., allowed
// ...".
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// One --set /json/pointer=value. A value that does not parse as JSON is text. The last key "-" of
// an array appends to it (RFC 6901).
struct Override {
  std::string pointer;
  std::string value;
  std::string label{};  // what messages call it; empty: "--set /json/pointer=value"
};

// The source of each JSON pointer of a resolved scenario: a file and line, or a --set.
class Origin {
 public:
  virtual ~Origin() = default;
  // "FILE:LINE: /pointer" (or "--set /pointer") of the nearest known place.
  virtual std::string describe(const std::string& pointer) const = 0;
  // Whether that place is a --set, or a file that is none of the distribution's.
  virtual bool is_set(const std::string& /*pointer*/) const { return false; }
  virtual bool is_of_a_users_file(const std::string& /*pointer*/) const { return false; }
};

// `name_or_path`: a built-in scenario's name, or a path to a .json file. Throws InputError.
Scenario load_scenario(const std::string& name_or_path,
                       const std::vector<Override>& overrides = {});

// Loads text as if it were the content of `file_name`; the fuzz target's way in.
Scenario load_scenario_text(const std::string& text, const std::string& file_name,
                            const std::vector<Override>& overrides = {});

struct BuiltinScenario {
  std::string name;
  std::string summary;
};
// In alphabetical order.
std::vector<BuiltinScenario> builtin_scenarios();

// Settings that are possible but suspicious, one line each: more bytes than USB carries (with the
// drop rate to expect), an exposure that makes the camera miss pulses, ...
std::vector<std::string> warnings(const Scenario& scenario);
// What makes pulses be lost in this world, "/cameras/exposure_ms: exposures of up to 40.00 ms ...":
// those of the warnings, and stated losses; none where no
// world is stated (files). Frames may be lost without (a burst of jitter).
std::vector<std::string> loss_reasons(const Scenario& scenario);

// The world in one line, as it is: cameras, hosts, sync mode, rates, the scored stream, frames.
std::string world_text(const Scenario& scenario);

// One line per parameter of the resolved scenario.
struct ParameterLine {
  std::string pointer;
  std::string value;
  std::string unit;
  std::string meaning;
  std::string source;
};
std::vector<ParameterLine> describe(const Scenario& scenario);

// Throws InputError about a place in a loaded scenario; for checks of the scenario's users.
[[noreturn]] void fail_at(const Scenario& scenario, const std::string& pointer,
                          const std::string& problem);

// The nearest names, for "did you mean": at most three, by edit distance.
std::vector<std::string> nearest(const std::string& name, const std::vector<std::string>& known);

}  // namespace simbench::scenarios

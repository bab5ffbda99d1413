// A state of the page: a world with what was changed in it, and the pipelines that are looked at.
//
// A state comes from a page and is not trusted: its world is a scenario of the distribution or the
// one that the user named when the page was started, so that a page reads no other file, and only
// parameters of worlds and algorithms can be set, so that it starts no program.
//
// Errors: StateRefused, with the pointer beside which the page shows the message.
//
//   const State state = state_of(reports::Json::parse(body), subject);
//   const scenarios::Scenario world = world_of(state, subject);
//   print(command_of(state, subject, 32));   // what does the same without a page
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "reports/text/json_node.h"
#include "scenarios/loader.h"
#include "scenarios/scenario.h"

namespace simbench::explore {

inline constexpr std::uint64_t kFirstSeeds = 8;  // of the first picture
inline constexpr std::uint64_t kMostSeeds = 1024;

struct Measured;

// What the user named when the page was started.
struct PageSubject {
  std::string name;                         // of a built-in scenario, or the path of a file
  std::optional<std::string> text{};        // of a file as it was then; nothing: built in
  std::vector<scenarios::Override> sets{};  // of the command line, which come first
  std::vector<std::string> pipelines{};     // to begin with; empty: all
  std::uint64_t first_seed = 1;
  std::shared_ptr<const Measured> measured{};  // the rig that it was fitted to (measured.h)
};

struct State {
  std::string scenario;
  std::vector<scenarios::Override> sets{};
  std::vector<std::string> pipelines{};  // empty: all of the scenario but those of programs
  std::uint64_t first_seed = 1;
};

// A world that cannot be, or a state that no page sends.
class StateRefused : public std::runtime_error {
 public:
  StateRefused(std::string pointer, const std::string& text)
      : std::runtime_error(text), pointer_(std::move(pointer)) {}
  // The parameter that is to blame; "": none, or unknown.
  const std::string& pointer() const { return pointer_; }

 private:
  std::string pointer_;
};

// Whether a pointer is of a parameter that a page may set: not of pipelines, names and what is
// published.
bool is_of_a_world(const std::string& pointer);

// Whether a scenario of the distribution has this name.
bool is_builtin_scenario(const std::string& name);

// {"scenario", "sets": [{"pointer", "value": any JSON}], "pipelines": [names], "first_seed"}; all
// but the scenario may be left out.
State state_of(const reports::Json& json, const PageSubject& subject);

// A page plays with worlds up to this size: frames of all cameras in a run, and hosts.
inline constexpr double kMostFrames = 1e6;
inline constexpr std::int64_t kMostHosts = 1000;

// The world, with the pipelines of the state alone.
scenarios::Scenario world_of(const State& state, const PageSubject& subject);

// What does the same without a page: the words of a command line, a script in Python, and a
// scenario file of the base and the differences.
std::vector<std::string> command_of(const State& state, const PageSubject& subject,
                                    std::uint64_t seeds);
std::string python_of(const State& state, const PageSubject& subject, std::uint64_t seeds);
std::string file_of(const State& state, const PageSubject& subject);

}  // namespace simbench::explore

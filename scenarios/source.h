// The text of a scenario file and where it lies: built into the program, on disk, or in memory.
#ifndef SIMBENCH_SCENARIOS_SOURCE_H_
#define SIMBENCH_SCENARIOS_SOURCE_H_

#include <string>

namespace simbench::scenarios {

struct Source {
  std::string label;  // the file's name in messages
  std::string text;
  bool is_builtin = false;
};

// What the user named: a built-in scenario, else a file. Throws InputError.
Source find_source(const std::string& name_or_path);

// What `from` names as its base; a path is relative to the folder of `from`. A scenario built into
// the program may only name another one. Throws InputError, whose message begins with `place`.
Source find_base(const Source& from, const std::string& base, const std::string& place);

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_SOURCE_H_

// Where each value of a scenario came from: which file and line, or which --set.
//
// Kept beside the JSON value while files and overrides are merged, so that a message about the
// resolved scenario can still name the line that the user wrote.
#ifndef SIMBENCH_SCENARIOS_PLACES_H_
#define SIMBENCH_SCENARIOS_PLACES_H_

#include <cstddef>
#include <map>
#include <string>

#include "scenarios/loader.h"

namespace simbench::scenarios {

struct Place {
  std::string label;        // "FILE:LINE" or "--set /pointer=value"
  std::string set_pointer;  // of a --set: the pointer it names
  bool is_set = false;
  bool is_builtin = false;  // a file of the distribution
  std::size_t level = 0;    // later sources have higher levels
  std::size_t line = 0;
};

class Places final : public Origin {
 public:
  std::string describe(const std::string& pointer) const override;

  // The place of `pointer`, else of its nearest ancestor that has one.
  const Place& nearest(const std::string& pointer) const;

  void set(const std::string& pointer, Place place);
  // The highest level of `pointer` and everything below it.
  std::size_t latest_level(const std::string& pointer) const;
  // Forgets `pointer` and everything below it.
  void erase(const std::string& pointer);
  // Takes over from `other` the places of `pointer` and of everything below it.
  void adopt(const std::string& pointer, const Places& other);

 private:
  std::map<std::string, Place> places_;
};

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_PLACES_H_

// A text as one word of a command for /bin/sh, and for the shells that quote like it.
//
//   shell_quoted("it's");
#ifndef SIMBENCH_HARDWARE_SHELL_QUOTED_H_
#define SIMBENCH_HARDWARE_SHELL_QUOTED_H_

#include <string>

namespace simbench::hardware {

inline std::string shell_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_SHELL_QUOTED_H_

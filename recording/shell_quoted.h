// A text as one word of a command for /bin/sh, and for the shells that quote like it.
//
//   shell_quoted("it's");
#pragma once

#include <string>

namespace simbench {

inline std::string shell_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

}  // namespace simbench

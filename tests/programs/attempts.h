// What the programs that try to get out of the simulated world have in common. What fails without
// ending the program is printed, as "NAME: errno"; then "still there", and it exits with status 0.
//
//   constexpr Attempt kAttempts[] = {{"read", [] { say("read", open(path, O_RDONLY)); }}};
//   int main(int count, char** words) { return make(kAttempts, count, words); }
#pragma once

#include <errno.h>

#include <cstdio>
#include <cstring>
#include <span>

namespace attempts {

// The second word of the command.
inline const char* path = "";

inline void say(const char* name, long result) {
  std::printf("%s: %s\n", name, result >= 0 ? "succeeded" : strerrorname_np(errno));
  std::fflush(stdout);
}

struct Attempt {
  const char* name;
  void (*make)();
};

inline int make(std::span<const Attempt> all, int count, char** words) {
  if (count > 2) path = words[2];
  for (const Attempt& attempt : all) {
    if (count < 2 || std::strcmp(words[1], attempt.name) != 0) continue;
    attempt.make();
    std::puts("still there");
    return 0;
  }
  std::fputs("usage: escapes ATTEMPT [PATH]\n", stderr);
  return 2;
}

}  // namespace attempts

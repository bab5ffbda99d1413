// Programs that end: simbench_endings WHAT.
//
//   set          sets the clock, as a one-shot client does, and ends with status 0
//   adjust       steers it by adjtimex(), likewise
//   nothing      ends with status 0 after a while, and leaves the clock alone
//   late         fails after 2.5 s
//   tidy         fails, with a last line that is long, coloured and no UTF-8
//   unlucky HOST sets the clock and goes on for ever; on host 2 it fails in some worlds
//   steady       fails if a sleep until a time of the monotonic clock is refused or too long
//   wait         goes on for ever
#include <sys/random.h>
#include <sys/timex.h>

#include <cstring>
#include <string>

#include "tests/programs/promises.h"

namespace {

using promises::expect;

int set() {
  timespec now{};
  expect(clock_gettime(CLOCK_REALTIME, &now) == 0, "clock_gettime");
  expect(clock_settime(CLOCK_REALTIME, &now) == 0, "clock_settime");
  return 0;
}

int adjust() {
  timex wanted{};
  wanted.modes = ADJ_FREQUENCY;
  wanted.freq = 65536 * 3;
  expect(adjtimex(&wanted) >= 0, "adjtimex");
  return 0;
}

int nothing() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  const timespec while_it_lasts{.tv_sec = 1, .tv_nsec = 500'000'000};
  nanosleep(&while_it_lasts, nullptr);
  return 0;
}

int late() {
  const timespec while_it_lasts{.tv_sec = 2, .tv_nsec = 500'000'000};
  nanosleep(&while_it_lasts, nullptr);
  std::puts("lost patience");
  return 4;
}

int tidy() {
  std::puts("first line");
  std::printf("last \x1b[31mred\x07 \xff %s \n\n", std::string(2000, 'x').c_str());
  return 5;
}

int unlucky(const char* host) {
  set();
  unsigned char chance = 0;
  expect(getrandom(&chance, sizeof chance, 0) == sizeof chance, "getrandom");
  if (std::strcmp(host, "2") != 0 || chance < 128) return -1;
  std::puts("out of luck");
  return 4;
}

int steady() {
  set();
  const std::int64_t begin = promises::read_clock(CLOCK_MONOTONIC);
  const timespec until{.tv_sec = begin / promises::kSecond + 1, .tv_nsec = 0};
  const int refusal = clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
  const std::int64_t slept = promises::read_clock(CLOCK_MONOTONIC) - begin;
  return begin > 0 && refusal == 0 && slept < 2 * promises::kSecond ? 0 : 6;
}

}  // namespace

int main(int count, char** words) {
  const char* what = count > 1 ? words[1] : "";
  if (std::strcmp(what, "set") == 0) return set();
  if (std::strcmp(what, "adjust") == 0) return adjust();
  if (std::strcmp(what, "nothing") == 0) return nothing();
  if (std::strcmp(what, "late") == 0) return late();
  if (std::strcmp(what, "tidy") == 0) return tidy();
  if (std::strcmp(what, "steady") == 0) return steady();
  if (std::strcmp(what, "unlucky") == 0 && count == 3) {
    if (const int status = unlucky(words[2]); status >= 0) return status;
  }
  for (;;) sleep(3600);
}

// The machine's system calls, past libc and past the shim's own syscall().
//
//   if (machine_call(SYS_close, 7) < 0) print(errno);
//
// Source: syscall(2), "Architecture calling conventions".
#pragma once

#include <errno.h>

#include <cstdint>

namespace simbench::shim {

using Word = long;

// Returns what the kernel does: a result, or minus an errno.
inline Word kernel_call(Word number, Word a = 0, Word b = 0, Word c = 0, Word d = 0, Word e = 0,
                        Word f = 0) {
#if defined(__x86_64__)
  Word result = number;
  register Word fourth __asm__("r10") = d;
  register Word fifth __asm__("r8") = e;
  register Word sixth __asm__("r9") = f;
  __asm__ volatile("syscall"
                   : "+a"(result)
                   : "D"(a), "S"(b), "d"(c), "r"(fourth), "r"(fifth), "r"(sixth)
                   : "rcx", "r11", "memory");
  return result;
#elif defined(__aarch64__)
  register Word call __asm__("x8") = number;
  register Word first __asm__("x0") = a;
  register Word second __asm__("x1") = b;
  register Word third __asm__("x2") = c;
  register Word fourth __asm__("x3") = d;
  register Word fifth __asm__("x4") = e;
  register Word sixth __asm__("x5") = f;
  __asm__ volatile("svc #0"
                   : "+r"(first)
                   : "r"(call), "r"(second), "r"(third), "r"(fourth), "r"(fifth), "r"(sixth)
                   : "memory");
  return first;
#else
#error "how this architecture calls the kernel is not known"
#endif
}

template <class Argument>
Word to_word(Argument argument) {
  if constexpr (__is_same(Argument, decltype(nullptr))) {
    return 0;
  } else {
    return (Word)argument;  // NOLINT: pointers and integers alike
  }
}

// The pointer that an argument or a result is.
template <class Value>
Value* at(Word word) {
  return reinterpret_cast<Value*>(word);  // NOLINT: the kernel has it as a number
}

// As libc's syscall(): returns -1 with errno.
template <class... Arguments>
Word machine_call(Word number, Arguments... arguments) {
  const Word result = kernel_call(number, to_word(arguments)...);
  if (result >= 0 || result < -4095) return result;
  errno = static_cast<int>(-result);
  return -1;
}

}  // namespace simbench::shim

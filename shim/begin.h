// What the shim does before a program's own code, and in a process that has been forked.
//
//   serve_refused_calls();
//   hide_machine(environ);
#pragma once

#include <signal.h>

#include <cstddef>
#include <cstdint>

#include "shim/link.h"

namespace simbench::shim {

// This handler is the shim's own; it may be interrupted by itself.
void handle_in_shim(int signal, void (*handler)(int, siginfo_t*, void*));
// Takes the signal by which the kernel's filter hands over the calls that pass libc by.
void serve_refused_calls();
// The machine's clocks, and the chance that the kernel gave, are out of the program's sight.
void hide_machine(char** environment);
// Looks when the machine's files were new.
void begin_files();
// Has end_thread() called at the end of this thread.
void watch_thread();
// What a program that this one has become, or was started by, had of the world: `text` is
// kDescriptorsVariable's. Returns how many numbers it has written.
std::size_t take_descriptors(const char* text, std::int32_t* numbers);
// In a forked process: timers, children and the like are not its own.
void forget_parent();

}  // namespace simbench::shim

// The processes that a program has started, and what starts others.
//
//   char name[] = "chronyd";
//   char* const words[] = {name, nullptr};
//   return execute("/usr/sbin/chronyd", words, environ);
#pragma once

#include <sys/types.h>

#include <cstddef>

#include "shim/link.h"

namespace simbench::shim {

// A child of this process by the world's number and the machine's.
void add_child(int number, pid_t machine);
// -1: not a child of this process.
pid_t machine_number_of_child(int number);
// The world's number of a process that the machine calls so; -1: of none.
int number_of_process(pid_t machine);

// The environment of a program that is started from here, with what the shim needs. It lies in
// memory of its own until it is destroyed.
class Environment {
 public:
  Environment(char* const* wanted, int link, bool has_descriptors);
  ~Environment();
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
  // Null if there is no memory.
  char* const* words() const { return words_; }

 private:
  char** words_ = nullptr;
  std::size_t size_ = 0;
};

// As execve(); gives up for a program that the preloaded library cannot reach.
int execute(const char* given, char* const* words, char* const* environment);
// Whether hosts do not have it: ldconfig, which is static, and which Python asks for libraries.
bool is_absent_program(const char* path);
// Gives up if the preloaded library cannot reach it; a file that is not there is for the caller.
void check_reach(const char* path);
// Where a name without a slash is found by PATH; the name itself if it is nowhere.
const char* search(const char* name, char* room, std::size_t size);
// What this process may tell the program that it becomes about its descriptors, as
// kDescriptorsVariable has it.
void write_descriptors(char* room, std::size_t size);

}  // namespace simbench::shim

// Who runs root's programs: nobody, where that can be.
//
// As nobody a program meets what the machine allows to everybody, also where Landlock does not
// look: sockets in the file system above all. It cannot be where what the program needs lies behind
// a folder that only root may enter, or where the user is not there (containers without all
// numbers). It is then root without any of root's capabilities.
//
//   const std::string obstacle = obstacle_to_nobody({"/usr/sbin/chronyd", "world/host0"});
//   if (obstacle.empty()) give_to_nobody("world/host0");
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace simbench::processes {

inline constexpr uid_t kNobody = 65534;  // user and group

bool is_root();

// What is in the way of nobody, who is to read these files and use these folders; empty: nothing.
// Paths that are not there are in nobody's way. Lists of access rights (acl(5)) are not looked at.
std::string obstacle_to_nobody(const std::vector<std::string>& paths);

// As root: the file or folder is nobody's from now on.
void give_to_nobody(int descriptor);
void give_to_nobody(const std::string& path);  // no link

// As root: everybody may go through the folder, and see no more of it.
void let_pass(const std::string& folder);

// In a new process, for good; makes async-signal-safe calls only. Returns false with errno.
bool become_nobody();

}  // namespace simbench::processes

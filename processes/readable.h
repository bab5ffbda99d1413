// What a program may read and execute on the machine, its own folder apart.
//
//   the program          the file, its folder and, of a program in .../bin or .../sbin, the folders
//                        lib, lib64, libexec and share beside that; for links, where they lead too
//   its words            each file or folder that a word names by an absolute path, of a file the
//                        folder too: scripts have modules
//   libraries            /lib, /lib32, /lib64, /usr, /bin, /sbin, the folders of the environment's
//                        LD_LIBRARY_PATH, PATH and PYTHONPATH
//   of /etc              what the C library, Python and TLS look at (kSystemFiles)
//   of /dev              null, zero, full
//   of /proc             what it is itself (processes/own_process_files.h)
//   what the description names as readable
//
// A folder that many share is not read as a whole because a program or a word lies in it: one right
// below /, a user's home, one into which everybody may write.
//
// Where the machine's network and chance are the program's (Served::kClock), it also reads
// /etc/resolv.conf, /etc/hosts, /dev/random, /dev/urandom and /sys/class/net.
//
//   readable_paths({.program = "/opt/x/bin/daemon"});  // /opt/x/bin, /opt/x/lib, /usr, ...
#pragma once

#include <map>
#include <string>
#include <vector>

#include "processes/call_filter.h"

namespace simbench::processes {

struct ReadableOf {
  std::string program;               // absolute
  std::vector<std::string> words{};  // that follow
  std::map<std::string, std::string> environment{};
  std::string shim{};
  std::vector<std::string> readable{};
  Served served = Served::kAll;
};

inline constexpr const char* kSystemFiles[] = {
    "/etc/group",     "/etc/host.conf", "/etc/ld.so.cache",   "/etc/ld.so.preload",
    "/etc/localtime", "/etc/networks",  "/etc/nsswitch.conf", "/etc/passwd",
    "/etc/protocols", "/etc/services",  "/etc/ssl/certs",     "/etc/ssl/openssl.cnf",
    "/etc/timezone"};

// Absolute; some may not be there.
std::vector<std::string> readable_paths(const ReadableOf& of);

// What of these the program cannot do without: itself, what its words name, its libraries.
std::vector<std::string> needed_paths(const ReadableOf& of);

}  // namespace simbench::processes

// Where a program's files are: in the folder of its host, which it sees as kFolder.
//
//   /files/NAME             the host's folder: NAME
//   other absolute paths    the file of that name in the host's folder if it is there
//                           (etc/ntp.conf), else the machine's. Folders of the machine's stay, and
//                           list the names of both
//   /run, /var, /tmp, /dev/shm (and what is below): what is made there is in the host's folder,
//                           with the folders that lead to it. These four list the host's files
//   /proc, /sys             of the machine's only what the process is itself (shim/proc.h)
//
// The machine's files can be read as far as it is allowed; nothing of its is written. What it may
// not read below /run, /var, /tmp and /dev/shm is not there.
//
//   const OwnPath path("/run/chrony/chronyd.pid", Use::kCreates);
//   print(path.text());  // "FOLDER/host1/run/chrony/chronyd.pid"
#pragma once

#include <limits.h>

#include <cstddef>

#include "shim/protocol.h"

namespace simbench::shim {

enum class Use { kReads, kCreates };

class OwnPath {
 public:
  // Null stays null.
  explicit OwnPath(const char* path, Use use = Use::kReads);
  // Relative to an open folder, which does not matter for what is absolute.
  const char* text() const { return text_; }
  // The other one of the host's folder and the machine's of this name: both have names. Null:
  // there is one.
  const char* besides() const { return besides_; }

 private:
  const char* text_;
  const char* besides_ = nullptr;
  char room_[PATH_MAX];
};

// Once: the folder that the program begins in.
void take_folder(const char* given);
const char* own_folder();
// The path as the program sees it: kFolder and what follows; the path itself if it is elsewhere.
const char* seen_path(const char* path, char* room, std::size_t size);

}  // namespace simbench::shim

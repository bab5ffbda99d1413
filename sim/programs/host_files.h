// The files of a simulated host as its programs see them: numbers in the order in which they were
// first looked at, and times by the host's system clock.
//
// The kernel stamps what a program writes with the machine's time. When a file was written to by
// the host's clock is known to the next look at it, or at the end, when stamp_all() gives all that
// have the machine's time the host's (shim/protocol.h).
//
// Sights are not trusted: of more than kMost files no number is kept.
//
//   void look(SimHost& host) {
//     HostFiles files(host, "world/host0");
//     const HostFiles::Seen seen = files.look({.device = 1, .file = 2});
//     print(seen.number);  // 1
//     files.stamp_all();
//   }
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>

#include "shim/protocol.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {

class HostFiles {
 public:
  static constexpr std::int64_t kMost = 100'000;

  struct Seen {
    std::int64_t number = -1;
    std::int64_t modified = 0;  // ns since 1970, by the host's clock
  };

  // The host must outlive this; the folder is a path.
  HostFiles(SimHost& host, std::string folder);

  // Number -1: there are too many.
  Seen look(const shim::FileSight& sight);
  // All that is in the folder, and the folder itself. Its programs have ended; links are not
  // followed. What cannot be reached stays as it is.
  void stamp_all();

 private:
  struct File {
    std::int64_t number = 0;
    std::int64_t by_machine = 0;
    std::int64_t by_host = 0;
  };
  using Key = std::tuple<std::uint64_t, std::uint64_t, std::int64_t>;

  std::int64_t host_now() const;
  // `parent` is an open folder.
  void stamp(int parent, const char* name, std::int64_t born);
  void stamp_within(int folder, std::int64_t born);

  SimHost& host_;
  std::string folder_;
  std::map<Key, File> files_{};
  std::int64_t last_number_ = 0;
};

}  // namespace simbench::sim

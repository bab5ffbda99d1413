// Debian's chronyd, ntpd and ptp4l, unmodified, in the simulated world: what their tests share.
//
//   class Mine : public Daemons {};
//   const std::vector<Course> slaves = run(chronyd("server {master}"), scenario, 10'000, 1e-3);
#pragma once

#include <string>

#include "tests/sim/programs/real_programs.h"

namespace simbench::sim {

inline constexpr const char* kChronydEnd =
    "\ncmdport 0\npidfile {files}/chronyd.pid\nbindcmdaddress /\n";

class Daemons : public RealPrograms {
 protected:
  ProgramSettings chronyd(const std::string& client) const {
    const auto command = [](const char* file) {
      return Command{"chronyd", "-d", "-f", std::string("{files}/") + file};
    };
    return settings({command("server.conf")}, {command("client.conf")},
                    {{"server.conf", std::string("local stratum 1\nallow") + kChronydEnd},
                     {"client.conf", client + kChronydEnd}});
  }
};

}  // namespace simbench::sim

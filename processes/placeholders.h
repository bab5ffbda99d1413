// The places in programs' commands, files and environment that differ from host to host.
//
//   {master}        the address of the host that this one follows, the master's own of the master
//   {address}       the host's own
//   {host}          its number, 0 for the master
//   {interface}     its network interface
//   {files}         the host's folder, in which programs begin: /files in the simulated world, the
//                   machine's path on real hosts
//   {ntp_drift}     what ntpd's drift file says: the correction in use when it was written, in ppm
//   {chrony_drift}  what chronyd's says: how fast the clock was, and the error of that, in ppm
//
// The last two are of hosts that have a drift file (scenario /hosts/drift_file). A file whose text
// has them is there on those alone: it is what an earlier run left.
//
// Other braces are text, unless they hold a lower-case word: that is likely a mistake.
//
//   fill("server {master} iburst", {.host = 3});  // "server 10.0.0.1 iburst"
//   unknown_placeholder("server {mastr}");        // "{mastr}"
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/ports/host.h"
#include "scenarios/scenario.h"
#include "shim/protocol.h"

namespace simbench::processes {

// Host i has the address 10.0.0.1 + i in 10.0.0.0/16, in host byte order.
inline constexpr std::uint32_t kFirstAddress = 0x0A000001;
inline constexpr std::uint32_t kNetmask = 0xFFFF0000;
constexpr std::uint32_t address_of(PeerId host) { return kFirstAddress + host; }

inline constexpr char kPlaceholders[] =
    "{master}, {address}, {host}, {interface}, {files}, {ntp_drift}, {chrony_drift}";

struct HostPlaces {
  PeerId host = 0;
  PeerId follows = 0;
  std::optional<StoredFrequency> drift{};
  const char* interface = "eth0";
  std::string files = shim::kFolder;  // what the host's folder is to its programs
};

std::string fill(std::string text, const HostPlaces& places);
std::vector<std::string> fill(std::vector<std::string> command, const HostPlaces& places);
std::map<std::string, std::string> fill(std::map<std::string, std::string> environment,
                                        const HostPlaces& places);
// The host's folder, made anew (an earlier run's drift file would be this one's), with the files,
// which are from the time at which worlds begin.
std::string make_folder(const std::filesystem::path& folder,
                        const scenarios::HostPrograms& programs, const HostPlaces& places);

// Returns the first placeholder that there is none of.
std::optional<std::string> unknown_placeholder(const std::string& text);
// Looks in all texts of the programs.
std::optional<std::string> unknown_placeholder(const scenarios::HostPrograms& programs);

}  // namespace simbench::processes

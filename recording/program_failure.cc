#include "recording/program_failure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

namespace simbench {
namespace {

// "chronyd: exited with status 1: No such file".
std::string end_text(const ProgramFailure& failure) {
  return fmt::format("{}: {}{}{}", failure.program, failure.how,
                     failure.last_words.empty() ? "" : ": ", failure.last_words);
}

}  // namespace

std::string run_time_text(Nanoseconds at) {
  constexpr std::int64_t kMicrosecondNs = 1000;
  return fmt::format("{}.{:06} s", at.count() / kSecondNs, at.count() % kSecondNs / kMicrosecondNs);
}

std::string failure_text(const ProgramFailure& failure) {
  return fmt::format("host {}, at {}: {}", failure.host, run_time_text(failure.at),
                     end_text(failure));
}

std::vector<std::string> failure_lines(std::span<const ProgramFailure> failures) {
  struct Alike {
    std::string text;
    std::set<PeerId> hosts;
    Nanoseconds first;
  };
  std::vector<Alike> all;
  for (const ProgramFailure& failure : failures) {
    std::string text = end_text(failure);
    const auto known = std::ranges::find(all, text, &Alike::text);
    if (known == all.end()) {
      all.push_back({.text = std::move(text), .hosts = {failure.host}, .first = failure.at});
    } else {
      known->hosts.insert(failure.host);
      known->first = std::min(known->first, failure.at);
    }
  }
  std::vector<std::string> lines;
  lines.reserve(all.size());
  for (const auto& [text, hosts, first] : all) {
    lines.push_back(fmt::format("{} {}, {} {}: {}", hosts.size() == 1 ? "host" : "hosts",
                                fmt::join(hosts, ", "), hosts.size() == 1 ? "at" : "first at",
                                run_time_text(first), text));
  }
  return lines;
}

}  // namespace simbench

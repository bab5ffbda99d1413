// Reads what a node replied. Errors: ProtocolError.
#ifndef SIMBENCH_HARDWARE_CONDUCTOR_REPLY_H_
#define SIMBENCH_HARDWARE_CONDUCTOR_REPLY_H_

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hardware/node/protocol.h"

namespace simbench::hardware {

// A node may be of another version: a member that its reply lacks is an error of that host.
template <class T>
T reply_member(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) throw ProtocolError(fmt::format("its reply has no '{}'", key));
  try {
    return found->get<T>();
  } catch (const nlohmann::json::exception&) {
    throw ProtocolError(fmt::format("its reply's '{}' has another type", key));
  }
}

// The problems of a reply on one line: "camera 018322071234: unplugged; ...".
inline std::string problems_in(const nlohmann::json& reply) {
  std::vector<std::string> lines;
  for (const nlohmann::json& problem : reply_member<nlohmann::json>(reply, "problems")) {
    lines.push_back(fmt::format("camera {}: {}", reply_member<std::string>(problem, "camera"),
                                reply_member<std::string>(problem, "text")));
  }
  return fmt::format("{}", fmt::join(lines, "; "));
}

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_CONDUCTOR_REPLY_H_

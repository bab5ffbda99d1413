// Reading what a program asked for and writing what it is told. Programs are not trusted: whatever
// is no request throws BadRequest, which ends the program.
//
//   const Bytes data = bytes_of(shim::TimerSetting{.left = 1'000, .interval = 0});
//   const auto wanted = read_head<shim::TimerSetting>(data);
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <stdexcept>

#include "algorithms/ports/host.h"

namespace simbench::processes {

// How many sockets, timers and the like a program may have open.
inline constexpr std::size_t kMostOpen = 1024;

class BadRequest : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <class T>
Bytes bytes_of(const T& value) {
  const auto bytes = std::as_bytes(std::span(&value, 1));
  return {bytes.begin(), bytes.end()};
}

template <class T>
T read_head(const Bytes& data) {
  if (data.size() < sizeof(T)) throw BadRequest("too little data");
  T value{};
  std::memcpy(&value, data.data(), sizeof value);
  return value;
}

}  // namespace simbench::processes

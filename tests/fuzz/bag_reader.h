// What the fuzzers of bag readers ask of each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "bags/bag.h"

namespace simbench::bags {

class CheckingSink final : public BagSink {
 public:
  std::size_t on_topic(std::uint32_t number, const BagTopic& /*topic*/) override {
    if (number != topics_++) std::abort();
    return kHead;
  }
  void on_message(const BagMessage& message) override {
    if (message.topic >= topics_ || message.head.size() > kHead) std::abort();
    if (message.head.size() > message.size) std::abort();
  }

 private:
  static constexpr std::size_t kHead = 64;
  std::uint32_t topics_ = 0;
};

// The file is refused with a BagError, or read within its bounds.
template <class Reader>
void check_reader(const Reader& read, const std::string& path) {
  CheckingSink sink;
  try {
    read(path, sink, ReadProgress());
  } catch (const BagError&) {
  }
}

}  // namespace simbench::bags

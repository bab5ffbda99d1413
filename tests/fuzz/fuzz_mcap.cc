// The reader of MCAP: any bytes are either refused with a BagError or read within the file's
// bounds.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "bags/bag.h"

namespace {

using simbench::bags::BagMessage;
using simbench::bags::BagTopic;

class Checker final : public simbench::bags::BagSink {
 public:
  std::size_t on_topic(std::uint32_t number, const BagTopic& /*topic*/) override {
    if (number != topics_++) std::abort();
    return 64;
  }
  void on_message(const BagMessage& message) override {
    if (message.topic >= topics_ || message.head.size() > 64) std::abort();
    if (message.head.size() > message.size) std::abort();
  }

 private:
  std::uint32_t topics_ = 0;
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path = [] {
    std::string name = (std::filesystem::temp_directory_path() / "fuzz_mcap_XXXXXX").string();
    if (mkstemp(name.data()) < 0) std::abort();
    return name;
  }();
  std::filesystem::remove(path);  // replacing a file is slow where that flushes it
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  Checker sink;
  try {
    const auto facts = simbench::bags::read_mcap(path, sink, {});
    if (facts.messages > 0 && size < 31) std::abort();
  } catch (const simbench::bags::BagError&) {
  }
  return 0;
}

// What it costs to read a bag: a million small messages, and messages of 1 MB, beside a plain
// read() of the same file in the same run.
//
//   bags_benchmark [GIGABYTES]     (of large messages, each format; default 2; files go to /tmp)
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <random>
#include <string>

#include "bags/bag.h"
#include "scenarios/input_file.h"
#include "tests/bags/bag_writers.h"
#include "tests/scratch_folder.h"

namespace simbench::bags {
namespace {

constexpr std::uint64_t kSmall = 1'000'000;
constexpr std::size_t kLargeBytes = 1'000'000;

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

class Counter final : public BagSink {
 public:
  std::size_t on_topic(std::uint32_t, const BagTopic&) override { return 256; }
  void on_message(const BagMessage& message) override { bytes += message.head.size(); }
  std::uint64_t bytes = 0;
};

void plain_read(const std::string& path) {
  InputFile file(path);
  std::string buffer(std::size_t{1} << 20, '\0');
  while (file.read(buffer.data(), buffer.size()) > 0) {
  }
}

void measure(const std::string& name, const std::string& path) {
  Counter counter;
  BagFacts facts;
  const double plain_s = seconds_of([&] { plain_read(path); });
  const double bag_s = seconds_of([&] { facts = read_bag(path, counter); });
  const double gigabytes = static_cast<double>(InputFile(path).size()) * 1e-9;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print(
      "{:28} {:8} messages {:7.3f} s {:8.0f} ns/message {:7.2f} GB/s ({:.2f} read()) {} lost"
      " peak {} MB\n",
      name, facts.messages, bag_s, bag_s * 1e9 / static_cast<double>(facts.messages),
      gigabytes / bag_s, gigabytes / plain_s, facts.lost_bytes, usage.ru_maxrss / 1024);
}

void write_mcap(const std::string& path, McapOptions options, std::uint64_t count,
                const std::string& data) {
  std::ofstream out(path, std::ios::binary);
  McapWriter mcap(std::move(options));
  const std::uint16_t id = mcap.channel("/left", "sensor_msgs/msg/Image", "cdr");
  for (std::uint64_t i = 0; i < count; ++i) {
    mcap.message(id, i, data);
    out << mcap.take_finished();
  }
  out << mcap.close();
}

void write_sqlite(const std::string& path, std::uint64_t count, const std::string& data) {
  SqliteBagWriter writer(path);
  const std::int64_t id = writer.topic("/left", "sensor_msgs/msg/Image");
  for (std::uint64_t i = 0; i < count; ++i) {
    writer.message(id, static_cast<std::int64_t>(i), data);
  }
  writer.close();
}

void run_size(const std::string& size, std::uint64_t count, const std::string& data) {
  for (const char* compression : {"", "lz4", "zstd"}) {
    const ScratchFolder folder;
    write_mcap(folder / "bag", {.compression = compression, .chunk_bytes = std::size_t{4} << 20},
               count, data);
    measure(fmt::format("{}, MCAP {}", size, *compression == 0 ? "uncompressed" : compression),
            folder / "bag");
  }
  {
    const ScratchFolder folder;
    write_mcap(folder / "bag", {}, count, data);
    measure(size + ", MCAP without chunks", folder / "bag");
  }
  const ScratchFolder folder;
  write_sqlite(folder / "bag", count, data);
  measure(size + ", SQLite", folder / "bag");
}

// Half of an image's bytes are noise.
std::string image_bytes() {
  std::mt19937 random(1);
  std::string bytes = cdr_header(1, 2, "left");
  while (bytes.size() < kLargeBytes) {
    bytes += static_cast<char>(random());
    if (bytes.size() % 128 == 0) bytes.append(128, '\x10');
  }
  return bytes;
}

}  // namespace
}  // namespace simbench::bags

int main(int argc, char** argv) {
  const double gigabytes = argc > 1 ? std::atof(argv[1]) : 2;
  simbench::bags::run_size("small", simbench::bags::kSmall,
                           simbench::bags::cdr_header(1, 2, "left") + std::string(60, 'x'));
  simbench::bags::run_size("1 MB", static_cast<std::uint64_t>(gigabytes * 1e9 / 1e6),
                           simbench::bags::image_bytes());
}

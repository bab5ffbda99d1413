// What the arrivals of a topic's messages say: how many, since when, how regular; whatever their
// order in the file.
//
// A recorder writes messages in order, other programs need not (chunks that were swapped, files
// that were joined). Log times decide: a message is out of order if one before it in the file has a
// later log time, and a copy if another has the same log time, header.seq, size and first bytes.
// Where all log times of a topic are the same, nothing is taken for a copy.
//
//   TopicArrivals arrivals;
//   arrivals.add(message);                // each, in order of the file
//   arrivals.conclude(scan);              // first, last and gaps, by log time
//   if (arrivals.is_copy(3)) ...          // the fourth message of the file
//
// Complexity: linear for messages in order, else n log n; 16 bytes a message until conclude(), and
// 24 more in it for a topic that is out of order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bags/bag.h"

namespace simbench::bags {

struct TopicScan {
  BagTopic topic{};
  std::uint64_t messages = 0;  // without copies
  std::uint64_t bytes = 0;
  // By log time.
  Nanoseconds first{};
  Nanoseconds last{};
  Nanoseconds longest_gap{};
  Nanoseconds gap_at{};  // its begin
  std::uint64_t out_of_order = 0;
  std::uint64_t copies = 0;
  // Numbers of ROS 1's header.seq that no message has, between those of messages: published, and
  // not recorded.
  std::uint64_t missing_numbers = 0;
  bool is_camera = false;

  // Mean, by the log times; 0 with fewer than two messages.
  double rate_hz() const;
  // Adds the topic of another file of the recording. It is exact where the files do not overlap in
  // time; else the longest gap is that within a file.
  void append(const TopicScan& next);
};

class TopicArrivals {
 public:
  // As much of a message's head is compared.
  static constexpr std::size_t kCompared = 128;

  void add(const BagMessage& message);
  // header.seq of the message that was added last.
  void set_sequence(std::uint32_t sequence);
  std::uint64_t size() const { return entries_.size(); }
  // Once, after the last message. Sets all of `scan` but its topic, bytes and camera.
  void conclude(TopicScan& scan);
  // After conclude(); the number is the message's place in the file, from 0.
  bool is_copy(std::uint64_t message) const {
    return message < is_copy_.size() && is_copy_[static_cast<std::size_t>(message)];
  }

 private:
  struct Entry {
    std::int64_t log_ns = 0;
    std::uint32_t sequence = 0;
    std::uint32_t content = 0;  // a hash
  };

  void sort();
  void measure(TopicScan& scan) const;

  std::vector<Entry> entries_{};
  std::vector<bool> is_copy_{};  // empty: none is
  std::int64_t latest_ns_ = 0;
  std::uint64_t out_of_order_ = 0;
  std::uint64_t copies_ = 0;
  bool rises_ = true;  // each log time is later than the one before
};

}  // namespace simbench::bags

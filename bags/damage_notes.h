// What a reader of bags has to say about damage: a line each, and no more lines than a user reads.
//
//   DamageNotes notes("rig.bag");
//   notes.add(4096, "the chunk does not inflate");   // "rig.bag: at byte 4096: the chunk ..."
//   facts.notes = notes.take();
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace simbench::bags {

class DamageNotes {
 public:
  explicit DamageNotes(std::string path) : path_(std::move(path)) {}

  void add(std::uint64_t position, const std::string& text) {
    add("at byte " + std::to_string(position) + ": " + text);
  }
  void add(const std::string& text) {
    if (lines_.size() < kMostLines) {
      lines_.push_back(path_ + ": " + text);
    } else {
      ++more_;
    }
  }
  std::vector<std::string> take() {
    if (more_ > 0) lines_.push_back(path_ + ": " + std::to_string(more_) + " more like these");
    return std::move(lines_);
  }

 private:
  static constexpr std::size_t kMostLines = 20;

  std::string path_;
  std::vector<std::string> lines_{};
  std::uint64_t more_ = 0;
};

}  // namespace simbench::bags

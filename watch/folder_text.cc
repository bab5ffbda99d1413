#include "watch/folder_text.h"

#include <filesystem>
#include <system_error>
#include <utility>

namespace simbench::watch {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFrames = "frames.csv";

}  // namespace

FolderText::FolderText(std::string folder) : folder_(std::move(folder)) {}

RecordingColumns FolderText::columns() {
  return RecordingColumns::parse(
      "sensor=sensor_us:us,arrival=arrival_ns:ns,counter=counter,camera=camera,stream=stream,"
      "exposure=exposure_us:us");
}

std::string FolderText::next_capture() {
  std::string newest;
  fs::file_time_type newest_time{};
  std::error_code failed;
  for (fs::recursive_directory_iterator at(folder_, failed), end; !failed && at != end;
       at.increment(failed)) {
    if (at.depth() > 2) at.disable_recursion_pending();
    if (at->path().filename() != kFrames || known_.contains(at->path().string())) continue;
    const fs::file_time_type time = at->last_write_time(failed);
    if (failed || (!newest.empty() && time < newest_time)) continue;
    newest = at->path().string();
    newest_time = time;
  }
  return newest;
}

GrownText FolderText::poll() {
  GrownText grown{.is_there = false};
  bool is_next = false;
  if (tail_) grown = tail_->poll();
  if (grown.text.empty()) {
    const std::string next = next_capture();
    if (!next.empty()) {
      is_next = tail_ != nullptr;
      known_.insert(next);
      tail_ = std::make_unique<Tail>(next);
      grown = tail_->poll();
    }
  }
  grown.begins_anew = grown.begins_anew || is_next;
  std::error_code failed;
  grown.is_there = grown.is_there || fs::is_directory(folder_, failed);
  return grown;
}

std::string FolderText::head(std::size_t most) const { return tail_ ? tail_->head(most) : ""; }

}  // namespace simbench::watch

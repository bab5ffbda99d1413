// The frames of a recording folder that is being written (recording/recording_folder.h): those of
// the capture that is under way, and of each that follows it.
//
// A recorder of simbench writes a capture's frames through ten times a second. `watch` of such a
// folder is therefore `watch` of a rig whose conductor records.
//
//   FolderText frames("monday");
//   use(frames.poll().text);            // lines of .../frames.csv, with its heading
#pragma once

#include <memory>
#include <set>
#include <string>

#include "recording/recording_columns.h"
#include "watch/tail.h"

namespace simbench::watch {

class FolderText final : public GrowingText {
 public:
  explicit FolderText(std::string folder);

  const std::string& path() const override { return folder_; }
  GrownText poll() override;
  std::string head(std::size_t most) const override;

  // What its columns are: stamps of the camera, arrivals on the host's system clock.
  static RecordingColumns columns();

 private:
  // The newest capture that was not read yet; "": there is none.
  std::string next_capture();

  std::string folder_;
  std::set<std::string> known_;  // captures
  std::unique_ptr<Tail> tail_;
};

}  // namespace simbench::watch

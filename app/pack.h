// A recording without images and names, to give to somebody else.
//
// It keeps what says how a rig is synchronised: the stamps, counters, exposures, sizes and
// temperatures of all frames, and the clock logs as tables of time and error. Cameras and hosts
// are called camera0 and host0 and so on. Paths, serial numbers, topics, addresses and lines of
// logs are not in it. The stamps are as they were, with the time of the recording where they count
// from 1970. `simbench diagnose` says the same of it, under the new names.
//
//   const Pack packed = pack_streams(recorded_streams({"front.bag"}), {}, "for_you");
//   for (const std::string& note : packed.notes) print(note);   // "camera0 is front"
//
// A recording folder becomes one of the same captures (recording/recording_folder.h).
//
// Errors: scenarios::InputError for a folder that is there and not empty; those of OutputFolder and
// RecordingFolderError. Complexity: linear.
#pragma once

#include <string>
#include <vector>

#include "evaluation/diagnosis/logged_clock.h"
#include "recording/recorded_streams.h"

namespace simbench::app {

struct Pack {
  std::vector<std::string> notes{};  // who is called what, and what was left out; not in the pack
};

Pack pack_streams(const RecordedStreams& rig, const std::vector<evaluation::HostLog>& logs,
                  const std::string& folder);
Pack pack_recording(const std::string& recording, const std::string& folder);

}  // namespace simbench::app

// What people have of a rig, as streams of stamps: a recording folder, or files of real cameras.
//
//   const RecordedStreams rig = recorded_streams({"front.bag", "back.csv"});
//   const evaluation::Diagnosis diagnosis = evaluation::diagnose(rig.streams, {});
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bags/recorded_files.h"
#include "recording/recorded_streams.h"

namespace simbench::app {

// `inputs`: one recording folder, whose first capture it is, or files as bags/recorded_files.h
// reads them (folders of rosbag2 too), IBL's (app/ibl_recording.h), and folders of lists of stamps
// (recording/dataset_folder.h). The notes are for the user. Throws scenarios::InputError (a folder
// among several inputs or without a capture), RecordingFolderError, RecordedFileError.
RecordedStreams recorded_streams(const std::vector<std::string>& inputs,
                                 const bags::FileOptions& options = {},
                                 const ReadProgress& progress = {});

// The recording folder among the inputs; nothing if they are files. Throws scenarios::InputError if
// there are other inputs beside it.
std::optional<std::string> recording_folder_of(const std::vector<std::string>& inputs);

}  // namespace simbench::app

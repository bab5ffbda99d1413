// What people have of a rig, as streams of stamps: a recording folder, or CSV files.
//
//   const RecordedStreams rig = recorded_streams({"front.csv", "back.csv"});
//   const evaluation::Diagnosis diagnosis = evaluation::diagnose(rig.streams, {});
#ifndef SIMBENCH_APP_RECORDED_STREAMS_H_
#define SIMBENCH_APP_RECORDED_STREAMS_H_

#include <string>
#include <vector>

#include "recording/rs_csv.h"

namespace simbench::app {

// `inputs`: one recording folder, whose first capture it is, or files as recording/rs_csv.h reads
// them. The notes are for the user. Throws scenarios::InputError (a folder among several inputs or
// without a capture), RecordingFolderError, CsvError.
RecordedStreams recorded_streams(const std::vector<std::string>& inputs);

}  // namespace simbench::app

#endif  // SIMBENCH_APP_RECORDED_STREAMS_H_

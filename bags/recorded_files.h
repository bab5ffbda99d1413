// Files of real cameras, by their content and not by their name: bags (bags/bag.h), folders of
// rosbag2, videos (bags/video_times.h), and CSV (recording/rs_csv.h).
//
// Several files are one rig. A file is one host, whose recorder stamped all its arrivals, unless a
// CSV names hosts. A camera of a bag with one camera has the file's name; a bag with several names
// them by their topics, and where two files have the same names, these begin with the file's. The
// files of a rosbag2 folder are one recording, of which each goes on where the last one ended.
//
//   const RecordedStreams rig = bags::read_recorded_files({"front.bag", "back.mcap"}, {});
//
// Errors: BagError, CsvError; each names the file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bags/bag_scan.h"
#include "recording/recorded_streams.h"
#include "recording/rs_csv.h"

namespace simbench::bags {

struct FileOptions {
  std::vector<std::string> topics{};          // of bags; empty: those that look like a camera's
  std::optional<RecordingColumns> columns{};  // of CSV files; nothing: those of rs-data-collect
};

// Whether it is a bag, or a folder of rosbag2. Throws BagError if it cannot be read.
bool is_bag(const std::string& path);

// The size of a file, or of all bags of a folder; what cannot be read has none.
std::uint64_t recording_bytes(const std::string& path);

// Cameras of different files with one name get that of their file before it. A name for each file.
void tell_apart(const std::vector<RecordedStreams*>& recordings,
                const std::vector<std::string>& names);

// A bag file, or all those of a rosbag2 folder, as scan_bag() has one.
BagScan scan_recording(const std::string& path, const std::string& name, const ScanOptions& options,
                       const ReadProgress& progress = {});

RecordedStreams read_recorded_files(const std::vector<std::string>& files,
                                    const FileOptions& options, const ReadProgress& progress = {});

}  // namespace simbench::bags

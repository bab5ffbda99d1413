// When the frames of a video were exposed, by its container: Matroska (also Azure Kinect's), MP4,
// QuickTime, AVI. ffprobe (of FFmpeg) reads it: no picture is decoded.
//
// Each track is a stream, of the track's title if it has one ("COLOR" of an Azure Kinect). Stamps
// are as fine as the container's time base, which StreamOrigin::stamps says. A container has no
// arrivals: the stamps stand for them. Frames are in order of their stamps (a codec may store them
// in another), and are not counted.
//
//   if (is_video("output.mkv")) streams = read_video("output.mkv", "kinect").streams;
//
// Errors: BagError: no ffprobe on PATH, what it says of the file, or no track with frames.
// Complexity: linear in the packets, as many as a file of its size may have (bags/read_budget.h).
#pragma once

#include <string>

#include "recording/recorded_streams.h"

namespace simbench::bags {

// By its first bytes. Throws FileError.
bool is_video(const std::string& path);

RecordedStreams read_video(const std::string& path, const std::string& camera,
                           const ReadProgress& progress = {});

}  // namespace simbench::bags

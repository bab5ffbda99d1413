// The streams that the tracks of a bag are: a camera's topics have the stamps of the same frames,
// and only the best of them speaks; publishers that take turns are one.
//
//   make_streams(tracks, {.path = "rig.bag", .name = "rig"}, scan);   // adds streams and notes
//
// Complexity: n log n in the number of tracks.
#pragma once

#include <string>
#include <vector>

#include "bags/bag_scan.h"
#include "bags/frame_track.h"

namespace simbench::bags {

struct StreamNames {
  std::string path{};       // of the file, for notes
  std::string name{};       // of the host, and of the only camera
  bool all_chosen = false;  // a user named the topics: none is left out for another
};

// Frames of each track are in order of their log times. `scan` has the topics; tracks are used up.
void make_streams(std::vector<FrameTrack>& tracks, const StreamNames& names, BagScan& scan);

}  // namespace simbench::bags

// Folders of text in which recordings of cameras are published: each camera has a list of stamps.
//
//   EuRoC, ASL    mav0/cam0/data.csv, mav0/cam1/data.csv; also given mav0 itself
//   KITTI (raw)   image_00/timestamps.txt, ..., velodyne_points/timestamps.txt
//   TUM           rgb.txt, depth.txt
//   any other     its *.csv, plain or compressed (.gz, .zst, .bz2, .lz4)
//
// The first that is there counts; what else a folder holds (inertial data, ground truth) are no
// frames of a camera. A recording or a result of simbench, a folder of
// rosbag2 and one with bags in it are none of these: what it holds besides is not left out in
// silence.
//
//   for (const std::string& file : dataset_files("MH_01_easy")) ...   // by name, each a camera
//
// Complexity: linear in the entries of the folder. Sources: projects.asl.ethz.ch/datasets (format),
// cvlibs.net/datasets/kitti (devkit of the raw data), cvg.cit.tum.de/data/datasets/rgbd-dataset.
#pragma once

#include <string>
#include <vector>

namespace simbench {

// Empty for what is no such folder, or cannot be read.
std::vector<std::string> dataset_files(const std::string& folder);

// Inputs with the files of such folders in their place.
std::vector<std::string> with_dataset_files(const std::vector<std::string>& inputs);

}  // namespace simbench

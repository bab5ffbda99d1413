// manifest.json of a recording folder, and the places of its other files.
//
// Whatever the bytes of a manifest are, parsing returns numbers within bounds (cameras on hosts
// that exist, a frame rate, sizes that a rig can have) or throws RecordingFolderError, "FILE:
// /json/pointer: found ..., allowed ...".
//
//   const RecordingManifest manifest = parse_manifest(text, "monday/manifest.json");
//   write_manifest(manifest, "monday");
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "recording/recording_folder.h"

namespace simbench {

inline constexpr const char* kRecordingFormat = "simbench recording";
inline constexpr int kRecordingFormatVersion = 1;
inline constexpr std::uint32_t kMostHosts = 1'000'000;
inline constexpr std::size_t kMostCameras = 1'000'000;

struct RecordingManifest {
  RecordingDescription description;
  std::vector<RecordedCapture> captures;  // each pipeline and seed once
};

std::string manifest_text(const RecordingManifest& manifest);
// `path` is for messages.
RecordingManifest parse_manifest(const std::string& text, const std::string& path);

// Replaces the file as a whole.
void write_manifest(const RecordingManifest& manifest, const std::string& folder);
RecordingManifest read_manifest(const std::string& folder);

// The folder of a capture's two files.
std::string capture_folder(const std::string& folder, const std::string& pipeline,
                           std::uint64_t seed);
inline constexpr const char* kFramesFile = "/frames.csv";
inline constexpr const char* kEventsFile = "/events.csv";

}  // namespace simbench

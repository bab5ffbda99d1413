// manifest.json of a recording folder, the places of its other files, and how files are written.
//
// Whatever the bytes of a manifest are, parsing returns numbers within bounds (cameras on hosts
// that exist, a frame rate, sizes that a rig can have) or throws RecordingFolderError, "FILE:
// /json/pointer: found ..., allowed ...".
//
//   const RecordingManifest manifest = parse_manifest(text, "monday/manifest.json");
//   write_manifest(manifest, "monday");
#ifndef SIMBENCH_RECORDING_RECORDING_MANIFEST_H_
#define SIMBENCH_RECORDING_RECORDING_MANIFEST_H_

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

// A file of the folder that is only written to at its end, through a buffer, straight to the
// kernel: what flush() has written outlives the process. Otherwise it flushes only at destruction,
// where errors are dropped.
//
// Errors: RecordingFolderError with the file and the reason (a full disk). After one, the file
// takes nothing more: a line that was cut stays the last.
//
//   AppendFile file("DIR/frames.csv");   // must not be there yet
//   file.buffer() += "a line\n";
//   file.flush();
class AppendFile {
 public:
  explicit AppendFile(std::string path);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  std::string& buffer() { return buffer_; }
  void flush();
  // Flushes, and reports what only closing reveals.
  void close();

 private:
  [[noreturn]] void fail(int reason);

  std::string path_;
  std::string buffer_;
  int file_ = -1;
  bool failed_ = false;
};

}  // namespace simbench

#endif  // SIMBENCH_RECORDING_RECORDING_MANIFEST_H_

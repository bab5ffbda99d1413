// Files and folders of results that appear complete or not at all.
//
// They are written under a temporary name beside their own; publish() renames. Without publish()
// nothing is left, and an earlier result in that place stays; what a killed process has left is
// removed by the next one that writes there. Ctrl-C and SIGTERM leave nothing: while one of them is
// not published, they wait on its thread, unless the program handles them (app/interrupt.h), and a
// program that ends in haste disposes of it (recording/disposable.h). A link stays one: its target
// is replaced. An OutputFolder replaces only an earlier result of simbench: it refuses a folder
// with anything else in it.
//
//   OutputFile file("fig8.csv");              // before the work: refuses what cannot be written
//   file.write(text);
//   file.publish();
//
//   OutputFolder output("results/monday");
//   output.file("table.txt") << text;
//   output.publish();
//
// Errors: OutputError, whose message states the remedy.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "recording/disposable.h"

namespace simbench::reports {

class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// SIGINT and SIGTERM wait for the end of all of these of a thread.
class HeldInterrupt {
 public:
  HeldInterrupt();
  ~HeldInterrupt();
  HeldInterrupt(const HeldInterrupt&) = delete;
  HeldInterrupt& operator=(const HeldInterrupt&) = delete;
};

// Why an existing file is not replaced, whoever asks for it: "is a rosbag 2.0 bag". It is a
// recording or other data that no run makes again (recording/file_kind.h), or a part of a folder of
// results. Nothing for what may be replaced, and where there is no file.
std::optional<std::string> irreplaceable(const std::filesystem::path& path);

class OutputFile {
 public:
  // Checks that `path` may be written and makes the temporary file.
  explicit OutputFile(const std::string& path);

  // The temporary name, for other programs that write the file. Until publish().
  const std::filesystem::path& path() const { return temporary_.path(); }
  void write(std::string_view content) const;
  // Once, at the end.
  void publish();

 private:
  HeldInterrupt held_;  // first: lives longest
  std::string named_;   // as the user stated it
  std::filesystem::path path_;
  Disposable temporary_;
};

// Makes, writes and publishes a file.
void write_file(const std::string& path, std::string_view content);

// The whole content of a file of results. Nothing if there is no such file; errno has the reason.
// Throws scenarios::InputError for a file that cannot be read, and for one of more than 512 MiB.
std::optional<std::string> content_of(const std::filesystem::path& path);

// Returns the system's reason for the last failed call.
std::string system_reason();

// The file that every folder of results has.
inline constexpr const char* kManifest = "manifest.json";

[[noreturn]] void fail_output(const std::filesystem::path& folder, const std::string& problem);

class OutputFolder {
 public:
  // Checks that `folder` may be written and makes the temporary one. `more_own_files`: files that
  // an earlier result there may hold besides those of an archive.
  explicit OutputFolder(const std::filesystem::path& folder,
                        const std::vector<std::string>& more_own_files = {});

  // Finishes the preceding file and starts the next: at most one is open. A name such as
  // "45fps/results.json" makes that folder in it, which is one of `more_own_files`.
  std::ostream& file(const std::string& name);
  // Finishes the last file and gives the folder its name.
  void publish();

 private:
  void finish_file();

  HeldInterrupt held_;  // first: lives longest
  std::filesystem::path folder_;
  std::optional<Disposable> temporary_;  // until publish()
  std::filesystem::path open_name_;
  std::ofstream open_;
};

}  // namespace simbench::reports

// A file that appears whole or not at all.
//
// It is written below a temporary name beside its own; publish() renames. Nothing is left if that
// is not reached, and an earlier file of the name stays until then.
//
//   FileOutput file("fig8.csv");
//   file.write(text);
//   file.publish();
//
// Errors: OutputError.
#ifndef SIMBENCH_REPORTS_FIGURES_FILE_OUTPUT_H_
#define SIMBENCH_REPORTS_FIGURES_FILE_OUTPUT_H_

#include <filesystem>
#include <string>

namespace simbench::reports {

class FileOutput {
 public:
  explicit FileOutput(std::filesystem::path file);
  ~FileOutput();
  FileOutput(const FileOutput&) = delete;
  FileOutput& operator=(const FileOutput&) = delete;

  // The temporary name, for those who write by other means.
  const std::filesystem::path& path() const { return temporary_; }
  void write(const std::string& content) const;
  void publish() const;

 private:
  std::filesystem::path file_;
  std::filesystem::path temporary_;
};

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_FIGURES_FILE_OUTPUT_H_

// A report's file, which appears whole or not at all.
//
//   HtmlFile file("monday.html");     // before the work: refuses what cannot be written
//   file.write(html_report(input));   // under a temporary name beside it, then renamed
//
// An earlier file in that place stays until then, and is replaced. Nothing is left if write() is
// not reached or fails. Errors: OutputError, whose message says what to do.
#ifndef SIMBENCH_REPORTS_HTML_FILE_H_
#define SIMBENCH_REPORTS_HTML_FILE_H_

#include <filesystem>
#include <string>
#include <string_view>

namespace simbench::reports {

class HtmlFile {
 public:
  // Checks that `path` may be written and makes the temporary file.
  explicit HtmlFile(const std::string& path);
  ~HtmlFile();
  HtmlFile(const HtmlFile&) = delete;
  HtmlFile& operator=(const HtmlFile&) = delete;

  void write(std::string_view html);

 private:
  std::string named_;  // as the user did
  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_HTML_FILE_H_

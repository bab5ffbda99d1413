// Columns of numbers in little room; reports/page/html_figures.h describes the forms.
#ifndef SIMBENCH_REPORTS_PAGE_HTML_COLUMNS_H_
#define SIMBENCH_REPORTS_PAGE_HTML_COLUMNS_H_

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace simbench::reports {

// RFC 4648, with padding.
std::string base64(const std::string& bytes);

// Columns in the order in which they were first asked for, equal ones once.
class HtmlColumns {
 public:
  // The number of the column. `relative`: every value to its own size, not to the range of all.
  std::size_t add(const std::vector<double>& values, bool relative);
  const nlohmann::ordered_json& json() const { return columns_; }

 private:
  nlohmann::ordered_json columns_ = nlohmann::ordered_json::array();
  std::map<std::string, std::size_t> known_;  // by their text
};

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_PAGE_HTML_COLUMNS_H_

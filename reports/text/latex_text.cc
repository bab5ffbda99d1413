#include "reports/text/latex_text.h"

#include <utility>

namespace simbench::reports {
namespace {

// What stands for the beginning of a text; characters of several bytes are texts.
constexpr std::pair<std::string_view, std::string_view> kSpecial[] = {{"\\", "\\textbackslash{}"},
                                                                      {"~", "\\textasciitilde{}"},
                                                                      {"^", "\\textasciicircum{}"},
                                                                      {"<", "\\textless{}"},
                                                                      {">", "\\textgreater{}"},
                                                                      {"|", "\\textbar{}"},
                                                                      {"\"", "\\textquotedbl{}"},
                                                                      {"`", "\\textasciigrave{}"},
                                                                      {"→", "$\\rightarrow$"},
                                                                      {"±", "$\\pm$"},
                                                                      {"{", "\\{"},
                                                                      {"}", "\\}"},
                                                                      {"$", "\\$"},
                                                                      {"&", "\\&"},
                                                                      {"#", "\\#"},
                                                                      {"%", "\\%"},
                                                                      {"_", "\\_"}};

const std::pair<std::string_view, std::string_view>* special_at(std::string_view text) {
  for (const auto& special : kSpecial) {
    if (text.starts_with(special.first)) return &special;
  }
  return nullptr;
}

}  // namespace

std::string latex_escaped(std::string_view text) {
  std::string escaped;
  while (!text.empty()) {
    if (const auto* special = special_at(text)) {
      escaped += special->second;
      text.remove_prefix(special->first.size());
    } else {
      escaped += text.front();
      text.remove_prefix(1);
    }
  }
  return escaped;
}

}  // namespace simbench::reports

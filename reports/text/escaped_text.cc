#include "reports/text/escaped_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "algorithms/ports/assert.h"
#include "recording/text_fields.h"

namespace simbench::reports {
namespace {

// What stands for the beginning of a text; characters of several bytes are texts.
constexpr std::pair<std::string_view, std::string_view> kSpecial[] = {{"\\", "\\textbackslash{}"},
                                                                      {"~", "\\textasciitilde{}"},
                                                                      {"^", "\\textasciicircum{}"},
                                                                      {"<", "\\textless{}"},
                                                                      {">", "\\textgreater{}"},
                                                                      {"|", "\\textbar{}"},
                                                                      {"\"", "\\texttt{\\char34}"},
                                                                      {"`", "\\textasciigrave{}"},
                                                                      {"→", "$\\rightarrow$"},
                                                                      {"±", "$\\pm$"},
                                                                      {"×", "$\\times$"},
                                                                      {"−", "$-$"},
                                                                      {"≤", "$\\leq$"},
                                                                      {"≥", "$\\geq$"},
                                                                      {"≈", "$\\approx$"},
                                                                      {"∞", "$\\infty$"},
                                                                      {"µ", "$\\mu$"},
                                                                      {"²", "$^2$"},
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

std::string html_escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : printable_lines(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

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

std::string script_safe(std::string_view json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : printable_json(json)) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

std::string filled(std::string_view page,
                   const std::vector<std::pair<std::string_view, std::string>>& values) {
  std::string out;
  while (true) {
    const std::size_t open = page.find("{{");
    out += page.substr(0, open);
    if (open == std::string_view::npos) return out;
    const std::size_t close = page.find("}}", open);
    SIMBENCH_ASSERT(close != std::string_view::npos, "an open {{");
    const std::string_view name = page.substr(open + 2, close - open - 2);
    const auto value = std::find_if(values.begin(), values.end(),
                                    [&](const auto& known) { return known.first == name; });
    SIMBENCH_ASSERT(value != values.end(), "a name of the page without a value");
    out += value->second;
    page.remove_prefix(close + 2);
  }
}

}  // namespace simbench::reports

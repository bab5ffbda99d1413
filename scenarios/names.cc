#include <algorithm>
#include <cctype>
#include <utility>

#include "scenarios/loader.h"

namespace simbench::scenarios {
namespace {

// Insertions, deletions, replacements and swaps of neighbours; upper and lower case count as equal.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  const auto equal = [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  };
  // distance[i][j]: between the first i characters of a and the first j of b.
  std::vector<std::vector<std::size_t>> distance(a.size() + 1,
                                                 std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      std::size_t& here = distance[i][j];
      if (i == 0 || j == 0) {
        here = i + j;
        continue;
      }
      here = std::min({distance[i - 1][j] + 1, distance[i][j - 1] + 1,
                       distance[i - 1][j - 1] + (equal(a[i - 1], b[j - 1]) ? 0 : 1)});
      if (i > 1 && j > 1 && equal(a[i - 1], b[j - 2]) && equal(a[i - 2], b[j - 1])) {
        here = std::min(here, distance[i - 2][j - 2] + 1);
      }
    }
  }
  return distance[a.size()][b.size()];
}

}  // namespace

std::vector<std::string> nearest(const std::string& name, const std::vector<std::string>& known) {
  constexpr std::size_t kMost = 3;
  constexpr std::size_t kLongestName = 200;
  if (name.empty() || name.size() > kLongestName) return {};
  std::vector<std::pair<std::size_t, std::string>> found;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(name, candidate);
    // A name is similar if a third of it is wrong at most, or if it is a part of the candidate.
    const bool is_part = name.size() >= 3 && candidate.find(name) != std::string::npos;
    if (is_part || distance <= std::max<std::size_t>(1, candidate.size() / 3)) {
      found.emplace_back(distance, candidate);
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> names;
  for (const auto& [distance, candidate] : found) {
    if (names.size() == kMost || distance > 2 * found.front().first) break;
    names.push_back(candidate);
  }
  return names;
}

}  // namespace simbench::scenarios

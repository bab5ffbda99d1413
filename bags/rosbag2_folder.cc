#include "bags/rosbag2_folder.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>
#include <tuple>

#include "bags/bag.h"
#include "scenarios/input_file.h"

namespace simbench::bags {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostMetadata = std::size_t{16} << 20;

std::string_view stripped(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  text = text.substr(first, text.find_last_not_of(kBlank) - first + 1);
  const bool quoted = text.size() > 1 && text.front() == text.back() &&
                      (text.front() == '"' || text.front() == '\'');
  return quoted ? text.substr(1, text.size() - 2) : text;
}

// The list behind `relative_file_paths:`, a line each or in brackets.
std::vector<std::string> listed_paths(std::string_view yaml) {
  constexpr std::string_view kKey = "relative_file_paths:";
  std::vector<std::string> paths;
  bool in_list = false;
  while (!yaml.empty()) {
    const std::size_t end = std::min(yaml.find('\n'), yaml.size());
    std::string_view line = stripped(yaml.substr(0, end));
    yaml.remove_prefix(std::min(end + 1, yaml.size()));
    if (line.starts_with(kKey)) {
      in_list = true;
      line = stripped(line.substr(kKey.size()));
      if (!line.starts_with('[') || !line.ends_with(']')) continue;
      line = line.substr(1, line.size() - 2);
      while (!line.empty()) {
        const std::size_t comma = std::min(line.find(','), line.size());
        paths.emplace_back(stripped(line.substr(0, comma)));
        line.remove_prefix(std::min(comma + 1, line.size()));
      }
      break;
    }
    if (!in_list) continue;
    if (!line.starts_with("- ")) break;
    paths.emplace_back(stripped(line.substr(2)));
  }
  return paths;
}

// "rig_10.db3" comes after "rig_9.db3".
auto split_order(const fs::path& path) {
  const std::string stem = path.stem().string();
  const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
  const std::string number = stem.substr(digits);
  const std::size_t zeros = std::min(number.find_first_not_of('0'), number.size());
  return std::tuple(stem.substr(0, digits), number.size() - zeros, number.substr(zeros),
                    path.filename().string());
}

bool is_named_compressed(const fs::path& path) { return path.extension() == ".zstd"; }

std::vector<fs::path> named_as_bags(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& path = entry->path();
    const fs::path name = is_named_compressed(path) ? path.stem() : path.filename();
    if (name.extension() == ".db3" || name.extension() == ".mcap") files.push_back(path);
  }
  if (error) throw BagError(folder.string() + ": cannot be read: " + error.message());
  std::ranges::sort(files, {}, [](const fs::path& path) { return split_order(path); });
  return files;
}

}  // namespace

bool is_rosbag2_folder(const std::string& folder) {
  const fs::path root(folder);
  if (fs::exists(root / "manifest.json")) return false;
  return fs::exists(root / "metadata.yaml") || !named_as_bags(root).empty();
}

std::vector<std::string> rosbag2_files(const std::string& folder, std::vector<std::string>* notes) {
  const fs::path root(folder);
  std::vector<fs::path> files;
  const fs::path metadata = root / "metadata.yaml";
  if (fs::exists(metadata)) {
    if (!fs::is_regular_file(metadata)) {
      throw BagError(metadata.string() + ": found a pipe, a device or a folder, allowed: a file");
    }
    try {
      // Bags lie in the folder itself, whatever the path in the list (old ones name the folder).
      for (const std::string& path :
           listed_paths(file_content(metadata.string(), kMostMetadata, Pipes::kRefused))) {
        if (const fs::path name = fs::path(path).filename(); !name.empty()) {
          files.push_back(root / name);
        }
      }
    } catch (const FileError& error) {
      throw BagError(metadata.string() + ": cannot be read: " + error.what());
    }
  }
  if (files.empty()) files = named_as_bags(root);
  if (files.empty()) {
    throw BagError(folder + ": found no bag, allowed: a folder with .db3 or .mcap files");
  }
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (fs::path& file : files) {
    // Whoever has unpacked it need not touch metadata.yaml.
    if (is_named_compressed(file) && fs::exists(file.parent_path() / file.stem())) {
      file.replace_extension();
    }
    std::error_code none;
    const fs::path target = fs::weakly_canonical(file, none);
    if (seen.insert(none ? file.string() : target.string()).second) {
      names.push_back(file.string());
    } else if (notes != nullptr) {
      notes->push_back(file.string() +
                       ": stands twice among the files of the recording; it is "
                       "read once");
    }
  }
  return names;
}

}  // namespace simbench::bags

#include "recording/dataset_folder.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace simbench {
namespace {

namespace fs = std::filesystem;

using Files = std::vector<std::string>;

// The entries of a folder, by name; none if it cannot be read.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    entries.push_back(entry->path());
  }
  std::ranges::sort(entries);
  return entries;
}

// "cam0/data.csv" of each folder whose name begins so.
Files lists_in(const fs::path& folder, std::string_view beginning, const char* list) {
  Files files;
  for (const fs::path& entry : entries_of(folder)) {
    if (!entry.filename().native().starts_with(beginning)) continue;
    if (fs::is_regular_file(entry / list)) files.push_back(entry / list);
  }
  return files;
}

Files kitti_lists(const fs::path& folder) {
  Files files = lists_in(folder, "image_", "timestamps.txt");
  const fs::path laser = folder / "velodyne_points" / "timestamps.txt";
  if (!files.empty() && fs::is_regular_file(laser)) files.push_back(laser);
  return files;
}

Files tum_lists(const fs::path& folder) {
  Files files;
  for (const char* list : {"rgb.txt", "depth.txt"}) {
    if (fs::is_regular_file(folder / list)) files.push_back(folder / list);
  }
  return files;
}

// ".csv" of "front.csv" and of "front.csv.gz".
fs::path plain_extension(const fs::path& file) {
  constexpr std::array<std::string_view, 5> kCompressed = {".gz", ".zst", ".zstd", ".bz2", ".lz4"};
  const bool packed = std::ranges::find(kCompressed, file.extension()) != kCompressed.end();
  return packed ? file.stem().extension() : file.extension();
}

Files csv_files(const fs::path& folder) {
  constexpr std::array<std::string_view, 3> kBags = {".bag", ".db3", ".mcap"};
  Files files;
  for (const fs::path& entry : entries_of(folder)) {
    const fs::path extension = plain_extension(entry);
    if (std::ranges::find(kBags, extension) != kBags.end()) return {};
    if (extension == ".csv" && fs::is_regular_file(entry)) files.push_back(entry);
  }
  return files;
}

}  // namespace

Files dataset_files(const std::string& folder) {
  const fs::path root(folder);
  std::error_code none;
  if (!fs::is_directory(root, none)) return {};
  for (const char* own : {"manifest.json", "results.json", "metadata.yaml"}) {
    if (fs::exists(root / own, none)) return {};
  }
  for (const fs::path& place : {root / "mav0", root}) {
    if (Files files = lists_in(place, "cam", "data.csv"); !files.empty()) return files;
  }
  if (Files files = kitti_lists(root); !files.empty()) return files;
  if (Files files = tum_lists(root); !files.empty()) return files;
  return csv_files(root);
}

Files with_dataset_files(const Files& inputs) {
  Files all;
  for (const std::string& input : inputs) {
    const Files files = dataset_files(input);
    if (files.empty()) {
      all.push_back(input);
    } else {
      all.insert(all.end(), files.begin(), files.end());
    }
  }
  return all;
}

}  // namespace simbench

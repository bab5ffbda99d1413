#include "bags/rosbag2_folder.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <vector>

#include "bags/bag.h"
#include "bags/recorded_files.h"
#include "tests/bags/bag_writers.h"
#include "tests/scratch_folder.h"

namespace simbench::bags {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::string folder_refusal(const ScratchFolder& folder) {
  try {
    rosbag2_files(folder.path().string());
  } catch (const BagError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Rosbag2Folder, TakesTheOrderOfItsMetadata) {
  const ScratchFolder folder;
  folder.write("metadata.yaml",
               "rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths:\n"
               "    - rig_1.db3\n    - \"old/rig_0.db3\"\n  duration:\n    nanoseconds: 1\n");
  folder.write("rig_0.db3", "");
  EXPECT_THAT(rosbag2_files(folder.path().string()),
              ElementsAre(folder / "rig_1.db3", folder / "rig_0.db3"));
  folder.write("metadata.yaml", "  relative_file_paths: [a.mcap, 'b.mcap']\n");
  EXPECT_THAT(rosbag2_files(folder.path().string()),
              ElementsAre(folder / "a.mcap", folder / "b.mcap"));
}

TEST(Rosbag2Folder, WithoutMetadataNumbersCount) {
  const ScratchFolder folder;
  for (const char* name : {"rig_10.mcap", "rig_9.mcap", "rig_1.mcap", "notes.txt"}) {
    folder.write(name, "");
  }
  EXPECT_THAT(rosbag2_files(folder.path().string()),
              ElementsAre(folder / "rig_1.mcap", folder / "rig_9.mcap", folder / "rig_10.mcap"));
}

TEST(Rosbag2Folder, AFileThatIsCompressedAsAWholeIsReadUnlessItIsUnpackedBesideIt) {
  const ScratchFolder folder;
  const std::string file = folder.write("rig_0.db3.zstd", "");
  EXPECT_THAT(rosbag2_files(folder.path().string()), ElementsAre(file));
  folder.write("metadata.yaml", "relative_file_paths:\n- rig_0.db3.zstd\n");
  EXPECT_THAT(rosbag2_files(folder.path().string()), ElementsAre(file));
  folder.write("rig_0.db3", "");
  EXPECT_THAT(rosbag2_files(folder.path().string()), ElementsAre(folder / "rig_0.db3"));
}

TEST(Rosbag2Folder, AFileThatIsNamedTwiceIsReadOnce) {
  const ScratchFolder folder;
  const std::string file = folder.write("rig_0.db3", "");
  std::filesystem::create_symlink(file, folder / "again.db3");
  folder.write("metadata.yaml", "relative_file_paths:\n- rig_0.db3\n- rig_0.db3\n- again.db3\n");
  std::vector<std::string> notes;
  EXPECT_THAT(rosbag2_files(folder.path().string(), &notes), ElementsAre(file));
  EXPECT_THAT(notes, ElementsAre(HasSubstr("rig_0.db3: stands twice"),
                                 HasSubstr("again.db3: stands twice")));
}

// A pipe that nobody writes would be waited for.
TEST(Rosbag2Folder, PipesAndDevicesAreRefused) {
  const ScratchFolder folder;
  ASSERT_EQ(mkfifo((folder / "rig_0.db3").c_str(), 0600), 0);
  EXPECT_THAT(bag_refusal(folder / "rig_0.db3"), HasSubstr("it is a pipe; allowed: a file"));
  EXPECT_THAT(bag_refusal("/dev/zero"), HasSubstr("it is a device"));
  EXPECT_THROW(scan_recording(folder.path().string(), "rig", {}), BagError);
  ASSERT_EQ(mkfifo((folder / "metadata.yaml").c_str(), 0600), 0);
  EXPECT_THAT(folder_refusal(folder), HasSubstr("metadata.yaml: found a pipe"));
}

TEST(Rosbag2Folder, AFileThatIsCompressedAsAWholeIsKnownByItsBytes) {
  const ScratchFolder folder;
  const std::string path =
      folder.write("rig.db3.zstd", deflated("zstd", std::string("SQLite format 3\0rest", 20)));
  EXPECT_TRUE(is_bag(path));
  EXPECT_THAT(bag_refusal(path), StartsWith(path + ", unpacked: "));
}

TEST(Rosbag2Folder, AFolderWithoutBagsIsRefused) {
  const ScratchFolder folder;
  EXPECT_THAT(folder_refusal(folder), HasSubstr("found no bag, allowed: a folder with .db3"));
}

}  // namespace
}  // namespace simbench::bags

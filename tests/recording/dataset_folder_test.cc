#include "recording/dataset_folder.h"

#include <gmock/gmock.h>

#include "tests/scratch_folder.h"

namespace simbench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class DatasetFolderTest : public testing::Test {
 protected:
  std::vector<std::string> files(const std::string& in = "") const {
    return dataset_files(folder_ / in);
  }
  const ScratchFolder folder_;
};

TEST_F(DatasetFolderTest, EurocHasTheListsOfItsCamerasAndNoOther) {
  const std::string right = folder_.write("MH01/mav0/cam1/data.csv", "");
  const std::string left = folder_.write("MH01/mav0/cam0/data.csv", "");
  folder_.write("MH01/mav0/imu0/data.csv", "");
  folder_.write("MH01/notes.csv", "");
  EXPECT_THAT(files("MH01"), ElementsAre(left, right));
  EXPECT_THAT(files("MH01/mav0"), ElementsAre(left, right));
}

TEST_F(DatasetFolderTest, KittiHasItsCamerasAndTheLaser) {
  const std::string laser = folder_.write("drive/velodyne_points/timestamps.txt", "");
  const std::string gray = folder_.write("drive/image_00/timestamps.txt", "");
  const std::string colour = folder_.write("drive/image_02/timestamps.txt", "");
  folder_.write("drive/oxts/timestamps.txt", "");
  EXPECT_THAT(files("drive"), ElementsAre(gray, colour, laser));
}

TEST_F(DatasetFolderTest, TumHasColourAndDepth) {
  const std::string depth = folder_.write("fr1/depth.txt", "");
  EXPECT_THAT(files("fr1"), ElementsAre(depth));
  const std::string rgb = folder_.write("fr1/rgb.txt", "");
  folder_.write("fr1/groundtruth.txt", "");
  EXPECT_THAT(files("fr1"), ElementsAre(rgb, depth));
}

TEST_F(DatasetFolderTest, AnyOtherHasItsTables) {
  const std::string packed = folder_.write("rig/back.csv.gz", "");
  const std::string plain = folder_.write("rig/front.csv", "");
  folder_.write("rig/readme.md", "");
  folder_.write("rig/deeper/other.csv", "");
  EXPECT_THAT(files("rig"), ElementsAre(packed, plain));
  EXPECT_THAT(with_dataset_files({"a.bag", folder_ / "rig", "no_such"}),
              ElementsAre("a.bag", packed, plain, "no_such"));
}

TEST_F(DatasetFolderTest, FoldersOfOtherKindsAreNone) {
  for (const char* own : {"manifest.json", "results.json", "metadata.yaml"}) {
    folder_.write(std::string(own) + ".d/frames.csv", "");
    folder_.write(std::string(own) + ".d/" + own, "");
    EXPECT_THAT(files(std::string(own) + ".d"), IsEmpty()) << own;
  }
  // Bags beside tables: neither is left out in silence.
  folder_.write("mixed/frames.csv", "");
  folder_.write("mixed/rig_0.mcap.zstd", "");
  EXPECT_THAT(files("mixed"), IsEmpty());
  std::filesystem::create_directory(folder_ / "empty");
  EXPECT_THAT(files("empty"), IsEmpty());
  EXPECT_THAT(files("no_such"), IsEmpty());
  EXPECT_THAT(dataset_files(folder_.write("a.csv", "")), IsEmpty());
}

}  // namespace
}  // namespace simbench

#include "reconstruction/libraries/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <stdexcept>
#include <string>

#include "scenarios/loader.h"
#include "tests/read_fault.h"
#include "tests/reconstruction/box.h"
#include "tests/scratch_folder.h"

namespace simbench::reconstruction {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A file that is gone after the test.
class MeshFile : public testing::Test {
 protected:
  std::string write(const std::string& extension, const std::string& bytes) const {
    return folder_.write("mesh" + extension, bytes);
  }

  std::string problem_of(const std::string& path) {
    try {
      load_subject_mesh(path);
    } catch (const scenarios::InputError& error) {
      return error.what();
    }
    return "none";
  }

 private:
  ScratchFolder folder_;
};

std::string box_in(double unit) {
  TriangleMesh box = make_box({0.4, 0.3, 1.8});
  for (Eigen::Vector3f& vertex : box.vertices) vertex *= static_cast<float>(unit);
  return ply_bytes(box);
}

float height_of(const TriangleMesh& mesh) {
  float low = 1e9F;
  float high = -1e9F;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    low = std::min(low, vertex.z());
    high = std::max(high, vertex.z());
  }
  EXPECT_NEAR(low, 0, 1e-5) << "not on the floor";
  return high - low;
}

TEST_F(MeshFile, AReadErrorIsNoEndOfTheFile) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 2\nf 1 2 3\nf 1 2 4\n";
  const std::string path = write(".obj", text);
  EXPECT_EQ(problem_of(path), "none");
  for (std::size_t byte = 0; byte < text.size(); ++byte) {
    const ReadFault fault(byte);
    EXPECT_THAT(problem_of(path), HasSubstr("mesh.obj: cannot be read: ")) << byte;
  }
}

TEST_F(MeshFile, WhatCannotBeReadBackIsNotGivenOn) {
  const std::size_t size = box_in(1).size();
  for (const std::size_t byte : {std::size_t{0}, size / 2, size - 1}) {
    const ReadFault fault(byte);
    EXPECT_THROW(box_in(1), std::runtime_error) << byte;
  }
}

TEST_F(MeshFile, OfMetresIsTakenAsItIs) {
  const LoadedMesh loaded = load_subject_mesh(write(".ply", box_in(1)));
  EXPECT_NEAR(height_of(loaded.mesh), 1.8, 1e-5);
  EXPECT_EQ(loaded.mesh.triangles.size(), 12U);
  EXPECT_THAT(loaded.notes, IsEmpty());
}

TEST_F(MeshFile, OfMillimetresIsDetectedAndSaid) {
  const LoadedMesh loaded = load_subject_mesh(write(".ply", box_in(1000)));
  EXPECT_NEAR(height_of(loaded.mesh), 1.8, 1e-4);
  EXPECT_THAT(loaded.notes, ElementsAre(HasSubstr("millimetres")));
}

TEST_F(MeshFile, OfCentimetresIsDetectedAndSaid) {
  const LoadedMesh loaded = load_subject_mesh(write(".ply", box_in(100)));
  EXPECT_NEAR(height_of(loaded.mesh), 1.8, 1e-4);
  EXPECT_THAT(loaded.notes, ElementsAre(HasSubstr("centimetres")));
}

TEST_F(MeshFile, WithHolesIsUsedAndSaid) {
  TriangleMesh box = make_box({0.4, 0.3, 1.8});
  box.triangles.pop_back();
  EXPECT_EQ(open_edges(box), 3);
  const LoadedMesh loaded = load_subject_mesh(write(".ply", ply_bytes(box)));
  EXPECT_EQ(loaded.mesh.triangles.size(), 11U);
  EXPECT_THAT(loaded.notes, ElementsAre(HasSubstr("holes (3 open edges)")));
}

TEST_F(MeshFile, ThatLiesOnItsSideIsSaid) {
  const LoadedMesh loaded = load_subject_mesh(write(".ply", ply_bytes(make_box({0.4, 1.8, 0.3}))));
  EXPECT_THAT(loaded.notes, ElementsAre(HasSubstr("z axis is taken to be up")));
}

TEST_F(MeshFile, StandsAboveTheOrigin) {
  TriangleMesh box = make_box({0.4, 0.3, 1.8});
  for (Eigen::Vector3f& vertex : box.vertices) vertex += Eigen::Vector3f(7, -3, 5);
  const LoadedMesh loaded = load_subject_mesh(write(".ply", ply_bytes(box)));
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& vertex : loaded.mesh.vertices) sum += vertex;
  EXPECT_NEAR(sum.x(), 0, 1e-4);
  EXPECT_NEAR(sum.y(), 0, 1e-4);
}

TEST_F(MeshFile, OfObjIsRead) {
  const LoadedMesh loaded = load_subject_mesh(
      write(".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1.5\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"));
  EXPECT_EQ(loaded.mesh.triangles.size(), 4U);
  EXPECT_NEAR(height_of(loaded.mesh), 1.5, 1e-6);
}

TEST_F(MeshFile, WithoutFacesIsRefused) {
  TriangleMesh points{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}}, .triangles = {}};
  EXPECT_THAT(problem_of(write(".ply", ply_bytes(points))), HasSubstr("3 points and no faces"));
}

TEST_F(MeshFile, ThatIsNotThereOrNoMeshIsRefused) {
  EXPECT_THAT(problem_of("/nowhere/at/all.ply"), HasSubstr("no such file"));
  EXPECT_THAT(problem_of(write(".ply", "this is no mesh\n")), HasSubstr("no mesh"));
  EXPECT_THAT(problem_of(write(".docx", "neither is this")), HasSubstr("allowed: PLY"));
}

TEST_F(MeshFile, WithCornersThatDoNotExistIsRefused) {
  EXPECT_NE(problem_of(write(".off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 1\n3 0 1 9\n")), "none");
}

TEST_F(MeshFile, WithoutExtentIsRefused) {
  TriangleMesh point{.vertices = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, .triangles = {{0, 1, 2}}};
  EXPECT_THAT(problem_of(write(".ply", ply_bytes(point))), HasSubstr("without extent"));
}

TEST(Ply, KeepsVerticesFacesAndColours) {
  TriangleMesh box = make_box({1, 1, 1});
  box.colours.assign(box.vertices.size(), Eigen::Vector3f(1, 0, 0));
  const std::string bytes = ply_bytes(box);
  EXPECT_THAT(bytes, testing::StartsWith("ply\nformat binary"));
  EXPECT_THAT(bytes, HasSubstr("element vertex " + std::to_string(box.vertices.size())));
  EXPECT_THAT(bytes, HasSubstr("element face 12"));
  EXPECT_THAT(bytes, HasSubstr("red"));
}

TEST(Png, IsAPictureOfThatSize) {
  TriangleMesh box = make_box({0.5, 0.5, 1.8});
  box.colours.assign(box.vertices.size(), Eigen::Vector3f(1, 0, 0));
  const Picture picture = picture_of(box);
  // White around it, red in the middle.
  EXPECT_EQ(picture.rgb[0], 255);
  EXPECT_EQ(picture.rgb[1], 255);
  const std::size_t middle =
      3 * (static_cast<std::size_t>(picture.height) / 2 * static_cast<std::size_t>(picture.width) +
           static_cast<std::size_t>(picture.width) / 2);
  EXPECT_GT(picture.rgb[middle], 80);
  EXPECT_EQ(picture.rgb[middle + 1], 0);
  const std::vector<std::uint8_t> png = png_bytes(picture);
  ASSERT_GT(png.size(), 24U);
  EXPECT_EQ(std::string(png.begin() + 1, png.begin() + 4), "PNG");
  const auto number = [&](std::size_t at) { return png[at + 2] * 256 + png[at + 3]; };
  EXPECT_EQ(number(16), picture.width);
  EXPECT_EQ(number(20), picture.height);
}

}  // namespace
}  // namespace simbench::reconstruction

#include "reconstruction/libraries/mesh_file.h"

#include <fmt/format.h>
#include <open3d/geometry/Image.h>
#include <open3d/geometry/TriangleMesh.h>
#include <open3d/io/ImageIO.h>
#include <open3d/io/TriangleMeshIO.h>
#include <open3d/utility/Logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "recording/temporary_folder.h"
#include "scenarios/input_file.h"
#include "scenarios/loader.h"

namespace simbench::reconstruction {
namespace {

using scenarios::InputError;

constexpr std::size_t kLargestFile = std::size_t{1} << 30;

// The bytes that `write` writes to a file of that extension. Open3D writes only to files.
std::string written_bytes(const std::string& extension,
                          const std::function<bool(const std::string& path)>& write) {
  const TemporaryFolder folder;
  const std::string path = folder.file("file" + extension);
  const bool written = write(path);
  std::string bytes;
  if (written) {
    try {
      bytes = file_content(path, kLargestFile);
    } catch (const FileError&) {  // no file, or not all of it
      bytes.clear();
    }
  }
  if (bytes.empty()) throw std::runtime_error(path + ": cannot be written; is the disk full?");
  return bytes;
}

TriangleMesh read_mesh(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) {
    throw InputError(
        fmt::format("{}: found no such file, allowed: a PLY, OBJ, OFF or STL mesh", path));
  }
  try {
    file_content(path, kLargestFile);  // Open3D takes a read error for the end of some formats
  } catch (const FileError& error) {
    throw InputError(fmt::format("{}: cannot be read: {}", path, error.what()));
  }
  open3d::utility::SetVerbosityLevel(open3d::utility::VerbosityLevel::Error);
  open3d::geometry::TriangleMesh file;
  if (!open3d::io::ReadTriangleMesh(path, file) || file.vertices_.empty()) {
    throw InputError(
        fmt::format("{}: found no mesh that can be read, allowed: PLY, OBJ, OFF, STL", path));
  }
  if (file.triangles_.empty()) {
    throw InputError(fmt::format(
        "{}: found {} points and no faces; a subject needs a surface (reconstruct one first)", path,
        file.vertices_.size()));
  }
  TriangleMesh mesh;
  for (const Eigen::Vector3d& vertex : file.vertices_) {
    if (!vertex.allFinite()) throw InputError(path + ": found a vertex that is not finite");
    mesh.vertices.emplace_back(vertex.cast<float>());
  }
  const auto count = static_cast<int>(mesh.vertices.size());
  for (const Eigen::Vector3i& triangle : file.triangles_) {
    if (triangle.minCoeff() < 0 || triangle.maxCoeff() >= count) {
      throw InputError(fmt::format("{}: found a face with corner {}, allowed 0 to {}", path,
                                   triangle.maxCoeff(), count - 1));
    }
  }
  mesh.triangles = file.triangles_;
  return mesh;
}

Eigen::AlignedBox3f box_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    for (const int corner : triangle) box.extend(mesh.vertices[static_cast<std::size_t>(corner)]);
  }
  return box;
}

// Metres from a file's unit.
float unit_of(float longest, const std::string& path, std::vector<std::string>& notes) {
  constexpr float kLongestInMetres = 20;
  constexpr float kLongestInCentimetres = 500;
  if (longest <= kLongestInMetres) return 1;
  const bool centimetres = longest <= kLongestInCentimetres;
  const float unit = centimetres ? 0.01F : 0.001F;
  notes.push_back(
      fmt::format("{}: its longest side is {:.4g}, so it is taken to be in {} ({:.3g} m)", path,
                  longest, centimetres ? "centimetres" : "millimetres", longest * unit));
  return unit;
}

}  // namespace

std::int64_t open_edges(const TriangleMesh& mesh) {
  std::map<std::tuple<float, float, float>, int> places;
  std::vector<int> place_of(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Eigen::Vector3f& at = mesh.vertices[v];
    place_of[v] =
        places.try_emplace({at.x(), at.y(), at.z()}, static_cast<int>(places.size())).first->second;
  }
  std::vector<std::pair<int, int>> edges;
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      const int from = place_of[static_cast<std::size_t>(triangle[corner])];
      const int to = place_of[static_cast<std::size_t>(triangle[(corner + 1) % 3])];
      if (from != to) edges.emplace_back(std::min(from, to), std::max(from, to));
    }
  }
  std::sort(edges.begin(), edges.end());
  std::int64_t open = 0;
  for (auto edge = edges.begin(); edge != edges.end();) {
    const auto next = std::find_if(edge, edges.end(), [&](const auto& e) { return e != *edge; });
    if (next - edge == 1) ++open;
    edge = next;
  }
  return open;
}

LoadedMesh load_subject_mesh(const std::string& path) {
  LoadedMesh loaded{read_mesh(path), {}};
  TriangleMesh& mesh = loaded.mesh;
  const Eigen::AlignedBox3f box = box_of(mesh);
  const float longest = box.sizes().maxCoeff();
  if (!(longest > 0)) throw InputError(path + ": found a mesh without extent");
  const float unit = unit_of(longest, path, loaded.notes);
  const Eigen::Vector3f foot(box.center().x(), box.center().y(), box.min().z());
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = (vertex - foot) * unit;
  if (box.sizes().z() < longest) {
    loaded.notes.push_back(
        fmt::format("{}: its z axis is taken to be up, and it is not its longest side", path));
  }
  if (const std::int64_t open = open_edges(mesh); open > 0) {
    loaded.notes.push_back(fmt::format(
        "{}: the mesh has holes ({} open edges); rays that enter them see its inside", path, open));
  }
  return loaded;
}

std::string ply_bytes(const TriangleMesh& mesh) {
  open3d::geometry::TriangleMesh file;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    file.vertices_.emplace_back(vertex.cast<double>());
  }
  for (const Eigen::Vector3f& colour : mesh.colours) {
    file.vertex_colors_.emplace_back(colour.cast<double>());
  }
  file.triangles_ = mesh.triangles;
  return written_bytes(
      ".ply", [&](const std::string& path) { return open3d::io::WriteTriangleMesh(path, file); });
}

std::vector<std::uint8_t> png_bytes(const Picture& picture) {
  open3d::geometry::Image image;
  image.Prepare(picture.width, picture.height, 3, 1);
  image.data_ = picture.rgb;
  const std::string bytes = written_bytes(
      ".png", [&](const std::string& path) { return open3d::io::WriteImage(path, image); });
  return {bytes.begin(), bytes.end()};
}

}  // namespace simbench::reconstruction

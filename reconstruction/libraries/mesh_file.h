// Mesh files and pictures, through Open3D: a user's own subject in, meshes and PNG out.
//
//   LoadedMesh scan = load_subject_mesh("scan.ply");     // notes: in millimetres, has holes
//   file << ply_bytes(mesh);
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reconstruction/libraries/picture.h"
#include "reconstruction/triangle_mesh.h"

namespace simbench::reconstruction {

struct LoadedMesh {
  TriangleMesh mesh;  // metres, on the floor, its middle above the origin
  std::vector<std::string> notes;
};

// Reads a PLY, OBJ, OFF or STL file whose z axis is up. Its size determines its unit: a longest
// side of more than 500 means millimetres, of more than 20 centimetres, else metres; a note states
// it. Holes are allowed and noted (rays that enter through them see the inside). Throws
// scenarios::InputError: no such file, no mesh in it, no faces, corners that do not exist or are
// not finite, no extent.
LoadedMesh load_subject_mesh(const std::string& path);

// Edges that belong to one triangle only: the rims of holes. Corners at the same place are one.
std::int64_t open_edges(const TriangleMesh& mesh);

// Binary PLY, with colours if the mesh has them.
std::string ply_bytes(const TriangleMesh& mesh);

std::vector<std::uint8_t> png_bytes(const Picture& picture);

}  // namespace simbench::reconstruction

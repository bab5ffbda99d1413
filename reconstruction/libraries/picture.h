// A picture of a coloured mesh, made by casting rays: no display is needed.
//
// The view is always from the same side and distance (kPictureAzimuth, kPictureDistance), with the
// mesh's middle in the middle, so that pictures can be compared. White background; shaded by the
// angle at which the surface is seen.
//
//   const Picture picture = picture_of(mesh);
#pragma once

#include <cstdint>
#include <vector>

#include "reconstruction/triangle_mesh.h"

namespace simbench::reconstruction {

inline constexpr double kPictureAzimuth = 0.6;   // radians from the x axis
inline constexpr double kPictureDistance = 3.2;  // m

struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  // row by row
};

// The mesh has a colour for each vertex.
Picture picture_of(const TriangleMesh& mesh);

}  // namespace simbench::reconstruction

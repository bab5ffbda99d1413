// A depth image: for each pixel the z of the surface seen there, in the camera's frame.
//
// Row by row; metres; 0 where nothing is seen (as the D400 family says it).
#ifndef SIMBENCH_RECONSTRUCTION_DEPTH_MAP_H_
#define SIMBENCH_RECONSTRUCTION_DEPTH_MAP_H_

#include <cstddef>
#include <vector>

namespace simbench::reconstruction {

struct DepthMap {
  DepthMap() = default;
  DepthMap(int columns, int rows)
      : width(columns),
        height(rows),
        depth_m(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0.0F) {}

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
  float at(int column, int row) const { return depth_m[index(column, row)]; }

  int width = 0;
  int height = 0;
  std::vector<float> depth_m;
};

// What a ray caster sees: the true depth, and how steeply the surface is met. `cos_incidence` is
// the cosine between the ray and the surface's normal, in [0, 1]; 0 where nothing is seen.
struct SeenDepth {
  DepthMap depth;
  std::vector<float> cos_incidence;
};

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_RECONSTRUCTION_DEPTH_MAP_H_

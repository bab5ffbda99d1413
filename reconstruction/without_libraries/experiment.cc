// What a simbench that was built without Embree and Open3D has in place of the experiment.
#include "reconstruction/experiment.h"

#include <stdexcept>

namespace simbench::reconstruction {

bool reconstruction_available() { return false; }

std::string how_to_get_reconstruction() {
  return "this simbench was built without Embree and Open3D, which reconstruction needs. "
         "tools/run --with-reconstruction installs them and builds with them (Debian: "
         "libembree-dev "
         "libopen3d-dev; CMake: -DSIMBENCH_WITH_RECONSTRUCTION=ON)";
}

ReconstructionResults run_reconstruction(const scenarios::Scenario&,
                                         const evaluation::SourceFactory&,
                                         const ReconstructionOptions&, const MeshKeeper&,
                                         const evaluation::Progress&) {
  throw std::logic_error(how_to_get_reconstruction());
}

}  // namespace simbench::reconstruction

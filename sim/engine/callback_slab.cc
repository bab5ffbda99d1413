#include "sim/engine/callback_slab.h"

namespace simbench::sim {

void CallbackSlab::clear() {
  while (live_ > 0) {
    for (std::uint32_t index = 0; index < size_; ++index) {
      if (!holds(index)) continue;
      destroy(index);
      release(index);
    }
  }
}

}  // namespace simbench::sim

#include "evaluation/set_counter.h"

namespace simbench::evaluation {

void SetCounter::on_set(std::span<const GatherFrame> set) {
  bool counts = false;
  bool pure = true;
  for (const GatherFrame& frame : set) {
    counts |= frame.tag >= first_pulse_ && frame.tag < end_;
    pure &= frame.tag == set.front().tag;
  }
  if (!counts) return;
  ++emitted_;
  if (pure) ++pure_;
}

}  // namespace simbench::evaluation

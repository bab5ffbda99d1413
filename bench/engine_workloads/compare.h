// simbench's engine against the reference, in interleaved pairs within one process.
#ifndef SIMBENCH_BENCH_ENGINE_WORKLOADS_COMPARE_H_
#define SIMBENCH_BENCH_ENGINE_WORKLOADS_COMPARE_H_

#include <string>

namespace simbench::bench {

// Runs every case `pairs` times on both sides, alternating which comes first, and returns a table:
// case, median ns per event of both sides, median of the pairs' ratios, target ratio. Interleaving
// keeps a machine that changes its pace from favouring one side. Throws std::runtime_error when
// the sides' checksums differ.
std::string compare_with_reference(int pairs);

}  // namespace simbench::bench

#endif  // SIMBENCH_BENCH_ENGINE_WORKLOADS_COMPARE_H_

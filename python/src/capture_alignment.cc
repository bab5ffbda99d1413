// capture_alignment in Python: an `async def` function, which runs once for each camera.
#include "algorithms/ports/capture_alignment.h"

#include <cstdint>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "algorithms/host_sync/join.h"
#include "algorithms/registry.h"
#include "python/src/algorithms.h"
#include "python/src/python_coroutine.h"

namespace simbench::python {
namespace {

class PythonCaptureAlignment final : public CaptureAlignment {
 public:
  PythonCaptureAlignment(AlgorithmDefinition algorithm, const Parameters& parameters)
      : algorithm_(std::move(algorithm)), parameters_(parameters) {
    const WithGil gil;
    keywords_of(*algorithm_, parameters_);  // refuses what is no whole number
  }

  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override {
    return steer_all(host, {slaves.begin(), slaves.end()});
  }
  Task<void> run_slave(Host& host, PeerId master) override { return steer_all(host, {master}); }

 private:
  Task<void> steer_all(Host& host, std::set<PeerId> peers) {
    const PortOfRun port(host, std::move(peers), Transport::kAlignment);
    const auto count = static_cast<std::uint32_t>(port.get()->cameras.size());
    std::vector<Task<void>> cameras;
    cameras.reserve(count);
    for (std::uint32_t place = 0; place < count; ++place) {
      cameras.push_back(drive(algorithm_, port.get(), parameters_, place));
    }
    co_await join_all(std::move(cameras));
  }

  AlgorithmDefinition algorithm_;
  Parameters parameters_;
};

}  // namespace

void register_python_capture_alignment(const Object& definition) {
  const auto algorithm = std::make_shared<const PythonAlgorithm>(algorithm_of(definition));
  replace_algorithm<CaptureAlignmentEntry>(
      {.info = algorithm->info, .make = [algorithm](const Parameters& parameters) {
         return std::make_unique<PythonCaptureAlignment>(algorithm, parameters);
       }});
}

}  // namespace simbench::python

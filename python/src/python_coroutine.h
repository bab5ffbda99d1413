// An `async def` function as a coroutine of this program, for the stages that are written as
// coroutines.
//
// drive() lets Python run until that awaits an operation of its host, then awaits the operation
// itself, without the interpreter's lock, and sends back its value or raises its error there.
// Errors: what Python raises is a PythonFailure (python_algorithm.h).
//
//   Task<void> followed(Host& host, AlgorithmDefinition algorithm, Parameters parameters) {
//     const PortOfRun port(host, {0});
//     co_await drive(algorithm, port.get(), parameters, std::nullopt);
//   }
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>

#include "algorithms/parameters.h"
#include "algorithms/ports/host.h"
#include "python/src/host_requests.h"
#include "python/src/python_algorithm.h"

namespace simbench::python {

using AlgorithmDefinition = std::shared_ptr<const PythonAlgorithm>;

// The port has no host once the coroutine that has it has ended.
class PortOfRun {
 public:
  PortOfRun(Host& host, std::set<PeerId> peers, Transport datagrams = Transport::kDatagram);
  PortOfRun(const PortOfRun&) = delete;
  PortOfRun& operator=(const PortOfRun&) = delete;
  ~PortOfRun();
  const SharedPort& get() const { return port_; }

 private:
  SharedPort port_;
};

// Calls the definition's make(port, settings, number) and runs what that returns to its end.
// `number`: of a server its client's, of a camera its place on the host.
Task<void> drive(AlgorithmDefinition algorithm, SharedPort port, Parameters parameters,
                 std::optional<std::uint32_t> number);

}  // namespace simbench::python

// host_sync in Python: `async def` functions for the slaves and, if it has one, for the master.
#include "algorithms/ports/host_sync.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/host_sync/join.h"
#include "algorithms/registry.h"
#include "python/src/algorithms.h"
#include "python/src/python_coroutine.h"

namespace simbench::python {
namespace {

class PythonHostSync final : public HostSync {
 public:
  PythonHostSync(AlgorithmDefinition client, AlgorithmDefinition server,
                 const Parameters& parameters)
      : client_(std::move(client)), server_(std::move(server)), parameters_(parameters) {
    const WithGil gil;
    keywords_of(*client_, parameters_);  // refuses what is no whole number
    if (parameters_.all().contains(kWarmUp)) warm_up_ = from_seconds(parameters_.number(kWarmUp));
  }

  std::optional<Nanoseconds> warm_up() const override { return warm_up_; }

  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override {
    const PortOfRun port(host, {slaves.begin(), slaves.end()});
    std::vector<Task<void>> servers;
    servers.reserve(slaves.size());
    for (const PeerId slave : slaves) {
      servers.push_back(server_ ? drive(server_, port.get(), parameters_, slave)
                                : answer_questions(host, slave));
    }
    co_await join_all(std::move(servers));
  }

  Task<void> run_slave(Host& host, PeerId master) override {
    const PortOfRun port(host, {master});
    co_await drive(client_, port.get(), parameters_, std::nullopt);
    port.get()->outcome.synchronised(port.get()->exchanges);
    if (!server_) co_await say_done(host, master);
  }

 private:
  static constexpr const char* kWarmUp = "warm_up_s";

  AlgorithmDefinition client_;
  AlgorithmDefinition server_;  // null: the answerer
  Parameters parameters_;
  std::optional<Nanoseconds> warm_up_;
};

}  // namespace

void register_python_host_sync(const Object& definition) {
  const auto client = std::make_shared<const PythonAlgorithm>(algorithm_of(definition));
  AlgorithmDefinition server;
  if (!definition["server"].is_none()) {
    server = std::make_shared<const PythonAlgorithm>(algorithm_of(definition["server"]));
  }
  replace_algorithm<HostSyncEntry>(
      {.info = client->info, .make = [client, server](const Parameters& parameters) {
         return std::make_unique<PythonHostSync>(client, server, parameters);
       }});
}

}  // namespace simbench::python

// host_sync in Python: `async def` functions for the slaves and, if it has one, for the master.
//
// A C++ coroutine drives each: it lets Python run until that awaits an operation of its host, then
// awaits the operation itself, without the interpreter's lock, and sends back its value or raises
// its error there.
#include "algorithms/ports/host_sync.h"

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/host_sync/join.h"
#include "algorithms/registry.h"
#include "clocks/disciplined_clock.h"
#include "python/src/algorithms.h"
#include "python/src/host_requests.h"
#include "python/src/python_algorithm.h"

namespace simbench::python {
namespace {

using Definition = std::shared_ptr<const PythonAlgorithm>;
using Port = std::shared_ptr<HostPort>;

// The port has no host once the coroutine that has it has ended.
class PortOfRun {
 public:
  PortOfRun(Host& host, std::set<PeerId> peers)
      : port_(std::make_shared<HostPort>(host, std::move(peers))) {}
  PortOfRun(const PortOfRun&) = delete;
  PortOfRun& operator=(const PortOfRun&) = delete;
  ~PortOfRun() { port_->host = nullptr; }
  const Port& get() const { return port_; }

 private:
  Port port_;
};

// What Python awaits next; nothing once it has returned.
using Next = std::optional<HostRequest>;

class PythonCoroutine {
 public:
  // function(host, [client,] settings), with the function by its name in the definition.
  PythonCoroutine(Definition algorithm, Port port, const Parameters& parameters,
                  std::optional<PeerId> client)
      : algorithm_(std::move(algorithm)), port_(std::move(port)) {
    const py::gil_scoped_acquire gil;
    const py::dict settings = keywords_of(*algorithm_, parameters);
    PyObject* const made = PyObject_CallFunctionObjArgs(
        algorithm_->make.get(), py::cast(port_).ptr(), settings.ptr(),
        (client ? py::object(py::int_(*client)) : py::object(py::none())).ptr(), nullptr);
    if (made == nullptr) throw_python_failure(*algorithm_);
    coroutine_ = shared(py::reinterpret_steal<py::object>(made));
  }

  // Lets Python go on with the answer to what it awaited.
  Next go_on(const HostAnswer& answer) {
    const py::gil_scoped_acquire gil;
    return next_after([&] { return sent(python_value(answer)); });
  }

  // Lets it go on with an error.
  Next fail(const std::string& what) {
    const py::gil_scoped_acquire gil;
    const py::object type = py::reinterpret_borrow<py::object>(PyExc_ValueError);
    return next_after([&] { return thrown(type(what)); });
  }

 private:
  // A request that is none is an error where Python awaits it, which it may handle.
  template <class Resume>
  Next next_after(const Resume& resume) {
    std::optional<py::object> yielded = resume();
    for (int refused = 0; yielded; ++refused) {
      try {
        return host_request(*yielded, *port_);
      } catch (py::error_already_set& error) {
        yielded = thrown(error.value());
      } catch (const py::builtin_exception& error) {
        error.set_error();
        yielded = thrown(py::error_already_set().value());
      } catch (const std::exception& error) {
        const py::object type = py::reinterpret_borrow<py::object>(PyExc_ValueError);
        yielded = thrown(type(error.what()));
      }
      constexpr int kMostRefused = 1000;
      if (refused > kMostRefused) throw_misuse(*algorithm_, "awaits no operation again and again");
    }
    return std::nullopt;
  }

  std::optional<py::object> sent(const py::object& value) {
    PyObject* result = nullptr;
    const PySendResult outcome = PyIter_Send(coroutine_.get(), value.ptr(), &result);
    if (outcome == PYGEN_ERROR) throw_python_failure(*algorithm_);
    py::object owned = py::reinterpret_steal<py::object>(result);
    if (outcome == PYGEN_RETURN) return std::nullopt;
    return owned;
  }

  std::optional<py::object> thrown(const py::object& exception) {
    PyObject* const result = PyObject_CallMethod(coroutine_.get(), "throw", "O", exception.ptr());
    if (result != nullptr) return py::reinterpret_steal<py::object>(result);
    if (PyErr_ExceptionMatches(PyExc_StopIteration) == 0) throw_python_failure(*algorithm_);
    PyErr_Clear();
    return std::nullopt;
  }

  Definition algorithm_;
  Port port_;
  SharedObject coroutine_;
};

Task<void> drive(Definition algorithm, Port port, Parameters parameters,
                 std::optional<PeerId> client) {
  PythonCoroutine coroutine(algorithm, port, parameters, client);
  Next next = coroutine.go_on(std::monostate{});
  while (next) {
    HostAnswer answer;
    std::string refused;
    try {
      answer = co_await answered(std::move(*next), port);
    } catch (const clocks::ClockError& error) {
      refused = error.what();
    }
    next = refused.empty() ? coroutine.go_on(answer) : coroutine.fail(refused);
  }
}

class PythonHostSync final : public HostSync {
 public:
  PythonHostSync(Definition client, Definition server, const Parameters& parameters)
      : client_(std::move(client)), server_(std::move(server)), parameters_(parameters) {
    const py::gil_scoped_acquire gil;
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

  Definition client_;
  Definition server_;  // null: the answerer
  Parameters parameters_;
  std::optional<Nanoseconds> warm_up_;
};

}  // namespace

void register_python_host_sync(const py::dict& definition) {
  const auto client = std::make_shared<const PythonAlgorithm>(algorithm_of(definition));
  Definition server;
  if (!definition["server"].is_none()) {
    server = std::make_shared<const PythonAlgorithm>(
        algorithm_of(definition["server"].cast<py::dict>()));
  }
  replace_host_sync({.info = client->info, .make = [client, server](const Parameters& parameters) {
                       return std::make_unique<PythonHostSync>(client, server, parameters);
                     }});
}

}  // namespace simbench::python

#include "python/src/python_coroutine.h"

#include <exception>
#include <string>
#include <utility>

#include "clocks/disciplined_clock.h"

namespace simbench::python {
namespace {

// What Python awaits next; nothing once it has returned.
using Next = std::optional<HostRequest>;

class PythonCoroutine {
 public:
  PythonCoroutine(AlgorithmDefinition algorithm, SharedPort port, const Parameters& parameters,
                  std::optional<std::uint32_t> number)
      : algorithm_(std::move(algorithm)), port_(std::move(port)) {
    const py::gil_scoped_acquire gil;
    const py::dict settings = keywords_of(*algorithm_, parameters);
    PyObject* const made = PyObject_CallFunctionObjArgs(
        algorithm_->make.get(), py::cast(port_).ptr(), settings.ptr(),
        (number ? py::object(py::int_(*number)) : py::object(py::none())).ptr(), nullptr);
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

  AlgorithmDefinition algorithm_;
  SharedPort port_;
  SharedObject coroutine_;
};

}  // namespace

PortOfRun::PortOfRun(Host& host, std::set<PeerId> peers, Transport datagrams)
    : port_(std::make_shared<HostPort>(host, std::move(peers), datagrams)) {}

PortOfRun::~PortOfRun() { port_->host = nullptr; }

Task<void> drive(AlgorithmDefinition algorithm, SharedPort port, Parameters parameters,
                 std::optional<std::uint32_t> number) {
  PythonCoroutine coroutine(algorithm, port, parameters, number);
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

}  // namespace simbench::python

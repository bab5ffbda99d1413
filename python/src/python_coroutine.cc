#include "python/src/python_coroutine.h"

#include <exception>
#include <string>
#include <utility>

#include "clocks/disciplined_clock.h"
#include "python/src/binding.h"

namespace simbench::python {
namespace {

// What Python awaits next; nothing once it has returned.
using Next = std::optional<HostRequest>;

class PythonCoroutine {
 public:
  PythonCoroutine(AlgorithmDefinition algorithm, SharedPort port, const Parameters& parameters,
                  std::optional<std::uint32_t> number)
      : algorithm_(std::move(algorithm)), port_(std::move(port)) {
    const WithGil gil;
    try {
      coroutine_ = shared(Object::borrowed(algorithm_->make.get())(
          port_, keywords_of(*algorithm_, parameters), number));
    } catch (const PythonError& raised) {
      throw_python_failure(*algorithm_, raised);
    }
  }

  // Lets Python go on with the answer to what it awaited.
  Next go_on(const HostAnswer& answer) {
    const WithGil gil;
    return next_after([&] { return sent(python_value(answer)); });
  }

  // Lets it go on with an error.
  Next fail(const std::string& what) {
    const WithGil gil;
    return next_after([&] { return thrown(value_error(what)); });
  }

 private:
  // A request that is none is an error where Python awaits it, which it may handle.
  template <class Resume>
  Next next_after(const Resume& resume) {
    std::optional<Object> yielded = resume();
    for (int refused = 0; yielded; ++refused) {
      try {
        return host_request(*yielded, *port_);
      } catch (const PythonError& error) {
        yielded = thrown(error.exception());
      } catch (const std::exception& error) {
        yielded = thrown(value_error(error.what()));
      }
      constexpr int kMostRefused = 1000;
      if (refused > kMostRefused) throw_misuse(*algorithm_, "awaits no operation again and again");
    }
    return std::nullopt;
  }

  static Object value_error(const std::string& what) {
    return Object::borrowed(PyExc_ValueError)(what);
  }

  std::optional<Object> sent(const Object& value) {
    static const SharedObject name = shared(Object::owned(PyUnicode_InternFromString("send")));
    return resumed(name, value);
  }
  std::optional<Object> thrown(const Object& exception) {
    static const SharedObject name = shared(Object::owned(PyUnicode_InternFromString("throw")));
    return resumed(name, exception);
  }

  // What Python awaits then; nothing if it has returned.
  std::optional<Object> resumed(const SharedObject& method, const Object& value) {
    PyObject* const result =
        PyObject_CallMethodObjArgs(coroutine_.get(), method.get(), value.get(), nullptr);
    if (result != nullptr) return Object::owned(result);
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

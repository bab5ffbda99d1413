// A value that is made when it is first asked for, because most of its owners are never asked.
//
// Copies share the value, which is made once; several threads may ask at the same time. What `make`
// throws reaches whoever asks, and the next one tries again.
//
//   const Lazy<std::string> text([] { return camera_profiles_json(); });
//   std::cout << text();
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace simbench::scenarios {

template <class Value>
class Lazy {
 public:
  explicit Lazy(std::function<Value()> make) : state_(std::make_shared<State>(std::move(make))) {}
  explicit Lazy(Value value) : Lazy([value = std::move(value)] { return value; }) {}
  Lazy() : Lazy(Value()) {}

  const Value& operator()() const {
    std::call_once(state_->once, [this] { state_->value.emplace(state_->make()); });
    return *state_->value;
  }

 private:
  struct State {
    explicit State(std::function<Value()> maker) : make(std::move(maker)) {}
    std::function<Value()> make;
    std::once_flag once;
    std::optional<Value> value;
  };
  std::shared_ptr<State> state_;
};

}  // namespace simbench::scenarios

// A reader in a test: keeps what it is sent, and goes when it is told to.
#pragma once

#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "server/request.h"

namespace simbench::explore {

class KeptStream final : public server::PageStream {
 public:
  void send(std::string text) override {
    const std::lock_guard lock(mutex_);
    if (!closed_) text_ += text;
  }
  void end() override {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  bool is_closed() const override {
    const std::lock_guard lock(mutex_);
    return closed_;
  }
  std::size_t waiting_bytes() const override { return 0; }
  void when_closed(std::function<void()> action) override {
    {
      const std::lock_guard lock(mutex_);
      if (!closed_) {
        actions_.push_back(std::move(action));
        return;
      }
    }
    action();
  }

  void close() {
    std::vector<std::function<void()>> actions;
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
      actions.swap(actions_);
    }
    for (const auto& action : actions) action();
  }
  bool has_ended() const {
    const std::lock_guard lock(mutex_);
    return ended_;
  }
  std::string text() const {
    const std::lock_guard lock(mutex_);
    return text_;
  }
  std::vector<nlohmann::json> events() const {
    std::vector<nlohmann::json> events;
    std::istringstream lines(text());
    for (std::string line; std::getline(lines, line);) {
      events.push_back(nlohmann::json::parse(line));
    }
    return events;
  }

 private:
  mutable std::mutex mutex_;
  std::string text_;
  bool ended_ = false;
  bool closed_ = false;
  std::vector<std::function<void()>> actions_;
};

}  // namespace simbench::explore

// Keeps a library's warnings off standard error: Poisson reconstruction warns of single degenerate
// cells, in the middle of a progress line.
//
// While a QuietErrors lives, it drops what a thread writes to std::cerr inside a QuietErrors::Scope
// and passes on everything else. One at a time in a process, made and destroyed while no other
// thread writes.
//
//   const QuietErrors quiet;
//   ... in any thread: { const QuietErrors::Scope scope; library_call(); }
#pragma once

#include <iostream>
#include <streambuf>

namespace simbench::reconstruction {

class QuietErrors {
 public:
  class Scope {
   public:
    Scope() { ++depth(); }
    ~Scope() { --depth(); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
  };

  QuietErrors() : filter_(std::cerr.rdbuf()) { std::cerr.rdbuf(&filter_); }
  ~QuietErrors() { std::cerr.rdbuf(filter_.next()); }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  static int& depth() {
    thread_local int scopes = 0;
    return scopes;
  }

  class Filter final : public std::streambuf {
   public:
    explicit Filter(std::streambuf* next) : next_(next) {}
    std::streambuf* next() const { return next_; }

   private:
    int overflow(int c) override {
      if (depth() > 0 || traits_type::eq_int_type(c, traits_type::eof())) {
        return traits_type::not_eof(c);
      }
      return next_->sputc(traits_type::to_char_type(c));
    }
    std::streamsize xsputn(const char* text, std::streamsize size) override {
      return depth() > 0 ? size : next_->sputn(text, size);
    }
    int sync() override { return next_->pubsync(); }

    std::streambuf* next_;
  };

  Filter filter_;
};

}  // namespace simbench::reconstruction

// Every kind of file and argument that the command line reads, each with good examples and the
// commands that read it.
//
//   Inputs inputs(folder);          // runs simbench to make recordings and archives
//   Attempt attempt = inputs.next(random);
//   Ending ending = call({.arguments = attempt.arguments});
//   inputs.restore(attempt);
#pragma once

#include <string>
#include <vector>

#include "tests/robustness/random.h"

namespace simbench::robustness {

// A command line whose input is damaged.
struct Attempt {
  std::string kind;
  std::vector<std::string> arguments;
  std::string file;   // the damaged file; empty: an argument is damaged
  std::string input;  // its text, or that argument
};

class Inputs {
 public:
  // Makes the examples below `folder`. Throws std::runtime_error.
  explicit Inputs(std::string folder);

  // Damages a file or an argument.
  Attempt next(Random& random);
  // A good command line with good files.
  Attempt undamaged(Random& random) const;
  // Writes the good file again, and removes what the command has written.
  void restore(const Attempt& attempt);

  const std::string& folder() const { return folder_; }

 private:
  // The files that are damaged, and the commands, in which % is the damaged file and @ the folder.
  // A kind without files has commands whose arguments are damaged.
  struct Kind {
    std::string name;
    std::size_t share;  // of the attempts: small for commands that take long
    std::vector<std::string> files;
    std::vector<std::vector<std::string>> commands;
  };

  void add(Kind kind) { kinds_.push_back(std::move(kind)); }
  const Kind& any_kind(Random& random) const;
  void copy(const std::string& from, const std::string& to) const;
  void make(const std::vector<std::string>& arguments) const;
  std::vector<std::string> files_of(const std::string& below) const;
  std::vector<std::string> resolved(std::vector<std::string> command,
                                    const std::string& file) const;
  void add_files();
  void add_forms();
  void add_bags();
  void check_forms() const;
  void add_archives();
  void add_clock_archive();
  void add_arguments();

  std::string folder_;
  std::vector<Kind> kinds_;
};

}  // namespace simbench::robustness

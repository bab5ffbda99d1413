#include "app/own_program.h"

#include <utility>

namespace simbench::app {
namespace {

OwnProgram& current() {
  static OwnProgram program;
  return program;
}

}  // namespace

void set_own_program(OwnProgram program) { current() = std::move(program); }

const OwnProgram& own_program() { return current(); }

}  // namespace simbench::app

#include "cli/rig_backend.h"

#include <unistd.h>

#include <iostream>

#include "app/interrupt.h"
#include "cli/embedding.h"

namespace simbench::cli {
namespace {

// Enter is yes; the end of input, or no terminal of its own, is no.
bool ask_at_terminal(const std::string& text) {
  if (isatty(STDIN_FILENO) == 0 || embedding() != nullptr) return false;
  std::cerr << text << ", then press Enter: " << std::flush;
  std::string line;
  return static_cast<bool>(std::getline(std::cin, line));
}

}  // namespace

void add_backend_options(Command& command, BackendOptions& options) {
  command.word("--backend", "TEXT", options.backend, {"sim", "hardware"},
               "Where to run: in the simulator (sim), or on a real rig whose hosts run\n"
               "`simbench node` (hardware). Default: sim");
  command.text("--rig", "FILE", options.rig, "The rig file (with --backend hardware)");
  command.text("--key-file", "FILE", options.key_file,
               "The key of the rig's nodes (see `simbench keygen`);\n"
               "without one only nodes on this machine can be reached");
}

bool is_hardware(const BackendOptions& options) {
  const bool hardware = options.backend == "hardware";
  if (hardware && options.rig.empty()) {
    throw scenarios::InputError("--backend hardware: needs --rig FILE");
  }
  if (!hardware && (!options.rig.empty() || !options.key_file.empty())) {
    throw scenarios::InputError("--rig and --key-file: only with --backend hardware");
  }
  return hardware;
}

hardware::SecretKey key_of(const std::string& key_file) {
  try {
    return key_file.empty() ? hardware::SecretKey() : hardware::SecretKey::from_file(key_file);
  } catch (const hardware::KeyError& error) {
    throw scenarios::InputError(error.what());
  }
}

std::unique_ptr<hardware::RigSource> make_rig_source(const BackendOptions& options,
                                                     const scenarios::Scenario& scenario) {
  hardware::RigSourceSettings settings;
  settings.progress = [](const std::string& line) { print_note(line); };
  settings.prompt = ask_at_terminal;
  settings.cancelled = [] { return app::InterruptHandler::raised(); };
  settings.collect_session = options.collect_session;
  return std::make_unique<hardware::RigSource>(
      hardware::load_rig(options.rig), key_of(options.key_file), scenario, std::move(settings));
}

}  // namespace simbench::cli

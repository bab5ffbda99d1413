// The options of commands that can run on a real rig instead of in the simulator, and the rig as a
// RecordingSource (hardware/conductor/rig_source.h) that prompts the user of the command line.
//
//   BackendOptions backend;
//   add_backend_options(command, backend);
//   if (is_hardware(backend)) source = make_rig_source(backend, scenario);
#pragma once

#include <memory>
#include <string>

#include "cli/command.h"
#include "hardware/conductor/rig_source.h"
#include "hardware/net/secret_key.h"
#include "hardware/rig/rig.h"
#include "scenarios/scenario.h"

namespace simbench::cli {

struct BackendOptions {
  std::string backend = "sim";
  std::string rig;
  std::string key_file;
  std::string collect_session;  // empty: a new capture
};

// --backend, --rig, --key-file.
void add_backend_options(Command& command, BackendOptions& options);

// Throws scenarios::InputError: hardware without a rig, a rig without hardware.
bool is_hardware(const BackendOptions& options);

// The key of --key-file; if it is empty, the key that stands in for a missing one.
// Throws scenarios::InputError.
hardware::SecretKey key_of(const std::string& key_file);

// Steps become notes; a prompt at the terminal asks the user to switch a manual trigger; Ctrl-C
// stops the cameras. Throws scenarios::InputError.
std::unique_ptr<hardware::RigSource> make_rig_source(const BackendOptions& options,
                                                     const scenarios::Scenario& scenario);

}  // namespace simbench::cli

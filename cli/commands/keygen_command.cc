#include "cli/commands/keygen_command.h"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "cli/exit_status.h"
#include "hardware/net/secret_key.h"

namespace simbench::cli {
namespace {

constexpr const char* kKeygenExamples = R"(
Nodes and the command that conducts them speak only to holders of the same key. Who has it may set
the rig's clocks and start its captures: keep it as you keep a password. Without a key a node speaks
to its own machine only.

Examples:
  simbench keygen rig.key
  scp -p rig.key host3:                     to each host of the rig
  simbench node --rig rig.json --name host3 --key-file rig.key)";

int make_key(const std::string& file) {
  try {
    hardware::SecretKey::create_file(file);
  } catch (const hardware::KeyError& error) {
    print_error(error.what());
    return kBadInput;
  }
  print_result(fmt::format(
      "{}: a new key, readable by you only\n"
      "Copy it to every host of the rig over a safe way (scp -p), and name it there and "
      "here with --key-file.\n",
      file));
  return kOk;
}

}  // namespace

void add_keygen_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("keygen", "Make the key that the hosts of a rig share");
  auto file = std::make_shared<std::string>();
  command->add_option("file", *file, "Where to write it; a file that is there is not overwritten")
      ->type_name("FILE")
      ->required();
  add_json_messages_option(*command);
  command->footer(kKeygenExamples);
  command->callback([file, &action] { action = [file] { return make_key(*file); }; });
}

}  // namespace simbench::cli

#include <fmt/format.h>

#include <memory>
#include <string>

#include "cli/command.h"
#include "cli/commands/commands.h"
#include "hardware/net/secret_key.h"

namespace simbench::cli {
namespace {

constexpr const char* kKeygenExamples = R"(
Nodes and the command that conducts them speak only to holders of the same key. It permits to set
the rig's clocks and to start its captures: keep it like a password. Without a key a node speaks to
its own machine only.

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
      "Copy it to every host of the rig in a safe way (scp -p), and pass it there and here "
      "with --key-file.\n",
      file));
  return kOk;
}

}  // namespace

void add_keygen_command(CommandLine& line) {
  auto file = std::make_shared<std::string>();
  Command command(line, "keygen", "Make the key that the hosts of a rig share");
  command.output("file", "FILE", *file, "Where to write it; an existing file is not overwritten")
      .required();
  command.json_messages();
  command.footer(kKeygenExamples);
  command.runs([file] { return make_key(*file); });
}

}  // namespace simbench::cli

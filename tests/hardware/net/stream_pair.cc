#include "tests/hardware/net/stream_pair.h"

#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

namespace simbench::hardware {

SecretKey key_from_digit(char digit) {
  std::string name = (std::filesystem::temp_directory_path() / "simbench_key_XXXXXX").string();
  const int file = mkstemp(name.data());
  const std::string text = std::string(2 * SecretKey::kBytes, digit) + "\n";
  const bool written =
      file >= 0 && write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (file >= 0) close(file);
  if (!written) throw std::runtime_error("cannot write " + name);
  SecretKey key = SecretKey::from_file(name);
  std::filesystem::remove(name);
  return key;
}

StreamPair stream_pair(boost::asio::io_context& context, SecretKey key) {
  Listener listener(context);
  Running accepted(context, listener.accept(key, PeerName{0}));
  Running connected(context, listener.connect(key, PeerName{1}));
  StreamPair pair;
  pair.connected = connected.get();
  pair.accepted = accepted.get();
  return pair;
}

}  // namespace simbench::hardware

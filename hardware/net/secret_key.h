// The key that the nodes of a rig share, and its file.
//
// 32 random bytes, in the file as 64 hexadecimal digits and a newline. The key permits to set the
// rig's clocks and to start its captures, so the file must be a regular file without rights for
// group or others, owned by the user who runs the program or by root.
// Without a key a node speaks to its own machine only (rig/rig.h); messages are then sealed under a
// public key, which detects damage but authenticates nobody.
//
// Errors: KeyError; the message names the file, what was found and the command that mends it.
//
//   SecretKey key = SecretKey::from_file("rig.key");
//   SecretKey::create_file("rig.key");        // simbench keygen
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace simbench::hardware {

class KeyError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class SecretKey {
 public:
  static constexpr std::size_t kBytes = 32;

  // The public key that stands in for a missing one.
  SecretKey() = default;
  static SecretKey from_file(const std::string& path);
  // Writes a new key with mode 0600. Throws KeyError if the file exists: a key is not overwritten.
  static void create_file(const std::string& path);

  bool is_secret() const { return secret_; }
  const std::array<unsigned char, kBytes>& bytes() const { return bytes_; }

 private:
  std::array<unsigned char, kBytes> bytes_{};
  bool secret_ = false;
};

}  // namespace simbench::hardware

// The key that the nodes of a rig share, and its file.
//
// 32 random bytes, in the file as 64 hexadecimal digits and a newline. Who has it may set the rig's
// clocks and start its captures, so the file must be its owner's alone (no rights for group or
// others), a regular file, and owned by the user who runs the program or by root.
// Without a key a node speaks to its own machine only (rig/rig.h); messages are then sealed under a
// key that everybody knows, which keeps damage out but nobody else.
//
// Errors: KeyError, whose message names the file, what was found and the command that mends it.
//
//   SecretKey key = SecretKey::from_file("rig.key");
//   SecretKey::create_file("rig.key");        // simbench keygen
#ifndef SIMBENCH_HARDWARE_NET_SECRET_KEY_H_
#define SIMBENCH_HARDWARE_NET_SECRET_KEY_H_

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

  // The key of those who have none.
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

#endif  // SIMBENCH_HARDWARE_NET_SECRET_KEY_H_

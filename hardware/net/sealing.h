// How bytes are sealed, and where the keys for it come from: the one place that calls libsodium's
// ciphers.
//
// Sealed with ChaCha20-Poly1305 (RFC 8439): encrypted, and refused by open() if a bit of it, of the
// header, of the counter or of the key differs. The counter is the nonce: a key must never seal two
// messages under one counter, so keys are derived anew for every connection and direction.
// Keys are derived with BLAKE2b (RFC 7693), keyed with the key they come from.
//
//   const KeyBytes key = derive_key(secret, "datagrams", transcript);
//   Bytes sealed = seal(key, counter++, header, message);
//   std::optional<Bytes> opened = open_sealed(key, counter, header, sealed);
#ifndef SIMBENCH_HARDWARE_NET_SEALING_H_
#define SIMBENCH_HARDWARE_NET_SEALING_H_

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "algorithms/ports/host.h"
#include "hardware/net/secret_key.h"

namespace simbench::hardware {

using KeyBytes = std::array<unsigned char, SecretKey::kBytes>;

// What a seal adds to the length of a message.
inline constexpr std::size_t kSealBytes = 16;

// Prepares libsodium, once; what is below and SecretKey call it by themselves.
void start_sodium();

void fill_random(std::span<std::byte> bytes);
KeyBytes derive_key(const KeyBytes& key, std::string_view purpose,
                    std::span<const std::byte> context);

// `header` is not in what is sealed, but is protected by it.
//
// The header and, behind it, the sealed message.
Bytes header_and_sealed(const KeyBytes& key, std::uint64_t counter,
                        std::span<const std::byte> header, std::span<const std::byte> message);
// The sealed message alone.
Bytes seal(const KeyBytes& key, std::uint64_t counter, std::span<const std::byte> header,
           std::span<const std::byte> message);
// Nothing if it was not sealed like this.
std::optional<Bytes> open_sealed(const KeyBytes& key, std::uint64_t counter,
                                 std::span<const std::byte> header,
                                 std::span<const std::byte> sealed);

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NET_SEALING_H_

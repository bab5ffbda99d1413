#include "hardware/net/wire.h"

#include <sodium.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace simbench::hardware {
namespace {

constexpr std::string_view kMagic = "simbench";

static_assert(kSealBytes == crypto_aead_chacha20poly1305_ietf_ABYTES);
static_assert(SecretKey::kBytes == crypto_aead_chacha20poly1305_ietf_KEYBYTES);

using NonceBytes = std::array<unsigned char, crypto_aead_chacha20poly1305_ietf_NPUBBYTES>;

NonceBytes nonce_of(std::uint64_t counter) {
  NonceBytes nonce{};
  put_number(std::as_writable_bytes(std::span(nonce)).last(sizeof counter), counter);
  return nonce;
}

const unsigned char* plain(std::span<const std::byte> bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

}  // namespace

void start_sodium() {
  static const int started = sodium_init();
  if (started < 0) throw std::runtime_error("libsodium: no source of random numbers was found");
}

void fill_random(std::span<std::byte> bytes) {
  start_sodium();
  randombytes_buf(bytes.data(), bytes.size());
}

KeyBytes derive_key(const KeyBytes& key, std::string_view purpose,
                    std::span<const std::byte> context) {
  start_sodium();
  KeyBytes derived{};
  crypto_generichash_state state;
  crypto_generichash_init(&state, key.data(), key.size(), derived.size());
  // With a closing zero, so that purpose and context cannot run into each other.
  crypto_generichash_update(&state, reinterpret_cast<const unsigned char*>(purpose.data()),
                            purpose.size());
  constexpr unsigned char kEnd = 0;
  crypto_generichash_update(&state, &kEnd, 1);
  crypto_generichash_update(&state, plain(context), context.size());
  crypto_generichash_final(&state, derived.data(), derived.size());
  return derived;
}

Bytes header_and_sealed(const KeyBytes& key, std::uint64_t counter,
                        std::span<const std::byte> header, std::span<const std::byte> message) {
  Bytes all(header.size() + message.size() + kSealBytes);
  std::copy(header.begin(), header.end(), all.begin());
  const NonceBytes nonce = nonce_of(counter);
  crypto_aead_chacha20poly1305_ietf_encrypt(
      reinterpret_cast<unsigned char*>(all.data()) + header.size(), nullptr, plain(message),
      message.size(), plain(header), header.size(), nullptr, nonce.data(), key.data());
  return all;
}

std::optional<Bytes> open_sealed(const KeyBytes& key, std::uint64_t counter,
                                 std::span<const std::byte> header,
                                 std::span<const std::byte> sealed) {
  if (sealed.size() < kSealBytes) return std::nullopt;
  const NonceBytes nonce = nonce_of(counter);
  Bytes message(sealed.size() - kSealBytes);
  const int broken = crypto_aead_chacha20poly1305_ietf_decrypt(
      reinterpret_cast<unsigned char*>(message.data()), nullptr, nullptr, plain(sealed),
      sealed.size(), plain(header), header.size(), nonce.data(), key.data());
  if (broken != 0) return std::nullopt;
  return message;
}

Hello fresh_hello(PeerName me) {
  Hello hello{.from = me};
  fill_random(hello.random);
  return hello;
}

std::array<std::byte, kHelloBytes> write_hello(const Hello& hello) {
  std::array<std::byte, kHelloBytes> bytes{};
  const std::span<std::byte> all(bytes);
  std::memcpy(bytes.data(), kMagic.data(), kMagic.size());
  put_number(all.subspan(8, 2), hello.version);
  put_number(all.subspan(10, 4), hello.from.host);
  std::copy(hello.random.begin(), hello.random.end(), bytes.begin() + 14);
  return bytes;
}

std::optional<std::uint16_t> hello_version(std::span<const std::byte, kHelloStartBytes> start) {
  if (std::memcmp(start.data(), kMagic.data(), kMagic.size()) != 0) return std::nullopt;
  return static_cast<std::uint16_t>(number_in(start.subspan(8, 2)));
}

Hello read_hello(std::span<const std::byte, kHelloBytes> bytes) {
  Hello hello;
  hello.version = static_cast<std::uint16_t>(number_in(bytes.subspan(8, 2)));
  hello.from.host = static_cast<std::uint32_t>(number_in(bytes.subspan(10, 4)));
  std::copy(bytes.begin() + 14, bytes.end(), hello.random.begin());
  return hello;
}

}  // namespace simbench::hardware

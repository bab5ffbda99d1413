#include "bench/hostile_flood.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/ip.h>
#include <netinet/udp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

namespace simbench {
namespace {

using Payload = std::vector<unsigned char>;
constexpr std::size_t kKept = 256;        // genuine datagrams, the newest
constexpr std::size_t kCounterByte = 10;  // hardware/net/datagram.h

// What goes from the peer to the target, off the wire.
void listen_in(int socket, const FloodPlan& plan, std::vector<Payload>& genuine) {
  std::array<unsigned char, 2048> packet{};
  for (;;) {
    const ssize_t size = recv(socket, packet.data(), packet.size(), MSG_DONTWAIT);
    if (size <= 0) return;
    const std::size_t header = (packet[0] & 0x0fU) * 4;
    udphdr udp{};
    if (static_cast<std::size_t>(size) <= header + sizeof udp) continue;
    std::memcpy(&udp, packet.data() + header, sizeof udp);
    if (ntohs(udp.dest) != plan.target_port || ntohs(udp.source) != plan.pretended_port) continue;
    if (udp.check == 0) continue;  // one of our own, which bear no checksum
    if (genuine.size() == kKept) genuine.erase(genuine.begin());
    genuine.emplace_back(packet.begin() + static_cast<std::ptrdiff_t>(header + sizeof udp),
                         packet.begin() + size);
  }
}

void send_hostile(int socket, const FloodPlan& plan, const Payload& payload) {
  std::vector<unsigned char> packet(sizeof(udphdr) + payload.size());
  udphdr udp{};
  udp.source = htons(plan.pretended_port);
  udp.dest = htons(plan.target_port);
  udp.len = htons(static_cast<std::uint16_t>(packet.size()));
  std::memcpy(packet.data(), &udp, sizeof udp);
  if (!payload.empty()) std::memcpy(packet.data() + sizeof udp, payload.data(), payload.size());
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  sendto(socket, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to),
         sizeof to);
}

Payload hostile(const Payload& genuine, int kind) {
  Payload payload = genuine;
  switch (kind) {
    case 0:
      // A counter of the far future, or the seal would never be looked at.
      if (payload.size() > kCounterByte) payload[kCounterByte] ^= 1U;
      break;
    case 1:
      break;
    case 2:
      payload.resize(payload.size() / 2);
      break;
    default:
      payload.assign(60'000, 0xa5);
      break;
  }
  return payload;
}

[[noreturn]] void flood(int socket, const FloodPlan& plan) {
  const auto begin = std::chrono::steady_clock::now();
  std::vector<Payload> genuine;
  const int all = plan.per_second * plan.seconds;
  // Replays of what the session has long moved past would be refused for their age alone: the
  // newest are sent again.
  for (int i = 0; i < all; ++i) {
    std::this_thread::sleep_until(begin +
                                  std::chrono::microseconds(1'000'000LL * i / plan.per_second));
    listen_in(socket, plan, genuine);
    // Oversized ones are one in a hundred: 2,500 a second of them would fill the loopback itself.
    const int kind = i % 100 == 99 ? 3 : i % 3;
    if (!genuine.empty()) send_hostile(socket, plan, hostile(genuine.back(), kind));
  }
  std::_Exit(0);
}

}  // namespace

pid_t start_hostile_flood(const FloodPlan& plan) {
  const int raw = socket(AF_INET, SOCK_RAW, IPPROTO_UDP);
  if (raw < 0) return -1;
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    flood(raw, plan);
  }
  close(raw);
  return child;
}

}  // namespace simbench

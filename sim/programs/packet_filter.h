// Classic BPF: the filters that programs attach to their sockets (SO_ATTACH_FILTER), as ptp4l does
// over Ethernet, DHCP clients and what libpcap compiles.
//
// A program of instructions looks at a packet and says how many of its bytes may pass, 0: none.
// check() accepts what Linux accepts but for three of its extensions (netlink attributes, the
// payload's offset, chance). A load beyond the packet and a division by zero drop it.
//
// Source: Linux, Documentation/networking/filter.rst and net/core/filter.c (bpf_check_classic(),
// convert_bpf_extensions()); McCanne and Jacobson 1993, "The BSD Packet Filter".
//
//   // The frames of PTP: Ethertype 0x88F7 at byte 12.
//   const std::vector<sock_filter> code = {BPF_STMT(BPF_LD | BPF_H | BPF_ABS, 12),
//                                          BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 0x88F7, 0, 1),
//                                          BPF_STMT(BPF_RET | BPF_K, 0xFFFF),
//                                          BPF_STMT(BPF_RET | BPF_K, 0)};
//   const Bytes frame(60);
//   if (PacketFilter::check(code) == 0) use(PacketFilter(code).passed({.bytes = frame}));  // 0
#pragma once

#include <linux/filter.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace simbench::sim {

// A packet as a filter sees it.
struct SeenPacket {
  std::span<const std::byte> bytes{};
  // Where in it the filter's offsets count from, the network's head begins, and the link's.
  std::size_t begin = 0;
  std::size_t network_head = 0;
  std::size_t link_head = 0;
  std::uint16_t protocol = 0;  // the Ethertype
  std::uint8_t kind = 0;       // PACKET_HOST, ...
  std::uint32_t interface = 0;
  std::uint16_t hardware = 1;  // ARPHRD_...
};

class PacketFilter {
 public:
  // All pass.
  PacketFilter() = default;
  // `code` must have passed check().
  explicit PacketFilter(std::vector<sock_filter> code) : code_(std::move(code)) {}

  // 0, or EINVAL.
  static int check(std::span<const sock_filter> code);

  bool is_set() const { return !code_.empty(); }
  // How many bytes pass, from the filter's beginning on.
  std::size_t passed(const SeenPacket& packet) const;

 private:
  std::vector<sock_filter> code_;
};

}  // namespace simbench::sim

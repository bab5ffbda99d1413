// What a program in the simulated world says to it, and what the world answers.
//
// Each thread of each process has a socket to the world of its own (SOCK_SEQPACKET); the number of
// a program's first is in the environment variable kLinkVariable. The shim sends a request and
// waits for its reply; time stands still until a thread asks for something that takes time. The
// world replies to one thread at a time and then waits for what that asks next, so that one runs
// at a time. Both ends are one machine: integers are in its byte order, and struct timex is the
// kernel's, as are struct pps_kparams and
// pps_kinfo.
//
// A new thread or process is announced (kNewThread, kNewProcess) with the world's end of its link,
// and is stopped at its first request, kHello, until its turn has come. A process has a copy of
// its parent's descriptors, as with fork().
//
// A request or reply is its struct, then `size` bytes of data. Descriptors have numbers that the
// shim gives them, the program's own if it has no duplicates. Times are nanoseconds. `error` is an
// errno, or 0.
//
// A program may have a world of which nothing but the clock is the world's: a real host's node
// serves it (hardware/node/program_clock.h). Identity::only_clock says so; the program then has a
// page of memory in which it reads the clock (shim/clock_page.h), and asks for kHello, kSetClock,
// kAdjustClock and kNote only.
//
// Untrusted: the world checks every number of a request (processes/requests.h).
#pragma once

#include <cstddef>
#include <cstdint>

namespace simbench::shim {

inline constexpr char kLinkVariable[] = "SIMBENCH_LINK";
// What a program that was started by another has of its descriptors: "fd:kind:number ...".
inline constexpr char kDescriptorsVariable[] = "SIMBENCH_DESCRIPTORS";
inline constexpr char kFolderVariable[] = "SIMBENCH_FOLDER";
// The time of day at which worlds begin: the beginning of 2028, ns. Programs refuse times before
// they were built, and OpenNTPD those from 2030 on.
inline constexpr std::int64_t kWorldBegin = 1'830'297'600'000'000'000;
// What a program sees its host's folder as (shim/paths.h).
inline constexpr char kFolder[] = "/files";
// The largest datagram, and what is said of it.
inline constexpr std::size_t kMostData = 65536 + 512;
// The descriptor of the clock's page, where only the clock is the world's.
inline constexpr int kClockPage = 201;

enum class Call : std::uint32_t {
  kHello,        // a: 1: after exec(), data: int32[], the descriptors that are left; b: what the
                 // machine calls the thread, if it is not the process's first -> Identity
  kNote,         // data: a text about what cannot be simulated; the program ends
  kReadClock,    // a: clockid, b: 1: no time passes -> value
  kSetClock,     // a: clockid, b: its new reading
  kAdjustClock,  // a: clockid, data: struct timex -> value: clock state, data: struct timex
  kWait,         // a: Deadline, b: its time, data: Interest[] -> value: how many are ready, data;
                 // EINTR: a signal timer has expired, data: what is left, int64
  kOpenTimer,    // fd, a: clockid
  kSetTimer,     // fd, a: 1 if absolute, data: TimerSetting -> data: the setting before
  kReadTimer,    // fd -> value: expirations since the last; EAGAIN if none
  kQueryTimer,   // fd -> data: TimerSetting
  kOpenSocket,   // fd, a: SOCK_DGRAM, SOCK_STREAM or SOCK_RAW, b: the family; of a packet socket,
                 // the protocol above its lower 16 bits
  kBind,         // fd, data: Address
  kConnect,      // fd, data: Address, of no family: ends the association; a stream: EINPROGRESS
  kSetOption,    // fd, a: SocketOption, and kOfIpv6 if it is of that level, b: value
  kName,         // fd -> data: Address
  kPeerName,     // fd -> data: Address; ENOTCONN
  kSend,  // fd, a: StampKind as bits of this departure, -1: the socket's, data: Departure, then the
          // payload -> value: of a stream, how much of it was taken
  kReceive,  // fd, a: ReceiveFlag -> data: Arrival, then payload; ESHUTDOWN: nothing more comes;
             // of a stream, b: how many at most -> data: bytes, none at its end
  kClose,    // fd
  kRandom,   // a: how many -> data: bytes
  kJoin,     // fd, a: 1: join, 0: leave, b: of a packet socket, PACKET_MR_..., data: Address of the
             // group, its scope the interface
  kFilterArrivals,  // fd, data: struct sock_filter[], none: all pass
  kCountArrivals,   // fd, a packet socket -> data: ArrivalCount, from the last on
  kReadCard,        // a: how many -> data: CardSample[]
  kListen,          // fd, a: how many may wait
  kAccept,          // fd, a: the new descriptor -> data: Address of the peer; EAGAIN
  kShutDown,        // fd, a: SHUT_RD, SHUT_WR or SHUT_RDWR
  kSocketError,     // fd -> value: SO_ERROR, which is cleared
  kCountInput,      // fd -> value: bytes that the next read would give
  kLocalActivity,   // another program of the host may have something to read, or a peer less
  kCardStamping,  // a: what the card stamps from now on, bit 0: arrivals, bit 1: departures; -1: as
                  // before -> value: what it stamps; EOPNOTSUPP without a clock on the card
  // Timers that make signals, of alarm(), setitimer() and timer_create(); `fd` is a number below 0
  // that the shim gives them.
  kSetSignalTimer,  // fd, a: 1 if absolute, b: clockid, data: TimerSetting -> data: the one before
  kQuerySignalTimer,  // fd -> data: TimerSetting
  kDropSignalTimer,   // fd
  kTakeExpirations,   // -> data: Expiration[], of what the shim has not yet heard of
  // Threads and processes.
  kNewThread,      // with a descriptor: its link -> value: its number; EAGAIN: there are too many
  kNewProcess,     // likewise
  kStarted,        // a: its number, b: what the machine calls it; 0: it could not be started
  kEndThread,      // b: what the machine calls the thread; there is no reply
  kExecute,        // the other threads of the process end
  kSignal,         // a: a process, b: a signal; 0: none, data: a sigval of sigqueue() -> ESRCH
  kLookAtSignals,  // a: a process, which may have one that was made by the machine
  kFindProcess,    // a: a process -> value: what the machine calls it; b: 1: the other way round
  kWaitForWake,    // a: Deadline, b: its time, data: Lock -> ETIMEDOUT, EINTR
  kWake,           // a: how many at most, data: Lock -> value: how many
  kRequeue,  // a: how many at most, data: Lock, Lock: where the others wait -> value: how many
             // that were woken or moved; b: how many of these are moved at most
  // Sets of epoll().
  kOpenEpoll,     // fd
  kControlEpoll,  // fd, a: EPOLL_CTL_..., data: EpollItem
  kTakeEvents,    // fd, a: how many at most -> data: EpollItem[]
  // Devices.
  kOpenDevice,       // fd, a: HostDevice -> ENOENT
  kPulseParameters,  // fd, data: pps_kparams to be, or none -> value: what it can (PPS_GETCAP),
                     // data: pps_kparams
  kFetchPulse,       // fd -> data: pps_kinfo; the descriptor is ready for reading at the next pulse
  kPin,          // fd, a: ptp_pin_function to be, -1: as it is, b: the channel -> value: what it
                 // is; EINVAL, EOPNOTSUPP
  kStampPulses,  // fd, a: 1: the card stamps them from now on, 0: it does not -> EBUSY: its pin
                 // is not for that
  kTakeStamps,   // fd, a: how many at most -> data: int64[]; EAGAIN
  // Files of the host's folder.
  kLookAtFile,  // data: FileSight -> value: its number, data: when it was written to, int64
};

// When a wait ends without anything being ready.
enum class Deadline : std::int64_t { kNever, kAfter, kAtSystemTime, kAtMonotonicTime };

enum class SocketOption : std::int64_t {
  kReceiveStamps,   // of arrivals: StampKind as bits
  kTransmitStamps,  // of departures, in the error queue: StampKind as bits -> value: the sent
  kReuseAddress,    // SO_REUSEADDR, for those that follow: 0 or 1
  kBroadcast,       // SO_BROADCAST
  kUrgentErrors,    // SO_SELECT_ERR_QUEUE
  kAllGroups,       // IP_MULTICAST_ALL
  kLoopGroups,      // IP_MULTICAST_LOOP
  kOnlyIpv6,        // IPV6_V6ONLY
  kInterface,       // SO_BINDTODEVICE: its number, 0: any
  kGroupInterface,  // IP_MULTICAST_IF: its number, 0: any
  kHops,            // IP_TTL
  kGroupHops,       // IP_MULTICAST_TTL
  kTrafficClass,    // IP_TOS
  kMtuDiscovery,    // IP_MTU_DISCOVER
  kDontFragment,    // IPV6_DONTFRAG
  kReceiveErrors,   // IP_RECVERR
  kIgnoreOutgoing,  // PACKET_IGNORE_OUTGOING
};
// Beside an option of which both protocols have one each.
inline constexpr std::int64_t kOfIpv6 = 1 << 16;

enum class HostDevice : std::int64_t {
  kCard,    // the network card's clock, /dev/ptp0
  kPulses,  // the line with a pulse per second, /dev/pps0
};

enum StampKind : unsigned {
  kSoftwareStamps = 1,
  kHardwareStamps = 2,
  kBothStamps = 4,  // departures have a stamp of each kind, in messages of their own
};

struct Request {
  Call call{};
  std::int32_t fd = -1;
  std::int64_t a = 0;
  std::int64_t b = 0;
  std::uint32_t size = 0;
  std::uint32_t flags = 0;  // WaitFlag
};

// The si_code of signals that the world makes for a process: of kill() and of sigqueue(). The
// sender's number is the world's.
inline constexpr int kByWorld = -60;
inline constexpr int kQueuedByWorld = -61;

// In a reply's error: signal timers have expired (kTakeExpirations); the process may have a signal
// of the machine's; another thread of the host waits for real descriptors (kLocalActivity).
inline constexpr std::int32_t kHasExpirations = 1 << 30;
inline constexpr std::int32_t kHasSignals = 1 << 29;
inline constexpr std::int32_t kIsWatched = 1 << 28;

// A wait that watches real descriptors too ends with EAGAIN when another program of the host may
// have made one ready. Its data is then what is left until the deadline (int64), as with EINTR.
enum WaitFlag : std::uint32_t {
  kWatchesReal = 1,
  kHasOnlyLooked = 2,  // since it was told to look: it has done nothing that others wait for
};

struct Reply {
  std::int64_t value;
  std::int32_t error;
  std::uint32_t size;
};

struct Identity {
  std::int32_t process = 0;         // what getpid() is
  std::int32_t parent = 0;          // what getppid() is
  std::int32_t thread = 0;          // what gettid() is
  std::uint32_t address = 0;        // the host's by IPv4, in host byte order; shim/addresses.h
  std::uint32_t netmask = 0;        // of its network
  std::uint32_t first_address = 0;  // of "host0"
  std::uint32_t hosts = 0;
  std::uint32_t has_card_clock = 0;  // 0 or 1
  std::int32_t most_card_rate = 0;   // ppb, what the card's driver states
  std::uint32_t has_pulse_line = 0;  // 0 or 1
  std::uint32_t only_clock = 0;      // 0 or 1: sockets, waits and chance are the machine's
  std::uint32_t cards = 1;           // eth0 and on; the first alone has addresses
  std::uint32_t carriers = 1;        // those whose cable leads somewhere, as bits
};

// In network byte order; of IPv4 as IPv6 maps it, ::ffff:a.b.c.d. All zero, or mapped zero: any.
struct IpAddress {
  std::uint8_t bytes[16]{};

  friend bool operator==(const IpAddress&, const IpAddress&) = default;
};

// A socket's address. In a packet socket's the host is a PacketAddress, the port the protocol.
struct Address {
  IpAddress host{};
  std::uint32_t scope = 0;   // the number of an interface; 0: not said
  std::uint16_t port = 0;    // host byte order
  std::uint16_t family = 0;  // AF_INET, AF_INET6 or AF_PACKET; AF_UNSPEC: no address

  friend bool operator==(const Address&, const Address&) = default;
};

struct PacketAddress {
  std::uint8_t card[6]{};
  std::uint8_t kind = 0;  // PACKET_HOST, ...
  std::uint8_t reserved[9]{};
};

struct Departure {
  Address to{};      // of no family: the peer
  Address source{};  // of no family: as ever; its scope: the interface
};

enum ReceiveFlag : std::int64_t {
  kFromErrorQueue = 1,
  kLeaveIt = 2,
  kMayWait = 4,  // the caller waits if there is nothing
};

// As struct pollfd.
struct Interest {
  std::int32_t fd;
  std::int16_t events;
  std::int16_t ready;
};

// A place in memory that threads wait for, as futex() has it.
struct Lock {
  std::uint64_t address = 0;
  std::uint32_t bits = ~0U;
  std::uint32_t is_shared = 0;  // with other processes, which may have it at other addresses
};

// What an epoll descriptor watches: of `number`, by the descriptor `fd`.
struct EpollItem {
  std::int32_t number = -1;
  std::int32_t fd = -1;
  std::uint32_t events = 0;
  std::uint32_t reserved = 0;
  std::uint64_t data = 0;
};

// A file as the machine knows it, and the machine's time at which it was last written to; 0: the
// file itself says when, by the host's clock.
struct FileSight {
  std::uint64_t device = 0;
  std::uint64_t file = 0;
  std::int64_t born = 0;  // a number of a file that is gone may be another's
  std::int64_t modified = 0;
  // It was just made: the machine's clock is coarse, and one that is gone may have been born then
  // too.
  std::int64_t is_new = 0;
};

// Which times of files are the machine's: the kernel stamps each change, and the time of the host's
// clock is put there later, by the shim when the program closes what it wrote, by the world at the
// end (sim/programs/host_files.h). The kernel's note of the last change (st_ctime) is always the
// machine's. `born` is when the machine made the host's folder; ns since 1970.
//
// Whether the file has changed since, as all of the host's have.
constexpr bool is_of_host(std::int64_t born, std::int64_t changed) { return changed >= born; }
// Whether the kernel has stamped the last writing.
constexpr bool is_of_machine(std::int64_t born, std::int64_t modified, std::int64_t changed) {
  return modified >= born && modified <= changed;
}

struct TimerSetting {
  std::int64_t left;      // until it expires, or the time at which it does; 0: disarmed
  std::int64_t interval;  // 0: once
};

struct Expiration {
  std::int32_t timer;
  std::uint32_t times;
};

// The clock of the network card, where a clockid is asked for; no clock has this number.
inline constexpr std::int64_t kCardClock = -1;

// A reading of the card's clock between two of the system's.
struct CardSample {
  std::int64_t before;
  std::int64_t card;
  std::int64_t after;
};

// A datagram or a frame; in the error queue what has left, or what was refused: its payload is
// then that of the datagram which nobody took.
struct Arrival {
  Address from{};
  Address to{};                       // of what was refused, also who said that
  std::int64_t system = INT64_MIN;    // the software stamp; kNoStamp: none
  std::int64_t hardware = INT64_MIN;  // the card's; kNoStamp: none
  std::uint32_t length = 0;           // of the payload, also where less of it follows
  std::uint32_t number = 0;  // of the stamped datagrams that the socket sent; 0 for arrivals
  std::uint32_t interface = 0;
  std::uint32_t info = 0;   // ee_info
  std::uint16_t error = 0;  // ee_errno; 0 for arrivals
  std::uint8_t origin = 0;  // SO_EE_ORIGIN_...; 0 for arrivals
  std::uint8_t hops = 0;    // that it may go on for
  std::uint8_t traffic_class = 0;
  std::uint8_t reserved[3]{};
};

struct ArrivalCount {
  std::uint32_t arrived = 0;
  std::uint32_t dropped = 0;
};

inline constexpr std::int64_t kNoStamp = INT64_MIN;

}  // namespace simbench::shim

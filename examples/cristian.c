/* Sets this host's clock by a server's, by Cristian's algorithm, over UDP: cristian.py in C, with
 * which it can talk.
 *
 *     cc -O2 -o cristian cristian.c
 *     ./cristian serve               answers with the time
 *     ./cristian follow SERVER       SERVER is an IPv4 address; needs the right to set the clock
 *
 *     simbench clocks --scenario 6host_star --program cristian_c=examples/cristian_c.json
 */
#include <arpa/inet.h>
#include <endian.h>
#include <poll.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>

enum { PORT = 4123, ASKED_EACH_SECOND = 8 };

struct times { /* ns, in network byte order */
  uint64_t asked;
  uint64_t answered;
};

static int64_t now(void) {
  struct timespec reading;
  clock_gettime(CLOCK_REALTIME, &reading);
  return reading.tv_sec * INT64_C(1000000000) + reading.tv_nsec;
}

static int fail(const char* what) {
  perror(what);
  exit(1);
}

static void serve(int link) {
  struct sockaddr_in own = {.sin_family = AF_INET, .sin_port = htons(PORT)};
  if (bind(link, (struct sockaddr*)&own, sizeof own) != 0) fail("bind");
  for (;;) {
    struct times message;
    struct sockaddr_in asker;
    socklen_t size = sizeof asker;
    if (recvfrom(link, &message, sizeof message, 0, (struct sockaddr*)&asker, &size) < 0) {
      fail("recvfrom");
    }
    message.answered = htobe64((uint64_t)now());
    sendto(link, &message, sizeof message, 0, (struct sockaddr*)&asker, size);
  }
}

/* Sets the round trip and the clock's error in ns; returns whether there was an answer. */
static int ask(int link, int64_t* round_trip, int64_t* error) {
  const int64_t asked = now();
  struct times message = {.asked = htobe64((uint64_t)asked)};
  if (send(link, &message, sizeof message, 0) < 0) return 0;
  struct pollfd interest = {.fd = link, .events = POLLIN};
  while (poll(&interest, 1, 50) == 1) {
    if (recv(link, &message, sizeof message, 0) < 0) return 0;
    const int64_t arrived = now();
    if ((int64_t)be64toh(message.asked) != asked) continue; /* answers an earlier question */
    *round_trip = arrived - asked;
    *error = asked + *round_trip / 2 - (int64_t)be64toh(message.answered);
    return 1;
  }
  return 0;
}

static void follow(int link, const char* server) {
  struct sockaddr_in peer = {.sin_family = AF_INET, .sin_port = htons(PORT)};
  if (inet_pton(AF_INET, server, &peer.sin_addr) != 1) fail(server);
  if (connect(link, (struct sockaddr*)&peer, sizeof peer) != 0) fail("connect");
  for (;;) {
    int64_t best = INT64_MAX, error = 0;
    for (int i = 0; i < ASKED_EACH_SECOND; ++i) {
      int64_t round_trip, its_error;
      if (ask(link, &round_trip, &its_error) && round_trip < best) {
        best = round_trip;
        error = its_error;
      }
      nanosleep(&(struct timespec){.tv_nsec = 1000000000 / ASKED_EACH_SECOND}, NULL);
    }
    if (best == INT64_MAX) continue;
    const int64_t right = now() - error;
    const struct timespec time = {.tv_sec = right / 1000000000, .tv_nsec = right % 1000000000};
    if (clock_settime(CLOCK_REALTIME, &time) != 0) fail("clock_settime");
    printf("round trip %.1f us, error %.1f us\n", (double)best / 1e3, (double)error / 1e3);
    fflush(stdout);
  }
}

int main(int count, char** words) {
  const int link = socket(AF_INET, SOCK_DGRAM, 0);
  if (link < 0) return fail("socket");
  if (count == 2 && strcmp(words[1], "serve") == 0) serve(link);
  if (count == 3 && strcmp(words[1], "follow") == 0) follow(link, words[2]);
  fprintf(stderr, "usage: cristian serve | cristian follow SERVER\n");
  return 2;
}

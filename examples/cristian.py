#!/usr/bin/env python3
"""Sets this host's clock by a server's, by Cristian's algorithm, over UDP.

    cristian.py serve               answers with the time
    cristian.py follow SERVER       asks eight times a second, believes the fastest answer of each
                                    second, and sets the clock; needs the right to set it

The same file runs between two real hosts and in the simulated world:

    simbench clocks --scenario 6host_star --program cristian=examples/cristian.json
"""

import select
import socket
import struct
import sys
import time

PORT = 4123
ASKED_EACH_SECOND = 8
TIME = struct.Struct("!qq")  # when the question was asked, when it was answered; ns


def serve():
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    link.bind(("", PORT))
    while True:
        question, asker = link.recvfrom(TIME.size)
        asked, _ = TIME.unpack(question)
        link.sendto(TIME.pack(asked, time.time_ns()), asker)


def ask(link, server):
    """The round trip and the clock's error in ns, or nothing."""
    asked = time.time_ns()
    link.sendto(TIME.pack(asked, 0), (server, PORT))
    while select.select([link], [], [], 0.05)[0]:
        its_question, answered = TIME.unpack(link.recv(TIME.size))
        arrived = time.time_ns()
        if its_question == asked:  # else it answers an earlier one
            return arrived - asked, (asked + arrived) // 2 - answered
    return None


def follow(server):
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    while True:
        answers = []
        for _ in range(ASKED_EACH_SECOND):
            answers.append(ask(link, server))
            time.sleep(1 / ASKED_EACH_SECOND)
        answers = [answer for answer in answers if answer is not None]
        if not answers:
            print("no answer from", server, flush=True)
            continue
        round_trip, error = min(answers)
        time.clock_settime_ns(time.CLOCK_REALTIME, time.time_ns() - error)
        print(f"round trip {round_trip / 1e3:.1f} us, error {error / 1e3:.1f} us", flush=True)


if __name__ == "__main__":
    if sys.argv[1:] == ["serve"]:
        serve()
    elif len(sys.argv) == 3 and sys.argv[1] == "follow":
        follow(sys.argv[2])
    else:
        sys.exit(__doc__)

#!/usr/bin/env python3
"""Python's threads: each line is when something ended, in ms since the beginning, and what."""

import concurrent.futures
import queue
import threading
import time

BEGIN = time.monotonic()


def say(*values):
    print(round((time.monotonic() - BEGIN) * 1e3), *values, flush=True)


def wait_for_events():
    event = threading.Event()
    say("wait", event.wait(0.25))
    threading.Timer(0.1, event.set).start()
    say("wait", event.wait(5))


def hand_over():
    items = queue.Queue(maxsize=2)

    def produce():
        for number in range(5):
            time.sleep(0.03)
            items.put(number)

    maker = threading.Thread(target=produce)
    maker.start()
    say("items", [items.get() for _ in range(5)])
    maker.join()
    try:
        items.get(timeout=0.2)
    except queue.Empty:
        say("empty")


def compete():
    lock = threading.Lock()
    lock.acquire()
    say("lock", lock.acquire(timeout=0.05))
    threading.Timer(0.02, lock.release).start()
    say("lock", lock.acquire(timeout=1))


def meet():
    barrier = threading.Barrier(3)
    threads = [
        threading.Thread(target=lambda wait: (time.sleep(wait), barrier.wait()), args=(wait,))
        for wait in (0.01, 0.04, 0.07)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    say("met")


def pool():
    with concurrent.futures.ThreadPoolExecutor(2) as workers:
        say("squares", list(workers.map(lambda n: (time.sleep(0.1), n * n)[1], range(5))))


if __name__ == "__main__":
    wait_for_events()
    hand_over()
    compete()
    meet()
    pool()
    time.sleep(1e6)

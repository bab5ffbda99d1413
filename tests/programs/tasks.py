#!/usr/bin/env python3
"""Python's asyncio: each line is when something ended, in ms since the beginning, and what.

    tasks.py serve           answers datagrams and streams
    tasks.py ask HOST        asks, and does what else asyncio can do meanwhile
"""

import asyncio
import socket
import sys
import time

BEGIN = time.monotonic()
PORT = 5603


def say(*values):
    print(round((time.monotonic() - BEGIN) * 1e3), *values, flush=True)


class Echo(asyncio.DatagramProtocol):
    def connection_made(self, transport):
        self.transport = transport

    def datagram_received(self, data, asker):
        self.transport.sendto(data, asker)


class Asker(asyncio.DatagramProtocol):
    def __init__(self):
        self.answer = asyncio.get_running_loop().create_future()

    def datagram_received(self, data, _):
        self.answer.set_result(data)


async def answer(reader, writer):
    writer.write(await reader.readline())
    await writer.drain()
    writer.close()


async def serve():
    await asyncio.get_running_loop().create_datagram_endpoint(
        Echo, local_addr=("0.0.0.0", PORT)
    )
    server = await asyncio.start_server(answer, "0.0.0.0", PORT)
    await server.serve_forever()


async def ask(host):
    loop = asyncio.get_running_loop()
    link, asker = await loop.create_datagram_endpoint(
        Asker, remote_addr=(host, PORT), family=socket.AF_INET
    )
    link.sendto(b"datagram")
    say(await asker.answer)
    reader, writer = await asyncio.open_connection(host, PORT)
    writer.write(b"stream\n")
    say(await reader.readline())
    writer.close()


async def sleep_and_say(seconds):
    await asyncio.sleep(seconds)
    say("slept", seconds)


async def work(host):
    await ask(host)
    await asyncio.gather(*(sleep_and_say(seconds) for seconds in (0.3, 0.1, 0.2)))
    try:
        await asyncio.wait_for(asyncio.sleep(10), 0.15)
    except asyncio.TimeoutError:
        say("patience is over")
    say(await asyncio.to_thread(lambda: (time.sleep(0.25), "of a thread")[1]))
    child = await asyncio.create_subprocess_exec(
        "/bin/sh", "-c", "sleep 0.5; echo of a child; exit 3", stdout=asyncio.subprocess.PIPE
    )
    say(await child.stdout.read(), await child.wait())
    ready = asyncio.Event()
    loop = asyncio.get_running_loop()
    loop.call_later(0.05, ready.set)
    await ready.wait()
    say("called")
    await asyncio.sleep(1e6)


if __name__ == "__main__":
    asyncio.run(serve() if sys.argv[1] == "serve" else work(sys.argv[2]))

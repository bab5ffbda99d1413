"""Python's socket programs over IPv6: on the loopback and between hosts.

    ipv6_sockets.py serve    answers on port 4000, by TCP and UDP
    ipv6_sockets.py ask
"""

import asyncio
import select
import socket
import sys
import time

PORT = 4000


def serve():
    udp = socket.socket(socket.AF_INET6, socket.SOCK_DGRAM)
    udp.bind(("::", PORT))
    tcp = socket.create_server(("::", PORT), family=socket.AF_INET6, dualstack_ipv6=True)
    while True:
        ready, _, _ = select.select([udp, tcp], [], [])
        if udp in ready:
            data, peer = udp.recvfrom(70000)
            udp.sendto(data.upper(), peer)
        if tcp in ready:
            connection, peer = tcp.accept()
            connection.sendall(connection.recv(1000).upper())
            connection.close()


def ask_by_udp():
    for family, name in ((socket.AF_INET6, "host1"), (socket.AF_INET, "host1")):
        address = socket.getaddrinfo(name, PORT, family, socket.SOCK_DGRAM)[0][4]
        with socket.socket(family, socket.SOCK_DGRAM) as udp:
            udp.settimeout(1)
            udp.sendto(b"y" * 60000, address)
            data, peer = udp.recvfrom(70000)
            print(len(data), data[:3], *peer)
    with socket.socket(socket.AF_INET6, socket.SOCK_DGRAM) as udp:
        udp.connect(socket.getaddrinfo("fe80::aff:fe00:2%eth0", PORT)[0][4])
        udp.send(b"link")
        print(udp.recv(100), socket.getnameinfo(udp.getpeername(), socket.NI_NUMERICHOST)[0])
    with socket.socket(socket.AF_INET6, socket.SOCK_DGRAM) as udp:
        udp.connect(("fd00::2", PORT + 1))
        udp.send(b"refused")
        try:
            udp.recv(100)
        except ConnectionRefusedError as error:
            print(error)


def ask_by_tcp():
    for name in ("host1", "fd00::2", "10.0.0.2"):
        with socket.create_connection((name, PORT), timeout=2) as tcp:
            tcp.sendall(name.encode())
            print(tcp.recv(100), tcp.getpeername()[0])


async def loop_back():
    async def answer(reader, writer):
        writer.write((await reader.read(100)).upper())
        await writer.drain()
        writer.close()

    server = await asyncio.start_server(answer, "::1", 5000)
    reader, writer = await asyncio.open_connection("::1", 5000)
    writer.write(b"loopback")
    print(await reader.read(100), writer.get_extra_info("peername")[0])
    writer.close()
    server.close()


if __name__ == "__main__":
    if sys.argv[1] == "serve":
        serve()
    time.sleep(1)
    ask_by_udp()
    ask_by_tcp()
    asyncio.run(loop_back())
    print(socket.has_dualstack_ipv6(), socket.getfqdn("fd00::2"), socket.gethostname())
    print("done", flush=True)
    time.sleep(3600)

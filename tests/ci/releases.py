"""A release made of this build, as tools/release lays it out, and a server that hands it out."""

import base64
import hashlib
import http.server
import os
import platform
import tarfile
import threading
import zipfile

SOURCE = os.environ["SIMBENCH_SOURCE_DIR"]
BUILD = os.environ["SIMBENCH_BUILD_DIR"]
VERSION = os.environ["SIMBENCH_VERSION_OF_BUILD"]
MACHINE = platform.machine()
ARCHIVE = f"simbench-{VERSION}-linux-{MACHINE}.tar.gz"
WHEEL = f"simbench-{VERSION}-cp39-abi3-manylinux_2_31_{MACHINE}.whl"


def sha256(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def write_sums(folder):
    names = sorted(name for name in os.listdir(folder) if name != "SHA256SUMS")
    with open(os.path.join(folder, "SHA256SUMS"), "w", encoding="utf-8") as file:
        file.writelines(f"{sha256(os.path.join(folder, name))}  {name}\n" for name in names)


def make_archive(folder):
    top = ARCHIVE[: -len(".tar.gz")]
    with tarfile.open(os.path.join(folder, ARCHIVE), "w:gz", compresslevel=1) as archive:
        archive.add(os.path.join(BUILD, "bin", "simbench"), f"{top}/bin/simbench")
        archive.add(os.path.join(BUILD, "lib", "libsimbench_shim.so"),
                    f"{top}/lib/simbench/libsimbench_shim.so")


def make_wheel(folder):
    """Of the package as it was built, whose module is of this Python alone."""
    package = os.path.join(BUILD, "python", "simbench")
    info = f"simbench-{VERSION}.dist-info"
    tag = WHEEL.split("-", 2)[2][: -len(".whl")]
    files = {f"{info}/METADATA": f"Metadata-Version: 2.1\nName: simbench\nVersion: {VERSION}\n",
             f"{info}/WHEEL": f"Wheel-Version: 1.0\nRoot-Is-Purelib: false\nTag: {tag}\n"}
    files = {name: text.encode() for name, text in files.items()}
    for name in sorted(os.listdir(package)):
        if os.path.isfile(os.path.join(package, name)):
            with open(os.path.join(package, name), "rb") as file:
                files[f"simbench/{name}"] = file.read()
    record = ""
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(content)}\n"
    files[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
    with zipfile.ZipFile(os.path.join(folder, WHEEL), "w") as wheel:
        for name, content in files.items():
            wheel.writestr(name, content)


def make_release(folder):
    os.makedirs(folder)
    make_archive(folder)
    make_wheel(folder)
    write_sums(folder)


class Server:
    """Hands out a folder at `url`. `requests`: path and headers of each so far."""

    def __init__(self, folder):
        self.requests = requests = []

        class Handler(http.server.SimpleHTTPRequestHandler):
            def __init__(self, *arguments):
                super().__init__(*arguments, directory=folder)

            def do_GET(self):
                requests.append((self.path, dict(self.headers)))
                super().do_GET()

            def log_message(self, *_):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self.server.server_address[1]}"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def close(self):
        self.server.shutdown()
        self.server.server_close()

#!/usr/bin/env python3
"""What is linked into a released simbench: licences and a bill of materials (SPDX 2.3).

    materials.py MACHINE VERSION OUTPUT ROOT...

MACHINE: x86_64 or aarch64. OUTPUT: a folder, made anew: licences/NAME of each component and
bill_of_materials.spdx.json. ROOT: folders below which packages of Debian lie (usr/share/doc/...),
the first that has one counts. SOURCE_DATE_EPOCH is the time that the bill names.

Exit status: 0 written, 1 a licence was not found.
"""

import gzip
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import time
from typing import Dict, List, NamedTuple, Optional


class Component(NamedTuple):
    name: str
    package: str  # of Debian; for uPlot, of npm
    licence: str  # SPDX
    home: str


COMPONENTS = [
    Component("glibc", "libc6-dev", "LGPL-2.1-or-later", "https://www.gnu.org/software/libc/"),
    Component(
        "libstdc++", "libstdc++-12-dev", "GPL-3.0-or-later WITH GCC-exception-3.1",
        "https://gcc.gnu.org/",
    ),
    Component(
        "newlib", "newlib-source", "BSD-3-Clause AND SunPro", "https://sourceware.org/newlib/"
    ),
    Component("boost", "libboost1.81-dev", "BSL-1.0", "https://www.boost.org/"),
    Component("eigen", "libeigen3-dev", "MPL-2.0", "https://eigen.tuxfamily.org/"),
    Component("nlohmann-json", "nlohmann-json3-dev", "MIT", "https://github.com/nlohmann/json"),
    Component("cli11", "libcli11-dev", "BSD-3-Clause", "https://github.com/CLIUtils/CLI11"),
    Component("fmt", "libfmt-dev", "MIT", "https://fmt.dev/"),
    Component("libsodium", "libsodium-dev", "ISC", "https://libsodium.org/"),
    Component("sqlite", "libsqlite3-dev", "blessing", "https://sqlite.org/"),
    Component("lz4", "liblz4-dev", "BSD-2-Clause", "https://lz4.org/"),
    Component("zstd", "libzstd-dev", "BSD-3-Clause", "https://facebook.github.io/zstd/"),
    Component("bzip2", "libbz2-dev", "bzip2-1.0.6", "https://sourceware.org/bzip2/"),
    Component("zlib", "zlib1g-dev", "Zlib", "https://zlib.net/"),
    Component("uplot", "uplot", "MIT", "https://github.com/leeoniya/uPlot"),
]  # fmt: skip


def documents(package: str, roots: List[str]) -> Optional[str]:
    """The folder with a package's copyright, also of a package for cross compiling."""
    for root in roots:
        for name in (package, f"{package}-arm64-cross"):
            folder = os.path.join(root, "usr/share/doc", name)
            if os.path.exists(os.path.join(folder, "copyright")):
                return folder
    return None


def version_of(folder: str) -> str:
    """By the changelog; by dpkg where a machine keeps none."""
    for name in ("changelog.Debian.gz", "changelog.gz"):
        path = os.path.join(folder, name)
        if os.path.exists(path):
            with gzip.open(path, "rt", encoding="utf-8", errors="replace") as file:
                found = re.match(r"\S+ \(([^)]+)\)", file.readline())
            if found:
                return found[1]
    package = os.path.basename(folder)
    return subprocess.check_output(
        ["dpkg-query", "--show", "--showformat=${Version}", package], text=True
    )


def uplot(roots: List[str]) -> Dict[str, str]:
    for root in roots:
        folder = os.path.join(root, "usr/share/javascript/uplot")
        if os.path.exists(os.path.join(folder, "LICENSE")):
            with open(os.path.join(folder, "package.json"), encoding="utf-8") as file:
                version = json.load(file)["version"]
            return {"licence": os.path.join(folder, "LICENSE"), "version": version}
    sys.exit("materials: uplot: found no licence")


def found(component: Component, roots: List[str]) -> Dict[str, str]:
    """The file of a component's licence, and its version."""
    if component.package == "uplot":
        return uplot(roots)
    folder = documents(component.package, roots)
    if folder is None:
        sys.exit(f"materials: {component.package}: found no copyright below {' '.join(roots)}")
    return {"licence": os.path.join(folder, "copyright"), "version": version_of(folder)}


def spdx_package(identifier: str, name: str, version: str, licence: str, home: str) -> dict:
    return {
        "SPDXID": identifier,
        "name": name,
        "versionInfo": version,
        "downloadLocation": home,
        "filesAnalyzed": False,
        "licenseConcluded": licence,
        "licenseDeclared": licence,
        "copyrightText": "NOASSERTION",
    }


def bill(machine: str, version: str, versions: Dict[str, str]) -> dict:
    epoch = int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))
    own = "SPDXRef-simbench"
    packages = [spdx_package(own, "simbench", version, "Apache-2.0", "NOASSERTION")]
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", own)]
    for component in COMPONENTS:
        identifier = "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", component.name)
        packages.append(
            spdx_package(
                identifier, component.name, versions[component.name], component.licence,
                component.home,
            )  # fmt: skip
        )
        relations.append((own, "STATIC_LINK", identifier))
    content = hashlib.sha256(json.dumps(packages).encode()).hexdigest()
    return {
        "spdxVersion": "SPDX-2.3",
        "dataLicense": "CC0-1.0",
        "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"simbench-{version}-linux-{machine}",
        "documentNamespace": f"urn:simbench:{version}:{machine}:{content}",
        "creationInfo": {
            "created": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(epoch)),
            "creators": ["Tool: simbench-materials"],
        },
        "packages": packages,
        "relationships": [
            {"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b}
            for a, kind, b in relations
        ],
    }


def main() -> None:
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    machine, version, output, *roots = sys.argv[1:]
    shutil.rmtree(output, ignore_errors=True)
    os.makedirs(os.path.join(output, "licences"))
    versions = {}
    for component in COMPONENTS:
        facts = found(component, roots)
        versions[component.name] = facts["version"]
        shutil.copyfile(facts["licence"], os.path.join(output, "licences", component.name))
    path = os.path.join(output, "bill_of_materials.spdx.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(bill(machine, version, versions), file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main()

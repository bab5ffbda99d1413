"""The machine and the repository that a CI run starts with: nothing of this project's in either."""

import os
import shutil
import subprocess
import tempfile

from releases import SOURCE

SNIPPETS = os.path.join(SOURCE, "reports", "ci")


def text_of(*path):
    with open(os.path.join(*path), encoding="utf-8") as file:
        return file.read()


def stand_in(folder, name, script):
    """A program of that name, before the machine's own."""
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"#!/bin/sh\n{script}\n")
    os.chmod(path, 0o755)


class Machine:
    """A folder that is removed at the end, and the environment of whoever runs in it."""

    def __init__(self, python):
        self.folder = tempfile.mkdtemp(prefix="simbench_ci.")
        self.programs = self.path("programs")
        os.makedirs(self.programs)
        stand_in(self.programs, "apt-get", f'echo "$*" >> {self.path("apt_log")}')
        stand_in(self.programs, "python3", f'exec "{python}" "$@"')
        author = {f"GIT_{who}_{what}": f"nobody@example.org" for who in ("AUTHOR", "COMMITTER")
                  for what in ("NAME", "EMAIL")}
        self.environment = {"PATH": f"{self.programs}:{os.environ['PATH']}", "LANG": "C.UTF-8",
                            "HOME": self.path("home"), "GIT_CONFIG_GLOBAL": "/dev/null",
                            "GIT_CONFIG_SYSTEM": "/dev/null", **author}
        os.makedirs(self.path("home"))

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def close(self):
        shutil.rmtree(self.folder)


class Repository:
    """A repository that is empty at first."""

    def __init__(self, machine, name="repository"):
        self.folder, self.environment = machine.path(name), machine.environment
        os.makedirs(self.folder)
        self.git("init", "--quiet", "--initial-branch=main")

    def git(self, *arguments):
        subprocess.run(["git", *arguments], cwd=self.folder, env=self.environment, check=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    def edit(self, name, old, new):
        text = text_of(self.path(name))
        assert old in text, (name, old)
        self.write(name, text.replace(old, new))

    def commit(self, message="A change"):
        self.git("add", "--all")
        self.git("commit", "--quiet", "--message", message)

    def shell(self, script, check=True, **environment):
        """Runs a script in the repository, as a person does; returns status, output, errors."""
        done = subprocess.run(["sh", "-c", script], cwd=self.folder, capture_output=True, text=True,
                              env={**self.environment, **environment}, check=False)
        assert done.returncode == 0 or not check, done
        return done.returncode, done.stdout, done.stderr

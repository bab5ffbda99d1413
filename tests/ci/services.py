"""Stand-ins for GitHub Actions and GitLab CI: they read a repository's YAML and run its scripts.

They set the variables that the services set, restore and keep the caches, and end where the services
end. What is of others (`uses: actions/...`) they do themselves or leave out. A key that they do not
know is an error: the snippets say nothing that nobody has tried.
"""

import os
import re
import shutil
import string
import subprocess
import xml.etree.ElementTree

import yaml


def known(mapping, *keys):
    unknown = set(mapping) - set(keys)
    assert not unknown, f"unknown keys {unknown}"
    return mapping


def failures(junit):
    """Tests in a JUnit file, and name and message of those that failed."""
    root = xml.etree.ElementTree.parse(junit).getroot()
    failed = [(case.get("classname"), case.get("name"), case.find("failure").get("message"))
              for case in root.iter("testcase") if case.find("failure") is not None]
    assert root.get("failures") == str(len(failed))
    return int(root.get("tests")), failed


class Run:
    """What a run of the service left: its status, log, summary page and artifacts."""

    def __init__(self, status, log, summary, artifacts):
        self.status, self.log, self.summary, self.artifacts = status, log, summary, artifacts


class Service:
    """`folder`: for workspaces, caches and artifacts. `environment`: of the machine."""

    def __init__(self, folder, environment):
        self.folder, self.environment = folder, environment
        self.workspace = os.path.join(folder, "workspace")
        self.artifacts = os.path.join(folder, "artifacts")
        self.caches = os.path.join(folder, "caches")
        os.makedirs(self.caches)

    def run(self, repository):
        """Runs the one job of the newest commit in a fresh workspace."""
        for old in (self.workspace, self.artifacts):
            shutil.rmtree(old, ignore_errors=True)
        subprocess.run(["git", "clone", "--quiet", repository, self.workspace], check=True)
        return self.run_job()

    def shell(self, script, environment, options=("-e",)):
        done = subprocess.run(["bash", *options, "-c", script], cwd=self.workspace, text=True,
                              env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              check=False)
        return done.returncode, done.stdout

    def path(self, name):
        assert not os.path.isabs(name) and ".." not in name, name
        return os.path.join(self.workspace, name)

    def restore(self, key, path):
        there = os.path.exists(os.path.join(self.caches, key))
        if there:
            shutil.copytree(os.path.join(self.caches, key), self.path(path), symlinks=True)
        return there

    def keep(self, key, path):
        if os.path.exists(self.path(path)) and not os.path.exists(os.path.join(self.caches, key)):
            shutil.copytree(self.path(path), os.path.join(self.caches, key), symlinks=True)

    def upload(self, path):
        if os.path.exists(self.path(path)):
            shutil.copytree(self.path(path), os.path.join(self.artifacts, path))


class GitHub(Service):
    """docs.github.com/actions: a step is `run` or `uses`; after one failed, `if: always()` runs."""

    file = ".github/workflows/simbench.yml"

    def run_job(self):
        with open(self.path(self.file), encoding="utf-8") as file:
            workflow = yaml.safe_load(file)
        # YAML 1.1 takes the word `on` for true.
        known(workflow, "name", True, "permissions", "jobs")
        assert set(workflow[True]) == {"pull_request", "push"}
        assert workflow["permissions"] == {"contents": "read"}
        (job,) = workflow["jobs"].values()
        known(job, "runs-on", "container", "defaults", "env", "steps")
        self.job_environment = {name: str(value) for name, value in job["env"].items()}
        self.hits, self.status, self.log = {}, 0, ""
        summary = os.path.join(self.folder, "step_summary.md")
        with open(summary, "w", encoding="utf-8"):
            pass
        is_bash = job.get("defaults") == {"run": {"shell": "bash"}}
        options = ("--noprofile", "--norc", "-e", "-o", "pipefail") if is_bash else ("-e",)
        for step in job["steps"]:
            if self.is_due(step.get("if", "success()")):
                self.run_step(step, options, summary)
        with open(summary, encoding="utf-8") as file:
            return Run(self.status, self.log, file.read(), self.artifacts)

    def is_due(self, condition):
        if condition == "always()":
            return True
        if condition == "success()":
            return self.status == 0
        miss = re.fullmatch(r"(always\(\) && )?steps\.(\w+)\.outputs\.cache-hit != 'true'", condition)
        assert miss, condition
        return (self.status == 0 or bool(miss[1])) and not self.hits[miss[2]]

    def filled(self, text):
        def value(match):
            context, name = match[1].split(".")
            return {"env": self.job_environment, "runner": {"arch": "X64"}}[context][name]

        return re.sub(r"\$\{\{ ([a-z]+\.\w+) \}\}", value, text)

    def run_step(self, step, options, summary):
        assert ("run" in step) != ("uses" in step), step
        if "uses" in step:
            self.use(known(step, "uses", "with", "if", "id", "name"))
            return
        known(step, "name", "run", "if", "env")
        environment = {**self.environment, "CI": "true", "GITHUB_ACTIONS": "true",
                       "GITHUB_STEP_SUMMARY": summary, "GITHUB_WORKSPACE": self.workspace,
                       **self.job_environment, **step.get("env", {})}
        status, log = self.shell(self.filled(step["run"]), environment, options)
        self.log += log
        self.status = self.status or status

    def use(self, step):
        action, _, version = step["uses"].partition("@")
        assert re.fullmatch(r"v[0-9]+", version), step
        inputs = {name: self.filled(text) for name, text in step.get("with", {}).items()}
        if action == "actions/cache/restore":
            known(inputs, "path", "key")
            self.hits[step["id"]] = self.restore(inputs["key"], inputs["path"])
        elif action == "actions/cache/save":
            self.keep(known(inputs, "path", "key")["key"], inputs["path"])
        elif action == "actions/upload-artifact":
            self.upload(known(inputs, "name", "path")["path"])
        else:
            assert action == "actions/checkout", action  # done by run()


class GitLab(Service):
    """docs.gitlab.com/ci/yaml: the lines of before_script and script are one script of bash."""

    file = ".gitlab-ci.yml"

    def run_job(self):
        with open(self.path(self.file), encoding="utf-8") as file:
            (job,) = yaml.safe_load(file).values()
        known(job, "image", "stage", "variables", "cache", "before_script", "script", "artifacts")
        known(job["cache"], "key", "paths", "when")
        known(job["artifacts"], "when", "paths", "reports")
        assert job["cache"]["when"] == job["artifacts"]["when"] == "always"
        variables = {"CI": "true", "GITLAB_CI": "true", "CI_JOB_TOKEN": "secret-of-the-job",
                     "CI_PROJECT_DIR": self.workspace}
        for name, value in job["variables"].items():
            variables[name] = string.Template(str(value)).safe_substitute(variables)
        key = string.Template(job["cache"]["key"]).substitute(variables)
        (path,) = job["cache"]["paths"]
        self.restore(key, path)
        status, log = self.shell("\n".join(job.get("before_script", []) + job["script"]),
                                 {**self.environment, **variables}, ("-e", "-o", "pipefail"))
        shutil.rmtree(os.path.join(self.caches, key), ignore_errors=True)  # it is written anew
        self.keep(key, path)
        for uploaded in job["artifacts"]["paths"]:
            self.upload(uploaded)
        folder, _, pattern = job["artifacts"]["reports"]["junit"].partition("/")
        assert folder in job["artifacts"]["paths"] and pattern == "*.xml"
        summary = os.path.join(self.artifacts, folder, "summary.md")
        text = ""
        if os.path.exists(summary):
            with open(summary, encoding="utf-8") as file:
                text = file.read()
        return Run(status, log, text, self.artifacts)

"""package.py BUILD WORK: makes the Debian package of a build folder, unpacks it into an empty folder, and runs the program from
there as a user does who has installed it, from another folder. Nothing is installed on this machine."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

BUILD, WORK = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
ROOT = WORK / "root"
ELSEWHERE = WORK / "elsewhere"


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit {done.returncode}\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    return done.stdout


def expect(holds, what):
    print(("ok: " if holds else "WRONG: ") + what, flush=True)
    if not holds:
        sys.exit(1)


for tool in ("dpkg-deb", "dpkg-shlibdeps"):
    if shutil.which(tool) is None:
        print(f"skipped: {tool} is not installed: the package dpkg-dev has it")
        sys.exit(77)

shutil.rmtree(WORK, ignore_errors=True)
ELSEWHERE.mkdir(parents=True)
run("cpack", "-G", "DEB", "-B", WORK, "--config", BUILD / "CPackConfig.cmake", cwd=BUILD)
(package,) = WORK.glob("*.deb")
run("dpkg-deb", "-x", package, ROOT)

fields = run("dpkg-deb", "-f", package)
depends = next(line for line in fields.splitlines() if line.startswith("Depends:"))
expect("libc6" in depends and "libtbb12" in depends, "the package depends on the libraries that the program is linked with")

program = ROOT / "usr/bin/raytruth"
as_user = {"cwd": ELSEWHERE, "env": {**os.environ, "RAYTRUTH_DATA": ""}}
expect(run(program, "--version", **as_user).startswith("raytruth "), "--version")
names = [entry["name"] for entry in json.loads(run(program, "list", "experiments", "--json", **as_user))]
expect("eta" in names and len(names) > 40, "the installed experiments are found")
run(program, "run", "eta", "--profile", "quick", "-o", "out", **as_user)
expect(len(json.loads((ELSEWHERE / "out/eta.json").read_text())["rows"]) > 0, "an installed experiment runs by its name")
share = ROOT / "usr/share"
for name in ("man/man1/raytruth.1.gz", "man/man1/raytruth-run.1.gz", "bash-completion/completions/raytruth", "doc/raytruth/copyright",
             "doc/raytruth/changelog.gz", "raytruth/experiments/schemas/names.json", "raytruth/experiments/launch/slurm.sh"):
    expect((share / name).is_file(), name)
for name in ("include/raytruth/core/chain.hpp", "include/raytruth/rules/README.md", "include/raytruth/rules/prelude.glsl"):
    expect((ROOT / "usr" / name).is_file(), name)
expect(not list(ROOT.rglob("node_modules")), "nothing of npm is in it")

modules = ROOT / "usr/lib/python3/dist-packages"
if "Python module: yes" in run(program, "--version", **as_user):
    script = "import raytruth; print(raytruth.slab({'points': [{'s': 0, 'extinction': 1, 'color': [1, 1, 1]}]}, 0, 1).opacity)"
    python = {**as_user, "env": {**as_user["env"], "PYTHONPATH": str(modules)}}
    expect(run("/usr/bin/python3", "-c", script, **python).startswith("0.63212"), "the Python module is imported")
    expect((modules / "raytruth.pyi").is_file(), "raytruth.pyi")

if shutil.which("apt-get"):
    simulated = run("apt-get", "-s", "install", "--no-install-recommends", package.resolve())
    expect("Inst raytruth" in simulated, "apt-get would install it")
if shutil.which("lintian"):
    errors = [line for line in run("lintian", "--fail-on", "none", package).splitlines() if line.startswith("E:")]
    expect(not errors, "lintian has no errors" + "".join("\n  " + line for line in errors))
else:
    print("lintian is not installed: the package of its name has it")

"""`raytruth run --shard` and `raytruth merge`: parts that come to the bytes of one run, and the engines that start them."""

import hashlib
import json
import os
import pathlib
import random
import re
import shlex
import shutil
import signal
import socket
import subprocess
import time
import unittest

from support import EXPERIMENT, PROGRAM, SOURCE, STUDY, ProgramTest, changed

VOLUME = {"name": "own", "kind": "volume", "volume": "v.nrrd"}
# Units are alike, and each takes a moment: blocks of rays that the reference and Arb integrate.
PROOF = {
    "raytruth": "experiment/1",
    "name": "proof",
    "question": "Does the radius enclose the truth?",
    "source": "none",
    "measures": [{"kind": "reference_proof", "pieces": 0, "rays": 40, "blocks": 40}],
}


def compact(text):
    """JSON without the white space between its tokens; numbers keep their digits."""
    return re.sub(r'("(?:[^"\\]|\\.)*")|\s+', lambda found: found[1] or "", text)


def members(text):
    """The members of a compact JSON object, each as text."""
    found, at = {}, 1
    decoder = json.JSONDecoder()
    while text[at] != "}":
        name, at = decoder.raw_decode(text, at + (text[at] == ","))
        _, end = decoder.raw_decode(text, at + 1)
        found[name], at = text[at + 1 : end], end
    return found


def object_of(texts):
    return "{" + ",".join(f"{json.dumps(name)}:{text}" for name, text in texts.items()) + "}"


def with_digests(text):
    """A part with the digests that its content has."""
    parts = members(compact(text))
    rest = {name: text for name, text in parts.items() if name not in ("experiment", "build", "digests")}
    digests = {"experiment": parts["experiment"], "build": parts["build"], "rows": object_of(rest)}
    parts["digests"] = json.dumps({name: hashlib.sha256(text.encode()).hexdigest() for name, text in digests.items()})
    return object_of(parts)


def header(size):
    return f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {size} {size} {size}\nencoding: raw\n\n".encode()


class ShardTest(ProgramTest):
    """`small.json` has four units: two measures of two fields."""

    def setUp(self):
        super().setUp()
        self.write("small.json", EXPERIMENT)

    def shard(self, text, *arguments, experiment="small.json", folder="parts", **options):
        return self.run_program("run", experiment, "--shard", text, "-o", folder, *arguments, **options)

    def shards(self, count, *arguments, numbers=None, **options):
        for number in numbers or range(1, count + 1):
            done = self.shard(f"{number}/{count}", *arguments, **options)
            self.assertEqual(done.returncode, 0, done.stderr)

    def whole(self, *arguments, experiment="small.json"):
        return self.output_of("run", experiment, "--without-times", *arguments)

    def merged(self, *arguments):
        self.output_of("merge", *arguments, "-o", "merged.json", "--without-times")
        return (self.folder / "merged.json").read_text()

    def assert_merge_refused(self, *expected, places=("parts",), code=2, options=()):
        (self.folder / "merged.json").unlink(missing_ok=True)
        self.assert_refused(self.run_program("merge", *places, "-o", "merged.json", *options), *expected, code=code)
        self.assertFalse((self.folder / "merged.json").exists())

    def part(self, text, name="small", folder="parts"):
        return self.folder / folder / f"{name}.{text.replace('/', '-of-')}.part"

    def forge(self, text, old, new):
        """Another part, with digests that fit: of its units where they hold what is to be replaced."""
        part = self.part(text)
        before = compact(part.read_text())
        at = max(before.find(old, before.index('"units":[')), before.find(old))
        self.assertGreaterEqual(at, 0, old)
        part.write_text(with_digests(before[:at] + before[at:].replace(old, new, 1)))


class Merging(ShardTest):
    def test_any_number_of_shards_makes_the_bytes_of_one_run(self):
        whole = self.whole()
        for count in (1, 2, 7):
            with self.subTest(count):
                self.shards(count, folder=f"parts{count}")
                self.assertEqual(self.merged(f"parts{count}"), whole)

    def test_a_thousand_shards_of_four_units(self):
        # The k-th does units from floor(4 (k - 1) / 1000) to floor(4 k / 1000), so most do none.
        self.shards(1000, numbers=[1, 2, 250, 251, 500, 750, 999, 1000])
        self.assertEqual(self.merged("parts"), self.whole())
        self.assertEqual(json.loads(self.part("1/1000").read_text())["units"], [])

    def test_shards_of_blocks(self):
        self.write("proof.json", PROOF)
        whole = self.whole("-j", "1", experiment="proof.json")
        self.shards(1000, "-j", "1", numbers=range(25, 1001, 25), experiment="proof.json")
        self.assertEqual(self.merged("parts"), whole)
        self.assertEqual(len(list((self.folder / "parts").iterdir())), 40)

    def test_any_order_and_any_folders(self):
        self.shards(3)
        self.shards(4, numbers=[4], folder="other")
        parts = [*(self.folder / "parts").iterdir(), *(self.folder / "other").iterdir()]
        whole = self.whole()
        for seed in range(4):
            random.Random(seed).shuffle(parts)
            self.assertEqual(self.merged(*parts), whole)
        self.assertEqual(self.merged("other", "parts"), whole)

    def test_parts_that_repeat_each_other(self):
        self.shards(2)
        self.shards(3)
        self.shards(1, folder="other")
        self.assertEqual(self.merged("parts", "other", "parts"), self.whole())
        self.forge("2/3", '"value_error_max":', '"value_error_max":-')
        self.assert_merge_refused("small.2-of-3.part: found the unit white/cell_cubic with the value_error_max -", "small.1-of-2.part", "one of both is wrong")

    def test_conclusions_and_quick_versions(self):
        orders = SOURCE / "experiments/orders.json"
        self.shards(2, "--profile", "quick", experiment=orders)
        self.assertEqual(self.merged("parts"), self.whole("--profile", "quick", experiment=orders))

    def test_seeds(self):
        self.shards(2, "--seed", "5")
        self.assertEqual(self.merged("parts"), self.whole("--seed", "5"))

    def test_the_provenance_says_what_its_times_are(self):
        self.shards(7, "-j", "1")
        done = self.run_program("merge", "parts", "-o", "merged.json", "--check")
        self.assertEqual(done.returncode, 0)
        self.assertIn(b"reproduced", done.stderr)
        merged = json.loads((self.folder / "merged.json").read_text())
        provenance = merged["provenance"]
        units = [unit for part in (self.folder / "parts").iterdir() for unit in json.loads(part.read_text())["units"]]
        self.assertAlmostEqual(provenance.pop("seconds"), sum(unit["seconds"] for unit in units), places=9)
        self.assertEqual((provenance.pop("parts"), provenance.pop("threads")), (7, 1))
        provenance.pop("started")
        self.assertEqual(merged, json.loads(self.whole()))

    def test_the_result_goes_into_a_folder_too(self):
        self.shards(1)
        (self.folder / "out").mkdir()
        self.output_of("merge", "parts", "-o", "out")
        self.assertTrue((self.folder / "out/small.json").is_file())

    def test_bounds(self):
        self.write("small.json", changed(EXPERIMENT, "/checks/0/at_most", -1))
        self.shards(1)
        self.assertEqual(self.run_program("merge", "parts", "-o", "merged.json", "--check").returncode, 1)

    def test_files_that_the_experiment_names(self):
        (self.folder / "in").mkdir()
        shutil.copy(SOURCE / "tests/cases/paraview_xml_map/t.xml", self.folder / "in")
        self.write("in/small.json", changed(STUDY, "/transfer_functions/1/transfer_function", {"file": "t.xml", "range": [0, 1]}))
        self.shards(2, experiment="in/small.json")
        self.assertEqual(self.merged("parts"), self.whole(experiment="in/small.json"))
        (self.folder / "in/t.xml").unlink()
        self.assert_merge_refused("study.1-of-2.part: /experiment: in/small.json: /transfer_functions/1/transfer_function", "t.xml")


class Places(ShardTest):
    def test_a_name_without_extension_is_a_folder(self):
        self.shards(1)
        for _ in range(2):  # made first, and then there
            self.output_of("merge", "parts", "-o", "out", "--without-times")
            self.assertEqual((self.folder / "out/small.json").read_text(), self.whole())
        self.output_of("merge", "parts", "-o", "out.json", "--without-times")
        self.assertEqual((self.folder / "out.json").read_text(), self.whole())


class Missing(ShardTest):
    def test_missing_units_are_named_with_the_command_that_makes_them(self):
        (self.folder / "a b").mkdir()
        (self.folder / "small.json").rename(self.folder / "a b/small.json")
        options = ("--profile", "quick", "--seed", "3")
        self.shards(4, *options, numbers=[2], experiment="a b/small.json")
        for missing in (3, 2, 1):
            done = self.run_program("merge", "parts", "-o", "merged.json")
            self.assert_refused(done, f"{missing} of 4 units are missing: ", "this makes the first: raytruth run 'a b/small.json'", code=3)
            words = done.stderr.decode().partition("this makes the first: ")[2].partition(";")[0]
            self.assertEqual(self.run_program(*shlex.split(words)[1:]).returncode, 0, words)
        self.assertEqual(self.merged("parts"), self.whole(*options, experiment="a b/small.json"))

    def test_many_missing_units_are_told_in_one_short_line(self):
        self.write("proof.json", changed(PROOF, "/measures/0/blocks", 1000))
        self.shards(500, numbers=[7], experiment="proof.json")
        self.assert_merge_refused("998 of 1000 units are missing: reference_proof/0, ", "and 994 more; ", "--shard 1/500 ",
                                  "; so do the shards 2-6, 8-500", code=3)

    def test_an_empty_folder(self):
        (self.folder / "parts").mkdir()
        self.assert_merge_refused("parts: found no part", "--shard K/N")
        self.assert_merge_refused("none.part", places=["none.part"])


class Refusals(ShardTest):
    def test_parts_of_another_seed_experiment_or_profile(self):
        self.shards(2, numbers=[1])
        for other, word in (("--seed", "2"), '"seed": 2'), (("--profile", "quick"), '"rays": '):
            with self.subTest(other):
                self.shards(2, *other, numbers=[2])
                self.assert_merge_refused("small.2-of-2.part: found ", word, "small.1-of-2.part")
        self.write("other.json", changed(EXPERIMENT, "/name", "other"))
        self.part("2/2").unlink()
        self.shards(2, numbers=[2], experiment="other.json")
        self.assert_merge_refused('"name": ', "parts of one experiment")

    def test_parts_of_another_build(self):
        self.shards(2)
        commit = json.loads(self.part("1/2").read_text())["build"]["commit"]
        for number in (2, 1):
            self.forge(f"{number}/2", commit, "0" * 40)
            self.assert_merge_refused(f"small.{number}-of-2.part: found \"commit\": ", "0" * 40, commit[:20], "this program" if number == 1 else "small.1-of-2.part")

    def test_parts_of_another_processor(self):
        self.shards(2)
        cpu = json.loads(self.part("1/2").read_text())["build"]["cpu"]
        self.forge("2/2", json.dumps(cpu), '"Another 9000"')
        self.assert_merge_refused("Another 9000", cpu, "--mixed-cpus")
        mixed = json.loads(self.merged("parts", "--mixed-cpus"))
        self.assertEqual(sorted(mixed["provenance"]["cpu"].split("; ")), sorted([cpu, "Another 9000"]))
        self.assertEqual(mixed["rows"], json.loads(self.whole())["rows"])

    def test_parts_that_were_tampered_with(self):
        self.shards(1)
        text = self.part("1/1").read_text()
        for name, old, new in [("rows", '"status":"ok"', '"status":"OK"'), ("rows", '"profile": "full"', '"profile": "quick"'),
                               ("experiment", '"seed": 1', '"seed": 2'), ("build", '"version": "', '"version": "9')]:
            with self.subTest(new):
                self.assertIn(old, text)
                self.part("1/1").write_text(text.replace(old, new, 1))
                self.assert_merge_refused("small.1-of-1.part: /digests/" + name)
        self.part("1/1").write_text(text[: len(text) // 2])
        self.assert_merge_refused("small.1-of-1.part: line ")

    def test_parts_that_do_not_fit_though_their_digests_do(self):
        self.shards(1)
        text = self.part("1/1").read_text()
        for old, new, words in [
            ('"name":"white/cell_cubic"', '"name":"white/other"', 'the unit "white/other"'),
            ('"field":"white"', '"field":"smooth"', "a row of another measure or field"),
            ('"xi_p50":', '"xi":', 'the column "xi"'),
            ('"status":"ok"', '"status":[]', "/units/0/rows/0/status"),
            ('"rows":[', '"refused":"","rows":[', "/refused"),
            ('"name":"small"', '"name":"../small"', "/experiment: "),
            ('"kind":"cell_cubic"', '"kind":"cell_cubik"', "perhaps cell_cubic"),
            ('"seconds":', '"seconds":-1', "/units/0/seconds"),
            ('"started":"2', '"started":"x', "/started"),
            ('"raytruth":"part/1"', '"raytruth":"part/2"', "/raytruth"),
        ]:
            with self.subTest(new):
                self.part("1/1").write_text(text)
                self.forge("1/1", old, new)
                self.assert_merge_refused("small.1-of-1.part: ", words)

    def test_volumes_that_differ_between_machines(self):
        self.write("small.json", changed(EXPERIMENT, "/fields/1", {**VOLUME, "name": "smooth"}))
        for number, value in (1, 100), (2, 200):
            self.write("v.nrrd", header(8) + bytes(511) + bytes([value]))
            self.shards(4, numbers=[2 * number - 1, 2 * number])
        self.part("3/4").unlink()
        self.write("v.nrrd", header(8) + bytes(511) + bytes([100]))
        self.shards(4, numbers=[3])
        self.assert_merge_refused("found the field smooth as ", '"data_max":200', '"data_max":100', "the same volume on all machines")

    def test_a_part_is_not_overwritten(self):
        self.shards(1)
        part = self.part("1/1")
        before = part.read_bytes()
        self.assert_refused(self.run_program("merge", "parts", "-o", part), "found a part where the result would go")
        self.assertEqual(part.read_bytes(), before)

    def test_options(self):
        for shard in "0/3", "4/3", "1/0", "-1/3", "1", "1/3/5", "1/x", "1 / 3", "1/99999999999":
            self.assert_refused(self.shard(shard), "--shard", "3/64")
        self.assert_refused(self.run_program("run", "small.json", "--shard", "1/2"), "-o DIR")
        for option in "--check", "--without-times":
            self.assert_refused(self.shard("1/2", option), option, "merge")
        self.assertEqual(self.names_in_folder(), ["small.json"])
        self.shards(1)
        for share in "0%", "101%", "1", "-1%", "nan%", "x":
            self.assert_merge_refused("--recheck", options=["--recheck", share])


class Rechecking(ShardTest):
    def test_units_are_done_again(self):
        self.shards(2)
        done = self.run_program("merge", "parts", "-o", "merged.json", "--recheck", "1%")
        self.assertEqual(done.returncode, 0)
        self.assertIn(b"1 of 4 units were done again, and came out the same", done.stderr)
        self.assertIn(b"4 of 4", self.run_program("merge", "parts", "-o", "merged.json", "--recheck", "100%").stderr)

    def test_a_forged_row_is_found(self):
        self.shards(2)
        self.forge("2/2", '"value_error_max":', '"value_error_max":-')
        self.merged("parts")  # whose digests and form fit
        self.assert_merge_refused("small.2-of-2.part: found the unit smooth/cell_cubic with the value_error_max -", options=["--recheck", "100%"])

    def test_what_cannot_be_done_again_here_is_told(self):
        self.write("v.nrrd", header(8) + bytes(range(256)) * 2)
        self.write("small.json", changed(EXPERIMENT, "/fields", [VOLUME]) | {"published": [], "checks": []})
        self.shards(1)
        (self.folder / "v.nrrd").unlink()
        done = self.run_program("merge", "parts", "-o", "merged.json", "--recheck", "100%")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(b"own/signal_error: not done again", done.stderr)
        self.assertIn(b"0 of 2 units were done again", done.stderr)


class Interruption(ShardTest):
    def test_a_killed_shard_loses_only_its_unit(self):
        # So many rays that a unit lasts for seconds.
        self.write("small.json", changed(EXPERIMENT, "/rays/count", 20000))
        journal = self.folder / "parts/.small.1-of-1.journal"
        command = [PROGRAM, "run", "small.json", "--shard", "1/1", "-o", "parts", "-j", "1"]
        running = subprocess.Popen(command, cwd=self.folder, stderr=subprocess.DEVNULL)
        while running.poll() is None and not (journal.exists() and journal.read_bytes().count(b"\n") >= 2):
            time.sleep(0.002)
        self.assertIsNone(running.poll(), "the shard was too fast to be interrupted")
        running.send_signal(signal.SIGKILL)
        running.wait()
        self.assertFalse(self.part("1/1").exists())
        # The last line may be torn, and counts for nothing then.
        kept = [json.loads(line)["part"]["seconds"] for line in journal.read_text().split("\n")[1:-1]]
        self.assertGreater(len(kept), 0)
        self.shards(1, "-j", "1")
        self.assertFalse(journal.exists())
        units = json.loads(self.part("1/1").read_text())["units"]
        self.assertEqual([unit["seconds"] for unit in units][: len(kept)], kept)
        self.assertEqual(self.merged("parts"), self.whole())

    def test_a_finished_part_stays_and_a_damaged_one_is_made_again(self):
        self.shards(2, numbers=[1])
        part = self.part("1/2")
        before = part.read_text()
        self.shards(2, numbers=[1])
        self.assertEqual(part.read_text(), before)
        part.write_text(before.replace('"status":"ok"', '"status":"no"', 1))
        done = self.shard("1/2")
        self.assertIn(b"starting afresh", done.stderr)
        self.assertEqual(json.loads(part.read_text())["units"][0]["rows"], json.loads(before)["units"][0]["rows"])
        done = self.shard("1/2", "--seed", "9")
        self.assertIn(b"belongs to another experiment or build: starting afresh", done.stderr)

    def test_absent_volumes(self):
        self.write("small.json", changed(EXPERIMENT, "/fields/2", VOLUME))
        self.shards(3)
        self.assertEqual(self.merged("parts"), self.whole())
        self.assertIn('"status": "refused"', json.dumps(json.loads(self.whole())["fields"]["own"]))
        # Once it is there, its units alone are done.
        self.write("v.nrrd", header(8) + bytes(range(256)) * 2)
        before = self.part("1/3").read_bytes()
        self.shards(3)
        self.assertEqual(self.part("1/3").read_bytes(), before)
        self.assertEqual(self.merged("parts"), self.whole())

    def test_ctrl_c_names_what_goes_on(self):
        self.write("small.json", changed(EXPERIMENT, "/rays/count", 2000000))
        command = [PROGRAM, "run", "small.json", "--shard", "1/2", "-o", "parts"]
        running = subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE)
        time.sleep(0.5)
        running.send_signal(signal.SIGINT)
        self.assertIn("raytruth run small.json --shard 1/2 -o parts\n", running.communicate()[1].decode())


class SlurmCluster:
    """A cluster of this machine alone, in a folder of its own: munged, slurmctld and slurmd live as long as the block."""

    def __init__(self, folder, environment):
        self.folder, self.configuration = folder, str(folder / "slurm.conf")
        self.environment = {**environment, "SLURM_CONF": self.configuration}
        self.processes = []

    def __enter__(self):
        for name in ("", "state", "spool"):
            (self.folder / name).mkdir()
        self.folder.chmod(0o700)
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        host = socket.gethostname().partition(".")[0]
        with socket.socket() as one, socket.socket() as two:  # ports that are free
            one.bind(("127.0.0.1", 0))
            two.bind(("127.0.0.1", 0))
            ports = one.getsockname()[1], two.getsockname()[1]
        here = self.folder
        pathlib.Path(self.configuration).write_text(f"""
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
AuthType=auth/munge
AuthInfo=socket={here}/munge.socket
SlurmUser=root
StateSaveLocation={here}/state
SlurmdSpoolDir={here}/spool
SlurmctldPidFile={here}/slurmctld.pid
SlurmdPidFile={here}/slurmd.pid
SlurmctldLogFile={here}/slurmctld.log
SlurmdLogFile={here}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SchedulerType=sched/builtin
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
MpiDefault=none
NodeName={host} NodeAddr=127.0.0.1 CPUs={os.cpu_count()} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
""")
        try:
            self.start("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={here}/munge.socket",
                       f"--pid-file={here}/munge.pid", f"--log-file={here}/munge.log", f"--seed-file={here}/munge.seed")
            self.await_that(lambda: (here / "munge.socket").exists())
            self.start("slurmctld", "-D", "-i")
            self.await_that(lambda: self.says("scontrol", "ping", "UP"))
            self.start("slurmd", "-D", "-N", host)
            self.await_that(lambda: self.says("sinfo", "--noheader", "idle"))
        except BaseException:
            self.end()
            raise
        return self

    def __exit__(self, *_):
        self.end()

    def start(self, *command):
        self.processes.append(subprocess.Popen(command, cwd=self.folder, env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))

    def says(self, *command_and_word):
        *command, word = command_and_word
        return word in subprocess.run(command, env=self.environment, capture_output=True, text=True, check=False).stdout

    def await_that(self, condition):
        end = time.monotonic() + 60
        while not condition():
            for process in self.processes:
                if process.poll() is not None:
                    raise AssertionError(f"{process.args[0]} ended with {process.returncode}")
            if time.monotonic() > end:
                raise AssertionError("Slurm does not come up: " + self.log())
            time.sleep(0.1)

    def log(self):
        return "".join(path.read_text()[-2000:] for path in self.folder.glob("*.log"))

    def end(self):
        for process in reversed(self.processes):
            process.terminate()
            process.wait()


class Launchers(ShardTest):
    """The recipes of experiments/launch, where what they start is installed: `packages_to_launch` of .ci/prepare.sh."""

    recipes = SOURCE / "experiments/launch"

    def setUp(self):
        super().setUp()
        (self.folder / "bin").mkdir()
        (self.folder / "bin/raytruth").symlink_to(PROGRAM)
        self.environment = {**os.environ, "RAYTRUTH_DATA": "", "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}:/usr/sbin"}
        self.write("proof.json", PROOF)

    def need(self, *programs):
        for program in programs:
            if shutil.which(program, path=self.environment["PATH"]) is None:
                self.skipTest(f"{program} is not installed")

    def launch(self, *command, fails=False, **environment):
        done = subprocess.run(list(map(str, command)), cwd=self.folder, capture_output=True, text=True, timeout=300,
                              env={**self.environment, **environment}, check=False)
        self.assertEqual(done.returncode != 0, fails, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def assert_whole(self):
        self.assertEqual(self.merged("parts"), self.whole(experiment="proof.json"))

    def assert_resumes(self, *command, **environment):
        """A part that is lost is made again, and the others stay."""
        parts = sorted((self.folder / "parts").glob("*.part"))
        before = {part: part.stat().st_mtime_ns for part in parts}
        parts[0].unlink()
        self.launch(*command, **environment)
        after = {part: part.stat().st_mtime_ns for part in parts}
        self.assertEqual([part for part in parts if before[part] != after[part]], [parts[0]])
        self.assert_whole()

    def test_every_recipe_is_a_program_of_bash(self):
        recipes = sorted(self.recipes.iterdir())
        self.assertEqual([recipe.name for recipe in recipes], ["mpi.sh", "parallel.sh", "slurm.sh"])
        for recipe in recipes:
            self.assertTrue(os.access(recipe, os.X_OK), recipe)
            subprocess.run(["bash", "-n", recipe], check=True)

    def test_ranks_share_all_shards(self):
        for rank in range(3):
            for names in ("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"), ("PMI_RANK", "PMI_SIZE"), ("SLURM_PROCID", "SLURM_NTASKS"):
                self.launch(self.recipes / "mpi.sh", "proof.json", 8, f"parts{names[0]}", **dict(zip(names, (str(rank), "3"))))
        for folder in self.folder.glob("parts*"):
            self.assertEqual(len(list(folder.iterdir())), 8)
            self.assertEqual(self.merged(folder), self.whole(experiment="proof.json"))
        self.assertIn("start this by mpirun or srun", self.launch(self.recipes / "mpi.sh", "proof.json", 8, "parts", fails=True))

    def test_gnu_parallel(self):
        self.need("parallel")
        command = [self.recipes / "parallel.sh", "proof.json", 8, "parts", "--jobs", 2]
        self.launch(*command)
        self.assert_whole()
        self.assertEqual(len((self.folder / "parts/joblog").read_text().splitlines()), 9)
        # What failed is done again, and nothing else is.
        self.part("3/8", "proof").unlink()
        (self.folder / "bin/raytruth").unlink()
        (self.folder / "bin/raytruth").write_text(f'#!/bin/sh\n[ "$6" != 3/8 ] || exit 1\nexec {PROGRAM} "$@"\n')
        (self.folder / "bin/raytruth").chmod(0o755)
        (self.folder / "parts/joblog").unlink()
        self.launch(*command, fails=True)
        self.assertFalse(self.part("3/8", "proof").exists())
        (self.folder / "bin/raytruth").unlink()
        (self.folder / "bin/raytruth").symlink_to(PROGRAM)
        self.launch(*command)
        self.assert_whole()

    def test_slurm(self):
        self.need("munged", "slurmctld", "slurmd", "sbatch")
        if os.geteuid() != 0:
            self.skipTest("slurmctld and slurmd start jobs as root only")
        command = ["sbatch", "--wait", "--array=1-8", "--output=/dev/null", self.recipes / "slurm.sh", "proof.json", 8, "parts"]
        with SlurmCluster(self.folder / "slurm", self.environment) as cluster:
            self.launch(*command, SLURM_CONF=cluster.configuration)
            self.assert_whole()
            self.assert_resumes(*command, SLURM_CONF=cluster.configuration)
            # One shard of the array alone.
            self.part("3/8", "proof").unlink()
            self.launch(*[word if word != "--array=1-8" else "--array=3" for word in command], SLURM_CONF=cluster.configuration)
            self.assert_whole()

    def test_open_mpi(self):
        self.need("mpirun")
        # Open MPI starts as root, and on one core, only when told to.
        command = ["mpirun", "-n", 2, "--oversubscribe", self.recipes / "mpi.sh", "proof.json", 8, "parts"]
        root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        self.launch(*command, **root)
        self.assert_whole()
        self.assert_resumes(*command, **root)

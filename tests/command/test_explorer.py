"""plots/explorer.html: what its engine computes is what the program computes, its lit slabs are the program's, and a browser
opens it, wide and narrow."""

import copy
import json
import re
import shutil
import subprocess
import sys
import unittest

from support import PROGRAM, RAY, SOURCE, ProgramTest, changed
from test_rules import Server

sys.path.insert(0, str(SOURCE / "src/explorer"))
import make_page

PAGE = SOURCE / "plots/explorer.html"
LIKE = 1e-12  # the engine rounds as 128-bit registers do, and with sines of another library

POINTS = [
    {"s": 0, "extinction": 0, "color": [0, 0.1, 0.9]},
    {"s": 0.4, "extinction": 0, "color": [0.9, 0.5, 0.2]},
    {"s": 0.5, "extinction": 5, "color": [0.3, 0.9, 0.2]},
    {"s": 0.6, "extinction": 0, "color": [0.1, 0.5, 1]},
]
OPACITIES = {
    "unit_length": 1,
    "points": [{"s": s, "opacity": opacity, "color": [s, 0.5, 1 - s]} for s, opacity in ((0, 0), (0.3, 0.9), (0.5, 0.1), (1, 1))],
}
CELL = {
    "kind": "trilinear",
    "volume": {"size": [2, 2, 2], "values": [0.1, 0.9, 0.3, 0.6, 0.7, 0.2, 0.9, 0.4]},
    "origin": [0, 0.15, 0.2],
    "direction": [1, 0.65, 0.7],
    "length": 1.3,
}
MARSCHNER_LOBB = {
    "kind": "trilinear",
    "volume": {"kind": "marschner_lobb", "samples": 41},
    "origin": [20, 20, 20],
    "direction": [0.8, 0.5, 0.1],
    "length": 12,
}
POLYNOMIAL = {"kind": "piecewise_polynomial", "breaks": [0, 1, 2.5], "coefficients": [[0.1, 1.2, -0.9, 0.3], [0.7, -0.8, 0.9, -0.2]]}

# Answers to requests by an engine: node gives {"engine", "binary", "requests"} to it. A request is a case for `eval`, and a
# phase.
ANSWER = """
const { engine, binary, requests } = JSON.parse(require("fs").readFileSync(0, "utf8"));
const make = new Function("require", "__filename", "__dirname", "process", engine + "; return make_explorer;");
make(require, "", "", process)({ wasmBinary: require("zlib").gunzipSync(Buffer.from(binary, "base64")) }).then((made) => {
  const list = (numbers, whole) => {
    const typed = whole ? Int32Array.from(numbers) : Float64Array.from(numbers);
    const place = made._malloc(typed.byteLength);
    made.HEAPU8.set(new Uint8Array(typed.buffer), place);
    return place;
  };
  const read = (place) => JSON.parse(made.UTF8ToString(place));
  const answers = requests.map(({ request, phase }) => {
    const { signal, transfer_function, emission } = request;
    let given;
    if (signal.kind === "trilinear") {
      const ray = list([...signal.origin, ...signal.direction, signal.length]);
      const { volume } = signal;
      given = volume.kind ? made._explorer_marschner_lobb(volume.samples, ray) : made._explorer_trilinear(list(volume.size, true), list(volume.values), ray);
    } else {
      const rows = signal.coefficients;
      given = made._explorer_polynomials(rows.length, list(signal.breaks), rows[0].length, list(rows.flat()));
    }
    const refusal = read(given).error;
    if (refusal) return { error: refusal };
    const points = transfer_function.points.flatMap((point) => [point.s, point.extinction ?? point.opacity, ...point.color]);
    const taken = read(made._explorer_transfer(points.length / 5, list(points), transfer_function.unit_length ?? 0, emission === "plain" ? 1 : 0));
    if (taken.error) return taken;
    return read(made._explorer_answer(request.sampling.step, phase));
  });
  process.stdout.write(JSON.stringify({ schemes: read(made._explorer_schemes()), answers }));
});
"""

# What a page does when it has been opened: it is used, and tells what it shows.
USE = """
<script>
const problems = [];
addEventListener("error", (event) => problems.push(event.message));
addEventListener("unhandledrejection", (event) => problems.push(String(event.reason)));
for (const kind of ["error", "warn"]) console[kind] = (...words) => problems.push(words.join(" "));
addEventListener("load", async () => {
  await explorer.ready;
  const frame = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  const seen = [];
  const look = async () => {
    await frame();
    const rows = Object.fromEntries([...document.querySelectorAll("#answers tr[data-scheme]")].map((row) => [row.dataset.scheme, [...row.cells].map((cell) => cell.textContent)]));
    seen.push({ case: document.getElementById("case").value, rows, certified: document.getElementById("certified").textContent,
      answer: explorer.answer(), problem: document.getElementById("problem").textContent });
  };
  const choose = (id, value, event = "change") => {
    document.getElementById(id).value = value;
    document.getElementById(id).dispatchEvent(new Event(event, { bubbles: true }));
  };
  document.getElementById("all_schemes").click();
  await look();
  for (const signal of ["peak", "random", "marschner_lobb"]) {
    choose("signal", signal);
    await look();
  }
  choose("kind", "opacity");
  choose("emission", "plain");
  choose("preset", "two peaks");
  await look();
  choose("steps", 7, "input");
  const press = (selector, key) => {
    document.querySelector(selector).focus();
    document.querySelector(selector).dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  };
  press("#transfer_plot .handle:nth-of-type(3)", "ArrowRight");
  await frame();
  const point = document.querySelectorAll("#transfer_plot .handle")[3];
  const { left, top } = point.getBoundingClientRect();
  const at = (x, y) => ({ pointerId: 1, clientX: left + x, clientY: top + y, bubbles: true });
  point.dispatchEvent(new PointerEvent("pointerdown", at(9, 9)));
  dispatchEvent(new PointerEvent("pointermove", at(-3, -9)));
  await frame();
  dispatchEvent(new PointerEvent("pointermove", at(-5, -25)));
  dispatchEvent(new PointerEvent("pointerup", at(-5, -25)));
  dispatchEvent(new PointerEvent("pointermove", at(500, 500)));
  await look();
  press("#signal_plot .handle", "ArrowRight");
  await look();
  const slabs = [];
  for (const highlight of ["lobe", "cone"])
    for (const angle of [0, 45, 175]) {
      choose("highlight", highlight);
      choose("angle", angle, "input");
      slabs.push({ highlight, angle, text: document.getElementById("slab_certified").textContent, rows: document.querySelectorAll("#slabs tbody tr").length });
    }
  const wide = document.documentElement.scrollWidth;
  const outside = performance.getEntriesByType("resource").map((entry) => entry.name);
  await fetch("/answer.json", { method: "POST", body: JSON.stringify({ seen, slabs, problems, wide, width: innerWidth, outside }) });
  await fetch("/done", { method: "POST", body: "done" });
});
</script>
"""


def engine_of(place):
    engine, binary = make_page.read_engine(place)
    return {"engine": engine, "binary": binary}


def requests():
    """(case, phase): every kind of signal, both kinds of transfer function, both emissions."""
    base = changed(changed(RAY, "/signal", CELL), "/transfer_function", {"points": POINTS})
    result = []
    for signal, steps in ((CELL, 0.13), (POLYNOMIAL, 0.25), (MARSCHNER_LOBB, 0.7)):
        for transfer in (base["transfer_function"], OPACITIES):
            for emission in ("associated", "plain"):
                case = copy.deepcopy(base)
                case.update({"signal": signal, "transfer_function": transfer, "emission": emission, "sampling": {"kind": "constant", "step": steps}})
                result.append((case, 0))
    return result


def answers_of_engine(test, place, asked):
    """What the engine in a page, or in the folder where it was built, says to (case, phase), and of its schemes."""
    if shutil.which("node") is None:
        test.skipTest("node is not installed: the package nodejs has it")
    given = {**engine_of(place), "requests": [{"request": case, "phase": phase} for case, phase in asked]}
    done = subprocess.run(["node", "-e", ANSWER], input=json.dumps(given), capture_output=True, text=True, timeout=240)
    test.assertEqual((done.returncode, done.stderr), (0, ""))
    return json.loads(done.stdout)


@unittest.skipUnless(PAGE.is_file(), "this tree has no plots/explorer.html")
class Explorer(ProgramTest):
    def assert_like(self, mine, program):
        """An answer of the engine and one of the program: all numbers but radii are alike, which both hold."""
        reference = program["reference"]
        self.assertAlmostEqual(mine["length"], program["length"], delta=LIKE)
        truth = mine["reference"]
        for here, there in zip([*truth["color"], truth["opacity"]], [*reference["color"], reference["opacity"]], strict=True):
            self.assertLessEqual(abs(here - there), LIKE)
            self.assertLessEqual(abs(here - there), truth["error_bound"] + reference["error_bound"] + 1e-15)
        self.assertLess(truth["error_bound"], LIKE)
        self.assertEqual(set(mine["schemes"]), set(program["schemes"]))
        for name, there in program["schemes"].items():
            here = mine["schemes"][name]
            self.assertEqual(here.get("why"), there.get("why"), name)
            if "why" in there:
                continue
            numbers = lambda answer: [*answer["color"], answer["opacity"]]
            self.assertLessEqual(max(abs(a - b) for a, b in zip(numbers(here), numbers(there), strict=True)), LIKE, name)
            for part in ("signal", "quadrature"):
                self.assertLessEqual(max(abs(a - b) for a, b in zip(here[part], numbers(there["budget"][part]), strict=True)), LIKE, name)
            self.assertEqual((here["samples"], here["lookups"]), (there["samples"], there["lookups"]), name)

    def answers_of_program(self, cases, names=("order1",)):
        return self.json_of("eval", "-", stdin=[{**case, "schemes": list(names)} for case in cases])

    def test_it_is_one_file_within_the_house_limit(self):
        content = PAGE.read_bytes()
        self.assertLessEqual(len(content), 1_500_000)
        text = content.decode()
        self.assertNotRegex(text, r"""(src|href)\s*=\s*["']|@import|url\(["']?http""")
        self.assertEqual(re.findall(r"@[A-Z_]+@", text), [])

    def test_it_is_made_of_the_sources_that_stand_here(self):
        """But for the engine, which only a rebuild can hold to its sources."""
        output = self.folder / "explorer.html"
        make_page.main(PROGRAM, PAGE, output)
        parts = re.compile(r'<script type="application/json" id="lit_slabs">.*?</script>')
        made, kept = (parts.sub("", path.read_text(encoding="utf-8")) for path in (output, PAGE))
        self.assertEqual(made, kept)

    def test_its_lit_slabs_are_those_of_the_program(self):
        text = PAGE.read_text(encoding="utf-8")
        slabs = json.loads(re.search(r'id="lit_slabs">(.*?)</script>', text).group(1))
        self.assertEqual(slabs["angles"], list(range(0, 180, 5)))
        places = [(highlight, index) for highlight in ("lobe", "cone") for index in (0, 7, 18, 35)]
        cases = [make_page.slab_case(slabs["angles"][index], highlight) for highlight, index in places]
        for (highlight, index), answer in zip(places, self.json_of("eval", "-", stdin=cases), strict=True):
            row = slabs["answers"][highlight][index]
            self.assertEqual(set(row["schemes"]), set(answer["schemes"]))
            for name, there in [("reference", answer["reference"]), *answer["schemes"].items()]:
                here = row["reference"] if name == "reference" else row["schemes"][name]
                if "why" in there:
                    self.assertEqual(here, {"why": there["why"]})
                    continue
                for a, b in zip([x for light in here for x in light], there["diffuse"] + there["specular"], strict=True):
                    self.assertAlmostEqual(a, b, delta=LIKE, msg=name)
            self.assertAlmostEqual(row["opacity"], answer["reference"]["opacity"], delta=LIKE)

    def test_its_engine_computes_what_the_program_computes(self):
        asked = requests()
        answered = answers_of_engine(self, PAGE, asked)
        names = [row["name"] for row in answered["schemes"]]
        self.assertGreater(len(names), 70)
        # A scheme may have been added since: who has no em++ cannot make the engine anew. The slow test asks for all.
        listed = [row for row in self.json_of("list", "schemes", "--json") if row["name"] in names]
        self.assertEqual([(row["name"], row["summary"]) for row in answered["schemes"]], [(row["name"], row["summary"]) for row in listed])
        for mine, program in zip(answered["answers"], self.answers_of_program([case for case, _ in asked], names), strict=True):
            self.assert_like(mine, program)

    def test_a_phase_is_a_shorter_first_step(self):
        """The slabs of single steps: those of the first one, by the program, over those of the rest of the ray."""
        step, phase = 0.25, 0.36
        first = step * phase
        a, b, c, d = POLYNOMIAL["coefficients"][0]
        shifted = [a + b * first + c * first**2 + d * first**3, b + 2 * c * first + 3 * d * first**2, c + 3 * d * first, d]
        case = changed(changed(RAY, "/transfer_function", {"points": POINTS}), "/sampling/step", step)
        whole = changed(case, "/signal", {"kind": "piecewise_polynomial", "breaks": [0, 1], "coefficients": [[a, b, c, d]]})
        front = changed(case, "/signal", {"kind": "piecewise_polynomial", "breaks": [0, first], "coefficients": [[a, b, c, d]]})
        back = changed(case, "/signal", {"kind": "piecewise_polynomial", "breaks": [0, 1 - first], "coefficients": [shifted]})
        mine = answers_of_engine(self, PAGE, [(whole, phase)])["answers"][0]
        self.assertAlmostEqual(mine["samples"][1][0], first)
        names = ("riemann_left", "riemann_right", "riemann_mid", "trapezoid", "order0_mid", "order1", "order1_iterations_16")
        near, far = self.answers_of_program([front, back], names)
        for name in names:
            here, one, two = mine["schemes"][name], near["schemes"][name], far["schemes"][name]
            for channel in range(3):
                self.assertAlmostEqual(here["color"][channel], one["color"][channel] + (1 - one["opacity"]) * two["color"][channel], delta=LIKE)
            self.assertAlmostEqual(here["opacity"], one["opacity"] + (1 - one["opacity"]) * two["opacity"], delta=LIKE)
        self.assertIn("equal", mine["schemes"]["order3"]["why"])

    def test_what_the_engine_cannot_take_is_refused_in_words(self):
        case = requests()[0][0]
        bad = [
            (changed(case, "/signal/direction", [0, 0, 0]), 0, "direction"),
            (changed(case, "/signal/volume/size", [0, 2, 2]), 0, "voxels"),
            (changed(case, "/transfer_function/points/1/s", 0.7), 0, "ascending|sorted|order"),
            (changed(case, "/transfer_function/points/1/extinction", -1), 0, "-1"),
            (changed(case, "/sampling/step", -1), 0, "step"),
            (changed(case, "/sampling/step", 1e-9), 0, "samples"),
            (case, 1, "phase"),
        ]
        answers = answers_of_engine(self, PAGE, [(request, phase) for request, phase, _ in bad])["answers"]
        for answer, (_, _, words) in zip(answers, bad, strict=True):
            self.assertRegex(answer["error"], words)

    def test_the_radius_holds_at_a_jump(self):
        """The engine has no Arb to cut there; it says how far off that may be."""
        points = [{"s": s, "extinction": extinction, "color": [1, 0.5, 0.1]} for s, extinction in ((0, 0), (0.5, 0), (0.5, 1e6), (1, 1e6))]
        case = changed(requests()[0][0], "/transfer_function", {"points": points})
        mine = answers_of_engine(self, PAGE, [(case, 0)])["answers"][0]["reference"]
        program = self.answers_of_program([case])[0]["reference"]
        for here, there in zip([*mine["color"], mine["opacity"]], [*program["color"], program["opacity"]], strict=True):
            self.assertLessEqual(abs(here - there), mine["error_bound"] + program["error_bound"])

    def test_a_browser_opens_it(self):
        browser = shutil.which("chromium")
        if browser is None:
            self.skipTest("Chromium is not installed: the package chromium has it")
        page = PAGE.read_text(encoding="utf-8").replace("<head>", "<head>" + USE, 1)
        self.write("page.html", page)
        for width, height in ((1280, 900), (390, 844)):
            # A window cannot be as narrow as a phone; a frame can.
            self.write("frame.html", f'<!DOCTYPE html><iframe src="page.html" style="width:{width}px;height:{height}px;border:0"></iframe>')
            server = Server(self.folder)
            options = ["--headless=new", "--no-sandbox", "--no-first-run", "--window-size=1400,1000", f"--user-data-dir={self.folder / 'profile'}"]
            with subprocess.Popen([browser, *options, f"http://127.0.0.1:{server.server_port}/frame.html"],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as running:
                finished = server.done.wait(120)
                running.terminate()
            server.shutdown()
            server.server_close()
            self.assertTrue(finished, "the page did not finish")
            told = json.loads((self.folder / "answer.json").read_text())
            self.assertEqual(told["problems"], [])
            self.assertEqual((told["width"], told["outside"]), (width, []))
            self.assertLessEqual(told["wide"], width)
            self.check_what_was_shown(told)

    def check_what_was_shown(self, told):
        *whole, phased = told["seen"]
        self.assertEqual([view["problem"] for view in told["seen"]], [""] * 7)
        programs = self.json_of("eval", "-", stdin=[json.loads(view["case"]) for view in whole])
        for view, program in zip(whole, programs, strict=True):
            self.assert_like(view["answer"], program)
            self.assertEqual(set(view["rows"]), set(program["schemes"]))
            self.assertIn(f"opacity {program['reference']['opacity']:.6f}", view["certified"])
            for name, cells in view["rows"].items():
                scheme = program["schemes"][name]
                if "why" in scheme:
                    self.assertEqual(cells[1], scheme["why"])
                    continue
                shown = [float(cell.replace("−", "-")) for cell in cells[3:7]]
                for number, value in zip(shown, [*scheme["color"], scheme["opacity"]], strict=True):
                    self.assertAlmostEqual(number, value, delta=5.1e-7)
        self.assertEqual((len(phased["answer"]["samples"]), phased["case"]), (9, ""))
        self.assertEqual(programs[-1]["schemes"]["order1"]["samples"], 8)
        moved = json.loads(whole[-1]["case"])["transfer_function"]["points"]
        self.assertEqual(len(moved), 8)
        before = json.loads(whole[-2]["case"])["transfer_function"]["points"]
        for i in range(8):
            (self.assertNotEqual if i in (2, 3) else self.assertEqual)(moved[i]["s"], before[i]["s"])
        self.assertLess(moved[3]["s"], before[3]["s"])
        self.assertGreater(moved[3]["opacity"], before[3]["opacity"])
        cases = [make_page.slab_case(slab["angle"], slab["highlight"]) for slab in told["slabs"]]
        for slab, answer in zip(told["slabs"], self.json_of("eval", "-", stdin=cases), strict=True):
            self.assertEqual(slab["rows"], 1 + len(answer["schemes"]))
            for number in (*answer["reference"]["diffuse"], answer["reference"]["specular"][0], answer["reference"]["opacity"]):
                self.assertIn(f"{number:.6f}", slab["text"])


if __name__ == "__main__":
    unittest.main()

"""Makes the explorer's page: make_page.py PROGRAM ENGINE OUTPUT.

One file that needs nothing else: page.html with the script page.js, the engine, and lit slabs, which have no certified value in a
browser, as PROGRAM's `eval` answers them. ENGINE is the folder where
build.sh left it, or a page that was made before, whose engine is kept.
"""

import base64
import gzip
import json
import math
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
LARGEST_PAGE = 1_500_000  # bytes
ANGLES = range(0, 180, 5)  # degrees between the two normals; opposite ones are refused
HIGHLIGHTS = ["lobe", "cone"]
SHADINGS = """mean_gradient linear_gradient quadratic_arc quadratic_arc_printed circle_arc circle_arc_tuned minimax_arc slerp
    minimax_circle_arc linear_intensity quadratic_arc_fades quadratic_arc_fades_maximum quadratic_arc_fades_printed""".split()
ENGINE = re.compile(r'<script id="engine">\n(.*?)\n</script>', re.DOTALL)
BINARY = re.compile(r'<script type="text/plain" id="engine_binary">(.*?)</script>')


def slab_case(angle, highlight):
    """Normals on both sides of the view's, a light and a half vector that lie between them, if not in their middle."""
    half_angle = math.radians(angle) / 2
    return {
        "slab": {
            "front": 0.2,
            "back": 0.8,
            "length": 1,
            "front_normal": [-math.sin(half_angle), 0, math.cos(half_angle)],
            "back_normal": [math.sin(half_angle), 0, math.cos(half_angle)],
        },
        "transfer_function": {
            "points": [
                {"s": 0, "extinction": 0.2, "color": [0.85, 0.2, 0.1]},
                {"s": 1, "extinction": 2, "color": [0.95, 0.55, 0.15]},
            ]
        },
        "emission": "associated",
        "lighting": {
            "light": [0.28, 0, 0.96],
            "half": [0.14142135623730950488, 0, 0.98994949366116653416],
            "ambient": 0.1,
            "diffuse": 0.7,
            "specular": 0.5,
            "shininess": 20,
            "highlight": highlight,
            "negative": "clamp",
        },
        "schemes": ["reference", *SHADINGS],
    }


def lit_slabs(program):
    """For every highlight and angle the certified value, and of it and every shading [diffuse, specular], three channels each.
    What is ambient does not depend on normals, so it is there once."""
    cases = [slab_case(angle, highlight) for highlight in HIGHLIGHTS for angle in ANGLES]
    done = subprocess.run([program, "eval", "-"], input=json.dumps(cases), capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stderr.strip())
    answers = json.loads(done.stdout)

    def light(answer):
        return {"why": answer["why"]} if "why" in answer else [answer["diffuse"], answer["specular"]]

    rows = [
        {
            "reference": light(answer["reference"]),
            "ambient": answer["reference"]["ambient"],
            "opacity": answer["reference"]["opacity"],
            "radius": answer["reference"]["error_bound"],
            "schemes": {name: light(answer["schemes"][name]) for name in SHADINGS},
        }
        for answer in answers
    ]
    count = len(ANGLES)
    return {
        "angles": list(ANGLES),
        "case": slab_case(90, "lobe"),
        "answers": {highlight: rows[i * count : (i + 1) * count] for i, highlight in enumerate(HIGHLIGHTS)},
    }


def read_engine(place):
    """The engine's script, and its WebAssembly, compressed, in letters: of the folder where it was built, or of a page."""
    place = pathlib.Path(place)
    if place.is_dir():
        packed = gzip.compress((place / "engine.wasm").read_bytes(), mtime=0)
        return (place / "engine.js").read_text(encoding="utf-8").strip(), base64.b64encode(packed).decode()
    page = place.read_text(encoding="utf-8")
    return ENGINE.search(page).group(1), BINARY.search(page).group(1)


def main(program, place, output):
    engine, binary = read_engine(place)
    if "</script" in engine.lower():
        sys.exit("the engine would end the script that it stands in")
    summaries = json.loads(subprocess.run([program, "list", "shadings", "--json"], capture_output=True, check=True).stdout)
    parts = {
        "ENGINE": engine,
        "ENGINE_BINARY": binary,
        "LIT_SLABS": json.dumps(lit_slabs(program), separators=(",", ":")),
        "SHADINGS": json.dumps({row["name"]: row["summary"] for row in summaries if row["name"] in SHADINGS}),
        "SCRIPT": (HERE / "page.js").read_text(encoding="utf-8").strip(),
    }
    page = (HERE / "page.html").read_text(encoding="utf-8")
    for name, text in parts.items():
        page = page.replace(f"@{name}@", text)
    content = page.encode()
    if len(content) > LARGEST_PAGE:
        sys.exit(f"the page has {len(content)} bytes; at most {LARGEST_PAGE} are allowed")
    pathlib.Path(output).write_bytes(content)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])

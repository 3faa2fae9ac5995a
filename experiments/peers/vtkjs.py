"""vtk.js renders a scene in headless Chromium, by its software renderer: vtkjs.py [step=VOXELS] < scene.json > image.npy

The canvas keeps 8 bits, and the ray's first sample is jittered by Math.random: no two images are the same.
"""

import json
import pathlib
import shutil
import subprocess
import sys

import numpy as np

import questions

HERE = pathlib.Path(__file__).parent
BUNDLE = HERE / "build/page.js"


def chromium():
    found = shutil.which("chromium")
    if found is None or shutil.which("node") is None:
        questions.missing("Chromium or Node.js is missing: the packages chromium and nodejs have them")
    if not BUNDLE.is_file():
        questions.missing("build/page.js is missing: experiments/peers/run --install vtkjs makes it")
    return found


def version():
    chromium()
    stated = json.loads((HERE / "package.json").read_text())["dependencies"]["@kitware/vtk.js"]
    browser = subprocess.run([chromium(), "--version", "--no-sandbox"], capture_output=True, text=True).stdout.split()
    return f"vtk.js {stated}, Chromium {browser[1] if len(browser) > 1 else 'unknown'}"


def render(scene, words, options):
    width, height = scene["camera"]["size"]
    smallest = min(scene["spacing"])
    asked = {"sizes": scene["voxels"].shape[::-1], "values": scene["voxels"].ravel().tolist(), "spacing": scene["spacing"], "colors": scene["colors"],
             "opacities": scene["opacities"], "unit": scene["unit"] * smallest, "shading": scene.get("shading"), "camera": scene["camera"],
             "border": scene["border"], "step": float(options.get("step", scene.get("step", 1))) * smallest}
    done = subprocess.run(["node", "vtkjs/render.mjs", chromium()], input=json.dumps(asked).encode(), capture_output=True, cwd=HERE)
    if done.returncode or len(done.stdout) != 4 * width * height:
        sys.exit(done.stderr.decode(errors="replace")[-500:] or "the page gave no image")
    return np.frombuffer(done.stdout, "u1").reshape(height, width, 4)[::-1] / 255


def main():
    if sys.argv[1:] == ["--version"]:
        return print(version())
    scene = questions.ask()
    scene["voxels"] = questions.voxels_of(scene)
    low, high = float(scene["voxels"].min()), float(scene["voxels"].max())
    scene["colors"], scene["opacities"], scene["unit"] = questions.opacity_function(scene, low, high)
    questions.answer_image(render(scene, [], questions.words_of(sys.argv[1:])))


if __name__ == "__main__":
    main()

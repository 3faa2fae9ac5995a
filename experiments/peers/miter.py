"""Teem's miter renders a scene: miter.py [step=VOXELS] [gradient=KERNEL] < scene.json > image.npy

Its world is [-1, 1] along the longest axis from centre to centre of the outermost voxels. Transfer functions are looked up
without interpolation, so they are tables of 65536 entries; the image's colours are divided by its opacity.
"""

import shutil
import subprocess
import sys
import tempfile

import numpy as np

import questions

PROGRAM = "teem-miter"
TABLE = 1 << 16


def version():
    if shutil.which(PROGRAM) is None:
        questions.missing(f"{PROGRAM} is missing: the package teem-apps has it")
    said = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True)
    found = [line for line in (said.stdout + said.stderr).splitlines() if "version" in line.lower()]
    return found[0].strip() if found else "Teem"


def write_nrrd(path, array, fields):
    sizes = " ".join(str(n) for n in array.shape[::-1])
    head = f"NRRD0004\ntype: float\ndimension: {array.ndim}\nsizes: {sizes}\n{fields}endian: little\nencoding: raw\n\n"
    with open(path, "wb") as file:
        file.write(head.encode() + np.ascontiguousarray(array, "<f4").tobytes())


def read_nrrd(path, shape):
    with open(path, "rb") as file:
        head, body = file.read().split(b"\n\n", 1)
    kind = {"float": "<f4", "double": "<f8"}[dict(line.split(": ", 1) for line in head.decode().splitlines() if ": " in line)["type"]]
    return np.frombuffer(body, kind).reshape(shape).astype(float)


def look_up(points, s):
    """A list of points as numbers at s: at a jump, those of the right-hand side."""
    places = np.array([p[0] for p in points], float)
    values = np.array([p[1] for p in points], float)
    return np.interp(s, places, values)


def look_of(scene, options):
    """How miter is told of light, which it has in the view's space: right, down, away from the eye."""
    shading = scene.get("shading")
    if not shading:
        return ["-ads", "1", "0", "0"]  # not "no shading", which darkens
    camera = scene["camera"]
    away = np.subtract(camera["target"], camera["eye"]).astype(float)
    away /= np.linalg.norm(away)
    right = np.cross(away, camera["up"])
    right /= np.linalg.norm(right)
    light = np.array(shading["light"])
    there = [light @ right, -(light @ np.cross(right, away)), light @ away]
    return ["-ads", *(str(shading[key]) for key in ("ambient", "diffuse", "specular")), "-sp", str(shading["shininess"]),
            "-ld", *(repr(float(x)) for x in there), "-k11", options.get("gradient", "cubicd:1,0")]


def render(scene, words, options):
    """None where miter refuses: volumes of one value."""
    voxels, camera = scene["voxels"], scene["camera"]
    if voxels.min() == voxels.max():
        return None
    extent = [(n - 1) * h for n, h in zip(voxels.shape[::-1], scene["spacing"])]
    half, middle = max(extent) / 2, np.array(extent) / 2
    smallest = min(scene["spacing"])
    width, height = camera["size"]
    with tempfile.TemporaryDirectory() as folder:
        spacings = " ".join(str(h) for h in scene["spacing"])
        write_nrrd(f"{folder}/volume.nrrd", voxels, f"spacings: {spacings}\ncenters: node node node\n")
        low, high = float(voxels.min()), float(voxels.max())
        s = np.linspace(low, high, TABLE)
        channels = [look_up([(p, color[i]) for p, color in scene["colors"]], s) for i in range(3)]
        table = np.stack([*channels, look_up(scene["opacities"], s)], -1)
        write_nrrd(f"{folder}/table.nrrd", table, f'axis mins: NaN {low!r}\naxis maxs: NaN {high!r}\ncenters: ??? node\nlabels: "RGBA" "gage(scalar:v)"\n')
        place = lambda p: [repr(float(x)) for x in (np.array(p) - middle) / half]
        tall = camera["height"] / 2 / half
        wide = tall * width / height
        step = float(options.get("step", scene.get("step", 1))) * smallest / half
        command = [PROGRAM, "-i", f"{folder}/volume.nrrd", "-txf", f"{folder}/table.nrrd", "-fr", *place(camera["eye"]), "-at", *place(camera["target"]),
                   "-up", *(str(x) for x in camera["up"]), "-rh", "-or", "-ar", "-dn", "-3", "-di", "0", "-df", "3", "-ur", repr(-wide), repr(wide),
                   "-vr", repr(-tall), repr(tall), "-is", str(width), str(height), "-step", repr(step), "-ref", repr(scene["unit"] * smallest / half),
                   "-n1", "1", "-nt", "1", *look_of(scene, options), "-o", f"{folder}/image.nrrd"]
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done.returncode:
            sys.exit(done.stderr[-500:])
        image = read_nrrd(f"{folder}/image.nrrd", (height, width, -1))[..., :4].copy()
    image[..., :3] *= image[..., 3:]
    return image


def main():
    if sys.argv[1:] == ["--version"]:
        return print(version())
    version()  # or it is missing
    scene = questions.ask()
    scene["voxels"] = questions.voxels_of(scene)
    low, high = float(scene["voxels"].min()), float(scene["voxels"].max())
    scene["colors"], scene["opacities"], scene["unit"] = questions.opacity_function(scene, low, high)
    questions.answer_image(render(scene, [], questions.words_of(sys.argv[1:])))


if __name__ == "__main__":
    main()

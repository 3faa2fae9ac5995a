from defect import Defect, main

import math
import pathlib
import subprocess
import tempfile

DEFECT = Defect(
    title="POV-Ray's media emit too much, in the first order of their intervals",
    where="source of POV-Ray 3.7, media.cpp, method 3, the default; master (04ed7026) has a half-interval term (read, not run).",
    what="""A sub-interval's emission is attenuated by what lies in front of it, not by the mean of what lies in front of its parts, which is
        the model of first order; transmittance is exact. With default settings a homogeneous medium of depth 1 is 8.6 % too bright; with 3
        samples 27 %, with 320 samples 0.3 %. aa_level and aa_threshold do not help.""",
    repair="weight a sub-interval's emission by (1 - exp(-d))/d of its own depth d, or release what master has.",
    quantity="light of a homogeneous medium of depth 1 that emits its extinction",
    tolerance=0.003,
)
SCENE = """#version 3.7;
global_settings {{ assumed_gamma 1 max_trace_level 10 }}
background {{ rgbt <0,0,0,1> }}
camera {{ orthographic location <0,0,-1> direction z right x*0.01 up y*0.01 }}
box {{ <-1,-1,0>, <1,1,2> hollow pigment {{ rgbt 1 }}
  interior {{ media {{ {method} absorption 0.5 emission <0.25,0.5,0.125> density {{ rgb 1 }} }} }} }}
"""
METHODS = {"defaults": "", "method 3, 3 samples": "method 3 samples 3,3 intervals 1", "method 3, 20 samples": "method 3 samples 20,20 intervals 1", "method 3, 320 samples": "method 3 samples 320,320 intervals 1"}


def light(method):
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "scene.pov").write_text(SCENE.format(method=method))
        subprocess.run(["povray", f"+I{folder}/scene.pov", f"+O{folder}/image.ppm", "+FP16", "+W2", "+H2", "-D", "-A", "+WT1", "File_Gamma=1.0"], check=True, capture_output=True)
        return int.from_bytes(pathlib.Path(folder, "image.ppm").read_bytes()[-22:-20], "big") / 65535  # the green of the first pixel of four


def measure():
    for name, method in METHODS.items():
        yield name, 1 - math.exp(-1), light(method)


def version():
    import questions

    try:
        said = subprocess.run(["povray", "--version"], capture_output=True, text=True)
    except FileNotFoundError:
        questions.missing("povray is missing: the package povray has it")
    return next(line.strip() for line in (said.stdout + said.stderr).splitlines() if line.strip().startswith("POV-Ray"))


if __name__ == "__main__":
    main(DEFECT, version(), measure)

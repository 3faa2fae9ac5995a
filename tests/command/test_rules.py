"""`rules`: the shader functions in the languages of the web, held to compilers, and to the twins in a browser."""

import http.server
import json
import os
import pathlib
import re
import shutil
import subprocess
import threading
import unittest

from support import SOURCE, ProgramTest

RULES = SOURCE / "src/raytruth/rules"
DEFINITION = re.compile(r"^(?:real|vec4|bool|float) (\w+)\(", re.MULTILINE)

# Draws with the rules, so that the compilers see them called.
FRAGMENT = """
out vec4 color;
void main() { color = over(homogeneous_slab(vec4(0.5, 0.25, 0.125, 2.0), 0.1, false), vec4(opacity_correction(0.5, 0.25))); }
"""

PAGE = """<!doctype html><script type="module">
const get = async (name) => (await fetch(name)).arrayBuffer();
const post = (name, body) => fetch(name, { method: "POST", body });
try {
  const adapter = await navigator.gpu?.requestAdapter();
  if (!adapter) throw "no adapter";
  const device = await adapter.requestDevice();
  const module = device.createShaderModule({ code: await (await fetch("twins.wgsl")).text() });
  for (const { type, message } of (await module.getCompilationInfo()).messages) throw `${type}: ${message}`;
  for (const { name, result_count, number_count } of JSON.parse(await (await fetch("twins.json")).text())) {
    const pipeline = await device.createComputePipelineAsync({ layout: "auto", compute: { module, entryPoint: `twin_${name}` } });
    for (const kind of ["random", "adversarial"]) {
      const numbers = await get(`${name}.${kind}`);
      const rows = numbers.byteLength / 4 / number_count;
      const input = device.createBuffer({ size: numbers.byteLength, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST });
      device.queue.writeBuffer(input, 0, numbers);
      const size = 4 * rows * result_count;
      const output = device.createBuffer({ size, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC });
      const readable = device.createBuffer({ size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
      const encoder = device.createCommandEncoder();
      const pass = encoder.beginComputePass();
      pass.setPipeline(pipeline);
      pass.setBindGroup(0, device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries: [
        { binding: 0, resource: { buffer: input } }, { binding: 1, resource: { buffer: output } }] }));
      pass.dispatchWorkgroups(Math.ceil(rows / 64));
      pass.end();
      encoder.copyBufferToBuffer(output, 0, readable, 0, size);
      device.queue.submit([encoder.finish()]);
      await readable.mapAsync(GPUMapMode.READ);
      await post(`${name}.${kind}.values`, readable.getMappedRange().slice(0));
    }
  }
  await post("done", "done");
} catch (error) {
  await post("done", String(error));
}
</script>"""

COUNTS = {"real": 1, "bool": 1, "vec4": 4}


def example_of_readme(language):
    """What README.md puts behind the rules, by its shape: the text in backquotes of three.js and of WebGPU."""
    texts = re.findall(r"rules \+ `(.*?)`", (RULES / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    (found,) = [text for text in texts if ("@compute" in text) == (language == "wgsl")]
    return found


def twin_entry(twin):
    """A compute shader that calls the twin's function for each row of numbers."""
    arguments, place = [], 0
    for kind in twin["arguments"]:
        numbers = [f"numbers[first + {place + i}u]" for i in range(COUNTS[kind])]
        arguments.append(f"vec4f({', '.join(numbers)})" if kind == "vec4" else numbers[0] + (" != 0.0" if kind == "bool" else ""))
        place += COUNTS[kind]
    results = twin["result_count"]
    stores = [f"values[{results}u * id.x + {i}u] = value{f'[{i}]' if results > 1 else ''};" for i in range(results)]
    return f"""
@compute @workgroup_size(64) fn twin_{twin['name']}(@builtin(global_invocation_id) id: vec3u) {{
  if (id.x >= arrayLength(&values) / {results}u) {{ return; }}
  let first = {place}u * id.x;
  let value = {twin['name']}({', '.join(arguments)});
  {' '.join(stores)}
}}
"""


class Server(http.server.ThreadingHTTPServer):
    """Hands out a folder's files, and keeps there what is posted."""

    def __init__(self, folder):
        self.folder, self.message, self.done = folder, "", threading.Event()
        super().__init__(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.serve_forever, daemon=True).start()


class Handler(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        file = self.server.folder / pathlib.PurePosixPath(self.path).name
        content = file.read_bytes() if file.is_file() else b""
        self.send_response(200 if file.is_file() else 404)
        self.send_header("Content-Type", "text/html" if file.suffix == ".html" else "application/octet-stream")
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        if self.path == "/done":
            self.server.message = body.decode()
            self.server.done.set()
        else:
            (self.server.folder / pathlib.PurePosixPath(self.path).name).write_bytes(body)
        self.send_response(204)
        self.end_headers()

    def log_message(self, *_):
        pass


class Rules(ProgramTest):
    def rules(self, language):
        done = self.run_program("rules", "--language", language)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        return done.stdout.decode()

    def test_every_function_stands_in_every_language_once(self):
        order = re.findall(r'^#include "raytruth/rules/(.*)"', (RULES / "rules.hpp").read_text(), re.MULTILINE)
        names = [name for file in ["prelude.glsl", *order] for name in DEFINITION.findall((RULES / file).read_text())]
        self.assertGreater(len(names), 70)
        self.assertEqual({*order, "prelude.glsl"}, {file.name for file in RULES.glob("*.glsl")})
        for language in ("glsl", "essl"):
            self.assertEqual(DEFINITION.findall(self.rules(language)), names)
        self.assertEqual(re.findall(r"^fn (\w+)\(", self.rules("wgsl"), re.MULTILINE), names)

    def test_the_texts_of_glsl_are_those_of_the_files(self):
        for language in ("glsl", "essl"):
            text = self.rules(language)
            for file in RULES.glob("*.glsl"):
                self.assertIn(file.read_text(encoding="utf-8"), text)
        self.assertIn("precision highp float;", self.rules("essl"))
        self.assertNotIn("precision highp", self.rules("glsl"))

    def test_wgsl_has_nothing_of_glsl(self):
        code = re.sub(r"//[^\n]*", "", self.rules("wgsl"))
        self.assertEqual(re.findall(r"\b(?:real|float|vec4|uint|int|precise|as_written)\b|[?#]", code), [])
        self.assertEqual(re.findall(r"\bif \(.*\) (?!{)", code), [])
        self.assertEqual(re.findall(r"(?<![\w.])\d+\.\d*(?:e-?\d+)?(?!f|[\d.e])", code), [])
        for pair in ("{}", "()", "[]"):
            self.assertEqual(code.count(pair[0]), code.count(pair[1]))

    def test_a_file_is_written(self):
        done = self.run_program("rules", "--language", "wgsl", "-o", "rules.wgsl")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, b"", b""))
        self.assertEqual((self.folder / "rules.wgsl").read_text(), self.rules("wgsl"))
        self.assertEqual(self.run_program("rules").stdout.decode(), self.rules("glsl"))

    def test_unknown_languages_are_refused(self):
        done = self.run_program("rules", "--language", "hlsl")
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"glsl,essl,wgsl", done.stderr)

    def test_glslang_takes_them(self):
        if shutil.which("glslangValidator") is None:
            self.skipTest("glslangValidator is not installed: the package glslang-tools has it")
        for language, versions in (("essl", ("300 es", "310 es", "320 es")), ("glsl", ("330", "430"))):
            for version in versions:
                file = self.write("rules.frag", f"#version {version}\n{self.rules(language)}{FRAGMENT}")
                done = subprocess.run(["glslangValidator", file], cwd=self.folder, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, f"{version}: {done.stdout}")
        file = self.write("rules.frag", f"#version 300 es\n{self.rules('essl')}{example_of_readme('essl')}")
        done = subprocess.run(["glslangValidator", file], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_dawn_takes_them(self):
        """Dawn without a driver: npm's package `webgpu`, found by NODE_PATH."""
        find = "process.stdout.write(require.resolve('webgpu'))"
        found = shutil.which("node") and subprocess.run(["node", "-e", find], capture_output=True, text=True).stdout
        if not found:
            self.skipTest("Dawn is not at hand: npm's package webgpu, in a folder of NODE_PATH, has it")
        script = """
            const { create, globals } = await import(process.argv[1]);
            Object.assign(globalThis, globals);
            const device = await (await create(["backend=null"]).requestAdapter()).requestDevice();
            const code = require("fs").readFileSync(0, "utf8");
            for (const { lineNum, message } of (await device.createShaderModule({ code }).getCompilationInfo()).messages)
              console.log(`${lineNum}: ${message}`);
            process.exit();"""
        command = ["node", "-e", f"(async () => {{{script}}})()", pathlib.Path(found).as_uri()]
        good = self.rules("wgsl") + example_of_readme("wgsl")
        self.assertEqual(subprocess.run(command, input=good, capture_output=True, text=True).stdout, "")
        bad = good.replace("select(", "choose(", 1)
        self.assertIn("choose", subprocess.run(command, input=bad, capture_output=True, text=True).stdout)

    def test_a_browser_computes_them_within_their_bounds(self):
        """The bounds of the twins in binary32, on the inputs that GLSL is held to."""
        browser = shutil.which("chromium")
        if browser is None:
            self.skipTest("Chromium is not installed: the package chromium has it")
        tool = os.environ["RAYTRUTH_TWIN_INPUTS"]
        subprocess.run([tool, "write", self.folder], check=True)
        twins = json.loads((self.folder / "twins.json").read_text())
        for twin in twins:
            twin["number_count"] = sum(COUNTS[kind] for kind in twin["arguments"])
        self.write("twins.json", twins)
        bindings = """
            @group(0) @binding(0) var<storage, read> numbers: array<f32>;
            @group(0) @binding(1) var<storage, read_write> values: array<f32>;"""
        self.write("twins.wgsl", self.rules("wgsl") + bindings + "".join(map(twin_entry, twins)))
        self.write("page.html", PAGE)
        server = Server(self.folder)
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        options = ["--headless=new", "--no-sandbox", "--no-first-run", "--enable-unsafe-webgpu", "--enable-features=Vulkan",
                   "--use-webgpu-adapter=swiftshader", f"--user-data-dir={self.folder / 'profile'}"]
        with subprocess.Popen([browser, *options, f"http://127.0.0.1:{server.server_port}/page.html"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as running:
            finished = server.done.wait(240)
            running.terminate()
        self.assertTrue(finished, "the page did not finish")
        if server.message == "no adapter":
            self.skipTest("this Chromium has no WebGPU, not even SwiftShader's")
        self.assertEqual(server.message, "done")
        judged = subprocess.run([tool, "judge", self.folder], capture_output=True, text=True)
        self.assertEqual((judged.returncode, judged.stderr), (0, ""), judged.stdout)
        self.assertEqual(len(judged.stdout.splitlines()), 2 * len(twins))


if __name__ == "__main__":
    unittest.main()

"use strict";

// The page's script: what people choose, what the engine answers, and how both are drawn. Numbers come from the engine
// and from the embedded answers of the program alone.

const of_id = (id) => document.getElementById(id);
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

// The palette of the project's plots, which colour-blind readers tell apart.
const COLORS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00"];
const DASHES = ["none", "8 3", "2 3", "8 3 2 3", "5 5", "12 2"];
const MAIN_SCHEMES = ["riemann_left", "riemann_mid", "trapezoid", "simpson", "order0_mid", "order1", "order2", "order3", "virtual_catmull_rom",
  "virtual_catmull_rom_3", "order1_no_attenuation", "order1_iterations_16", "quadratic_gray", "cell_adaptive", "cell_cubic"];

// --- elements ---

function element(name, attributes = {}, ...children) {
  const result = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) result.setAttribute(key, value);
  result.append(...children);
  return result;
}

function drawn(parent, name, attributes = {}, text = "") {
  const result = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) result.setAttribute(key, value);
  result.textContent = text;
  parent.append(result);
  return result;
}

/** A slider with its name and value; `change` gets the number. */
function slider(name, low, high, step, value, change) {
  const input = element("input", { type: "range", min: low, max: high, step });
  input.value = value;
  const output = element("output", {}, String(value));
  input.addEventListener("input", () => {
    output.textContent = input.value;
    change(Number(input.value));
  });
  return element("label", { class: "slider" }, element("span", {}, name), input, output);
}

// --- colours: linear light, as everywhere in the library; sRGB only where a screen or a colour field wants it ---

const to_srgb = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const from_srgb = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
const hex_of = (color) => "#" + color.map((x) => Math.round(255 * to_srgb(clamp(x, 0, 1))).toString(16).padStart(2, "0")).join("");
const color_of = (hex) => [1, 3, 5].map((at) => Number(from_srgb(parseInt(hex.slice(at, at + 2), 16) / 255).toFixed(4)));

// --- what is chosen ---

const PRESETS = {
  "a tent": [[0, 0], [0.4, 0], [0.5, 4], [0.6, 0], [1, 0]],
  "a ramp": [[0, 0], [1, 3]],
  "two peaks": [[0, 0], [0.2, 0.1], [0.3, 3], [0.4, 0.1], [0.65, 0.1], [0.75, 6], [0.85, 0.1], [1, 0]],
  "a thin shell": [[0, 0], [0.49, 0], [0.5, 40], [0.51, 0], [1, 0]],
  "almost a surface": [[0, 0], [0.5, 0], [0.52, 20], [1, 20]],
};
const PRESET_COLORS = [[0.05, 0.3, 0.9], [0.95, 0.75, 0.1], [0.9, 0.15, 0.05]];

function preset_points(name) {
  return PRESETS[name].map(([s, value]) => {
    const place = 2 * s;
    const from = Math.min(Math.floor(place), 1);
    const color = PRESET_COLORS[from].map((x, i) => Number((x + (place - from) * (PRESET_COLORS[from + 1][i] - x)).toFixed(4)));
    return { s, value, color };
  });
}

const state = {
  signal: "cell",
  voxels: [0.1, 0.9, 0.3, 0.6, 0.7, 0.2, 0.9, 0.4],
  entry: [0, 0.15, 0.2],
  exit: [1, 0.8, 0.9],
  peak: [0.1, 0.9, 0.95, 0.2],
  seed: 1,
  pieces: 6,
  heading: 30,
  height: 20,
  steps: 4,
  phase: 0,
  points: preset_points("a tent"),
  kind: "extinction",
  emission: "associated",
  chosen_point: 2,
  scheme: "order1",
};

/** Numbers in [0, 1) of a seed (mulberry32). */
function random_numbers(seed) {
  let bits = seed >>> 0;
  return () => {
    bits = (bits + 0x6d2b79f5) | 0;
    let x = Math.imul(bits ^ (bits >>> 15), 1 | bits);
    x = (x + Math.imul(x ^ (x >>> 7), 61 | x)) ^ x;
    return ((x ^ (x >>> 14)) >>> 0) / 4294967296;
  };
}

/** Powers of t of a cubic in Bernstein form on [0, length]. */
const powers = ([a, b, c, d], length) => [a, (3 * (b - a)) / length, (3 * (a - 2 * b + c)) / length ** 2, (d - 3 * c + 3 * b - a) / length ** 3];

/** The signal as the program's `eval` takes it. */
const SIGNALS = {
  cell() {
    const direction = state.exit.map((x, i) => x - state.entry[i]);
    return { kind: "trilinear", volume: { size: [2, 2, 2], values: state.voxels }, origin: state.entry, direction, length: Math.hypot(...direction) };
  },
  peak() {
    return { kind: "piecewise_polynomial", breaks: [0, 4], coefficients: [powers(state.peak, 4)] };
  },
  random() {
    const next = random_numbers(state.seed);
    const value = () => Math.round(1000 * next()) / 1000;
    const coefficients = [];
    for (let front = value(), piece = 0; piece < state.pieces; ++piece) {
      const cubic = [front, value(), value(), value()];
      coefficients.push(powers(cubic, 1));
      front = cubic[3];
    }
    return { kind: "piecewise_polynomial", breaks: coefficients.map((_, i) => i).concat(coefficients.length), coefficients };
  },
  marschner_lobb() {
    const angle = (state.heading * Math.PI) / 180;
    return { kind: "trilinear", volume: { kind: "marschner_lobb", samples: 41 }, origin: [20, 20, state.height], direction: [Math.cos(angle), Math.sin(angle), 0.1], length: 12 };
  },
};

const NOTES = {
  cell: "Trilinear between eight voxels: a cubic along the ray. Lengths are in voxels.",
  peak: "One cubic on four voxels of length, by its Bernstein coefficients; with the tent it crosses a peak of the extinction twice.",
  random: "A cubic on every voxel of length, continuous, with kinks between.",
  marschner_lobb: "The signal of Marschner and Lobb at 41³ nodes, trilinear between: 12 voxels from the middle outwards.",
};

function case_of() {
  const points = state.points.map(({ s, value, color }) => ({ s, [state.kind]: value, color }));
  const transfer_function = state.kind === "opacity" ? { points, unit_length: 1 } : { points };
  return {
    signal: SIGNALS[state.signal](),
    transfer_function,
    emission: state.emission,
    sampling: { kind: "constant", step: answer.length / state.steps },
    schemes: ["reference", ...schemes.map((scheme) => scheme.name)],
  };
}

// --- the engine ---

let engine = null;
let schemes = [];
let answer = null;
let curves = null;

/** Calls a function of the engine; lists of numbers are copied to where it reads them. */
function ask(name, ...values) {
  const places = [];
  const place_of = (bytes) => (places.push(engine._malloc(bytes)), places.at(-1));
  const given = values.map((value) => {
    if (typeof value === "string") {
      const place = place_of(engine.lengthBytesUTF8(value) + 1);
      engine.stringToUTF8(value, place, engine.lengthBytesUTF8(value) + 1);
      return place;
    }
    if (Array.isArray(value) || ArrayBuffer.isView(value)) {
      const numbers = Array.isArray(value) ? Float64Array.from(value) : value;
      const place = place_of(numbers.byteLength);
      engine.HEAPU8.set(new Uint8Array(numbers.buffer, numbers.byteOffset, numbers.byteLength), place);
      return place;
    }
    return value;
  });
  const result = JSON.parse(engine.UTF8ToString(engine["_explorer_" + name](...given)));
  places.forEach((place) => engine._free(place));
  if (result.error) throw new Error(result.error);
  return result;
}

let given = { text: "", length: 0 }; // the signal that the engine has

/** Gives the engine the signal, if it is another one, and returns the ray's length. */
function give_signal() {
  const signal = SIGNALS[state.signal]();
  const text = JSON.stringify(signal);
  if (given.text !== text) {
    given.text = "";
    given = { text, length: length_of_given(signal) };
  }
  return given.length;
}

function length_of_given(signal) {
  if (signal.kind === "piecewise_polynomial")
    return ask("polynomials", signal.coefficients.length, signal.breaks, signal.coefficients[0].length, signal.coefficients.flat()).length;
  const ray = [...signal.origin, ...signal.direction, signal.length];
  if (signal.volume.kind) return ask("marschner_lobb", signal.volume.samples, ray).length;
  return ask("trilinear", Int32Array.from(signal.volume.size), signal.volume.values, ray).length;
}

function compute() {
  const length = give_signal();
  ask("transfer", state.points.length, state.points.flatMap(({ s, value, color }) => [s, value, ...color]), state.kind === "opacity" ? 1 : 0, Number(state.emission === "plain"));
  if (!(length > 0)) throw new Error("the ray is empty: its ends are one point");
  const step = length / state.steps;
  answer = ask("answer", step, state.phase);
  curves = ask("curves", state.scheme, step, state.phase, 400);
}

// --- plots ---

const power_of_ten = (x) => (x === 1 ? "1" : "10" + String(Math.round(Math.log10(x))).replace(/./g, (letter) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(letter)]));

/** Axes with ticks on a plot; gives the scales of both. */
function axes(svg, { x, y, x_label, y_label, y_log = false }) {
  // As wide as the page has it, so that letters keep their size.
  const width = Math.max(260, Math.round(svg.getBoundingClientRect().width));
  const height = Number(svg.dataset.height);
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  const [left, right, top, bottom] = [54, width - 12, 22, height - 42];
  svg.replaceChildren();
  const place = ([low, high], from, to) => (value) => from + ((value - low) / (high - low)) * (to - from);
  const at_x = place(x, left, right);
  const at_y = y_log ? (value) => place(y.map(Math.log10), bottom, top)(Math.log10(clamp(value, ...y))) : place(y, bottom, top);
  const nice = ([low, high]) => {
    const raw = (high - low) / 5;
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= raw * 0.999);
    const ticks = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) ticks.push(Number((i * step).toPrecision(12)));
    return ticks;
  };
  for (const tick of nice(x)) {
    drawn(svg, "line", { class: "grid", x1: at_x(tick), x2: at_x(tick), y1: top, y2: bottom });
    drawn(svg, "text", { x: at_x(tick), y: bottom + 17, "text-anchor": "middle" }, tick);
  }
  const y_ticks = y_log ? Array.from({ length: Math.round(Math.log10(y[1] / y[0]) / 2) + 1 }, (_, i) => y[1] / 100 ** i) : nice(y);
  for (const tick of y_ticks) {
    drawn(svg, "line", { class: "grid", x1: left, x2: right, y1: at_y(tick), y2: at_y(tick) });
    drawn(svg, "text", { x: left - 7, y: at_y(tick) + 4, "text-anchor": "end" }, y_log ? power_of_ten(tick) : tick);
  }
  drawn(svg, "path", { class: "axis", fill: "none", d: `M${left} ${top}V${bottom}H${right}` });
  drawn(svg, "text", { x: (left + right) / 2, y: height - 6, "text-anchor": "middle" }, x_label);
  drawn(svg, "text", { x: 4, y: 12 }, y_label);
  return { at_x, at_y, left, right, top, bottom };
}

/** A round thing to drag: `move(dx, dy)` gets the way since the last call, in units of the plot, also from arrow keys. */
function handle(svg, { x, y, radius = 6.5, fill, label, chosen, key_step, move, choose, value_text }) {
  const group = drawn(svg, "g", { class: "handle" + (chosen ? " chosen" : ""), tabindex: 0, role: "slider", "aria-label": label, "aria-valuenow": value_text, "aria-valuetext": value_text });
  drawn(group, "circle", { class: "reach", cx: x, cy: y, r: 20 });
  drawn(group, "circle", { class: "ring", cx: x, cy: y, r: radius + 3.5 });
  drawn(group, "circle", { class: "dot", cx: x, cy: y, r: radius, fill });
  group.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    choose?.();
    const scale = Number(svg.getAttribute("viewBox").split(" ")[2]) / svg.getBoundingClientRect().width;
    let last = event;
    const moved = (now) => {
      if (now.pointerId !== event.pointerId) return;
      move((now.clientX - last.clientX) * scale, (now.clientY - last.clientY) * scale);
      last = now;
    };
    // On the window: the handle itself is drawn anew with every move.
    const index = [...svg.querySelectorAll(".handle")].indexOf(group);
    const done = () => {
      ["pointermove", "pointerup", "pointercancel"].forEach((name, i) => window.removeEventListener(name, i ? done : moved));
      svg.querySelectorAll(".handle")[index]?.focus(); // so that arrow keys go on
    };
    window.addEventListener("pointermove", moved);
    window.addEventListener("pointerup", done);
    window.addEventListener("pointercancel", done);
  });
  group.addEventListener("keydown", (event) => {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!way) return;
    event.preventDefault();
    const index = [...svg.querySelectorAll(".handle")].indexOf(group);
    choose?.();
    move(way[0] * key_step * (event.shiftKey ? 10 : 1), way[1] * key_step * (event.shiftKey ? 10 : 1));
    requestAnimationFrame(() => svg.querySelectorAll(".handle")[index]?.focus());
  });
  group.addEventListener("focus", () => choose?.());
}

const path_of = (values, at_x, at_y, length) => values.map((value, i) => `${i ? "L" : "M"}${at_x((length * i) / (values.length - 1)).toFixed(2)} ${at_y(value).toFixed(2)}`).join("");

const color_of_scheme = (name) => visible(schemes.find((scheme) => scheme.name === name)?.color);
// Black would vanish on a dark page.
const visible = (color) => (!color || color === "#000000" ? "currentColor" : color);

function draw_signal() {
  const svg = of_id("signal_plot");
  const values = curves.signal.concat(curves.approximation);
  const low = Math.min(0, ...values);
  const high = Math.max(1, ...values);
  const { at_x, at_y, left, right, top, bottom } = axes(svg, { x: [0, answer.length], y: [low, high], x_label: "t, along the ray (voxels)", y_label: "s (scalar)" });
  for (const place of answer.breaks.slice(1, -1)) drawn(svg, "line", { class: "border", x1: at_x(place), x2: at_x(place), y1: top, y2: bottom });
  of_id("border_key").hidden = answer.breaks.length < 3;
  drawn(svg, "path", { class: "signal", d: path_of(curves.signal, at_x, at_y, answer.length) });
  const color = color_of_scheme(state.scheme);
  if (curves.approximation.length) drawn(svg, "path", { class: "approximation", stroke: color, d: path_of(curves.approximation, at_x, at_y, answer.length) });
  of_id("approximation_key").style.color = color;
  of_id("approximation_name").textContent = `${state.scheme}’s` + (curves.xi === null ? " is not drawn" : `, off by ${shown_error(curves.xi)} (xi: scalar × voxels)`);
  const step = answer.length / state.steps;
  const count = answer.samples.length;
  answer.samples.forEach(([t, s], i) => {
    if (i === 0 || i === count - 1) return void drawn(svg, "circle", { cx: at_x(t), cy: at_y(s), r: count > 16 ? 2.5 : 4.5, fill: "Canvas", stroke: "currentColor", "stroke-width": 1.5 });
    handle(svg, {
      x: at_x(t), y: at_y(s), radius: count > 16 ? 3.5 : 6.5, fill: "Canvas", label: `sample ${i}`, value_text: t.toFixed(3), key_step: ((right - left) / answer.length) * step * 0.01,
      move: (dx) => {
        const phase = state.phase + ((dx / (right - left)) * answer.length) / step;
        set_phase(phase - Math.floor(phase));
      },
    });
  });
}

function top_of_values() {
  if (state.kind === "opacity") return 1;
  const most = Math.max(1, ...state.points.map((point) => point.value));
  return most * 1.1;
}

let transfer_top = 1; // stays while a point is dragged

function draw_transfer() {
  const svg = of_id("transfer_plot");
  const low = Math.min(0, state.points[0].s);
  const high = Math.max(1, state.points.at(-1).s);
  const is_opacity = state.kind === "opacity";
  const { at_x, at_y, left, right, bottom, top } = axes(svg, { x: [low, high], y: [0, transfer_top], x_label: "s (scalar)", y_label: is_opacity ? "opacity (of one voxel)" : "extinction (per voxel)" });
  const gradient = drawn(drawn(svg, "defs"), "linearGradient", { id: "ramp", gradientUnits: "userSpaceOnUse", x1: at_x(low), x2: at_x(high), y1: 0, y2: 0 });
  for (const { s, color } of state.points) drawn(gradient, "stop", { offset: (s - low) / (high - low), "stop-color": hex_of(color) });
  const first = state.points[0];
  const last = state.points.at(-1);
  const line = `M${at_x(low)} ${at_y(first.value)}` + state.points.map(({ s, value }) => `L${at_x(s)} ${at_y(value)}`).join("") + `L${at_x(high)} ${at_y(last.value)}`;
  drawn(svg, "path", { fill: "url(#ramp)", "fill-opacity": 0.55, d: `${line}V${bottom}H${left}Z` });
  drawn(svg, "path", { class: "signal", d: line });
  state.points.forEach((point, i) =>
    handle(svg, {
      x: at_x(point.s), y: at_y(point.value), fill: hex_of(point.color), label: `point ${i + 1} of the transfer function`, chosen: i === state.chosen_point,
      value_text: `s ${point.s}, ${state.kind} ${point.value}`, key_step: (right - left) / 100,
      choose: () => choose_point(i),
      move: (dx, dy) => move_point(i, state.points[i].s + (dx / (right - left)) * (high - low), state.points[i].value - (dy / (bottom - top)) * transfer_top),
    }),
  );
}

const LEAST_GAP = 0.001; // of neighbouring points: jumps are the program's matter

function move_point(index, s, value) {
  const points = state.points;
  const low = index > 0 ? points[index - 1].s + LEAST_GAP : -10;
  const high = index + 1 < points.length ? points[index + 1].s - LEAST_GAP : 10;
  points[index].s = Number(clamp(s, Math.min(low, high), high).toFixed(5));
  points[index].value = Number(clamp(value, 0, state.kind === "opacity" ? 1 : 1000).toFixed(5));
  changed();
}

function choose_point(index) {
  if (state.chosen_point === index) return;
  state.chosen_point = index;
  show_point();
  of_id("transfer_plot").querySelectorAll(".handle").forEach((other, i) => other.classList.toggle("chosen", i === index));
}

function show_point() {
  const point = state.points[state.chosen_point];
  const fields = { point_s: point.s, point_value: point.value, point_color: hex_of(point.color) };
  for (const [id, value] of Object.entries(fields)) if (document.activeElement !== of_id(id)) of_id(id).value = value;
  of_id("value_name").textContent = state.kind;
  of_id("remove_point").disabled = state.points.length < 2;
}

// --- the table ---

const shown_number = (x) => x.toFixed(6).replace("-", "−");
const shown_error = (x) => (x === 0 ? "0" : x.toExponential(1).replace("-", "−"));

const BAR_DECADES = 8;

/** A patch of a colour, or the room of one. */
function swatch(color) {
  const result = element("span", { class: "swatch" });
  if (color) result.style.background = hex_of(color);
  else result.style.visibility = "hidden";
  return result;
}

/** A name that may break behind its underscores. */
const words_of = (name) => name.split(/(?<=_)/).flatMap((word) => [word, element("wbr")]);

/** A row's first cell: a patch, and what stands beside it. */
const named = (color, name) => element("td", {}, element("span", { class: "name" }, swatch(color), name));

function bar(error) {
  const share = (x) => clamp(1 + Math.log10(x) / BAR_DECADES, 0, 1) * 100;
  const result = element("span", { class: "bar", "aria-hidden": true }, element("i"), element("b"));
  result.firstChild.style.width = `${error > 0 ? share(error) : 0}%`;
  result.lastChild.style.left = `${share(1 / 510)}%`;
  return result;
}

const row_of = (cells, name = "td") => element("tr", {}, ...cells.map((cell) => (cell instanceof HTMLTableCellElement ? cell : element(name, {}, cell))));

function error_of(scheme) {
  const total = [...scheme.color, scheme.opacity];
  const truth = [...answer.reference.color, answer.reference.opacity];
  return Math.max(...total.map((x, i) => Math.abs(x - truth[i])));
}

function show_answers() {
  const { color, opacity, error_bound, converged } = answer.reference;
  of_id("certified").textContent = `Certified, each ± ${error_bound.toExponential(2).replace("-", "−")}: red ${shown_number(color[0])}, green ${shown_number(color[1])}, blue ${shown_number(color[2])}, opacity ${shown_number(opacity)}` + (converged ? "" : "; the radius holds, but is larger than aimed at");
  const head = element("thead", {}, row_of(["scheme", "error", "", "red", "green", "blue", "opacity", "samples"], "th"));
  const certified = row_of([named(color, "certified"), "± " + shown_error(error_bound), bar(error_bound), ...[...color, opacity].map(shown_number), ""]);
  certified.className = "certified";
  let rows = schemes.filter(({ name }) => of_id("all_schemes").checked || MAIN_SCHEMES.includes(name) || name === state.scheme);
  if (of_id("order").value === "error") {
    const rank = ({ name }) => (answer.schemes[name].why ? Infinity : error_of(answer.schemes[name]));
    rows = rows.map((scheme) => [rank(scheme), scheme]).sort(([a], [b]) => (a === b ? 0 : a - b)).map(([, scheme]) => scheme);
  }
  const body = element("tbody", {}, certified);
  for (const { name, summary } of rows) {
    const scheme = answer.schemes[name];
    const button = element("button", { type: "button", title: summary, "aria-pressed": name === state.scheme }, ...words_of(name));
    button.addEventListener("click", () => {
      state.scheme = name;
      changed();
    });
    const row = scheme.why
      ? row_of([named(null, button), element("td", { class: "why", colspan: 7 }, scheme.why)])
      : row_of([named(scheme.color, button), shown_error(error_of(scheme)), bar(error_of(scheme)), ...[...scheme.color, scheme.opacity].map(shown_number), String(scheme.samples)]);
    if (!scheme.why && error_of(scheme) <= error_bound) row.cells[1].className = "noise";
    row.dataset.scheme = name;
    row.classList.toggle("chosen", name === state.scheme);
    body.append(row);
  }
  of_id("answers").replaceChildren(head, body);
  const text = state.phase === 0 ? JSON.stringify(case_of(), null, 1) : "";
  of_id("case").value = text;
  of_id("copy").disabled = !text;
  of_id("case_note").textContent = text ? "Saved as ray.json: raytruth eval ray.json" : "The program's own samples begin with a whole step, so the phase has to be 0.";
}

// --- lit slabs ---

const slabs = JSON.parse(of_id("lit_slabs").textContent);
const shadings = JSON.parse(of_id("shadings").textContent);
const DRAWN_SHADINGS = ["mean_gradient", "linear_gradient", "quadratic_arc", "slerp", "circle_arc", "linear_intensity"];

const largest_difference = (a, b) => Math.max(...a.map((x, i) => Math.abs(x - b[i])));
const sum = (...colors) => colors[0].map((_, i) => colors.reduce((total, color) => total + color[i], 0));

/** Errors of a method: of diffuse light, of the highlight, and of both together. */
function slab_errors(row, name) {
  const [truth, [diffuse, specular]] = [row.reference, row.schemes[name]];
  return [largest_difference(diffuse, truth[0]), largest_difference(specular, truth[1]), largest_difference(sum(diffuse, specular), sum(...truth))];
}

function show_slabs() {
  const rows = slabs.answers[of_id("highlight").value];
  const index = slabs.angles.indexOf(Number(of_id("angle").value));
  const row = rows[index];
  of_id("angle_out").textContent = `${slabs.angles[index]}°`;
  const light = sum(row.ambient, ...row.reference);
  of_id("slab_certified").textContent = `Certified by the program, each ± ${row.radius.toExponential(2).replace("-", "−")}: diffuse ${row.reference[0].map(shown_number).join(", ")}; specular ${shown_number(row.reference[1][0])}; opacity ${shown_number(row.opacity)}`;
  const head = element("thead", {}, row_of(["method", "error", "diffuse error", "specular error", "red", "green", "blue"], "th"));
  const certified = row_of([named(light, "certified"), "", "", "", ...light.map(shown_number)]);
  certified.className = "certified";
  const body = element("tbody", {}, certified);
  for (const name of Object.keys(row.schemes)) {
    const scheme = row.schemes[name];
    const title = element("span", { title: shadings[name] }, ...words_of(name));
    if (scheme.why) {
      body.append(row_of([named(null, title), element("td", { class: "why", colspan: 6 }, scheme.why)]));
      continue;
    }
    const color = sum(row.ambient, ...scheme);
    const [diffuse, specular, both] = slab_errors(row, name);
    body.append(row_of([named(color, title), ...[both, diffuse, specular].map(shown_error), ...color.map(shown_number)]));
  }
  of_id("slabs").replaceChildren(head, body);

  const { at_x, at_y, top, bottom } = axes(of_id("angle_plot"), { x: [0, 180], y: [1e-6, 100], y_log: true, x_label: "angle between the normals (degrees)", y_label: "error (linear light)" });
  const svg = of_id("angle_plot");
  drawn(svg, "line", { class: "axis", x1: at_x(slabs.angles[index]), x2: at_x(slabs.angles[index]), y1: top, y2: bottom });
  const key = of_id("angle_key");
  key.replaceChildren();
  DRAWN_SHADINGS.forEach((name, i) => {
    const points = rows.map((other, j) => `${j ? "L" : "M"}${at_x(slabs.angles[j]).toFixed(1)} ${at_y(slab_errors(other, name)[2]).toFixed(1)}`).join("");
    const look = { class: "method", fill: "none", stroke: COLORS[i], "stroke-width": 2.5, "stroke-dasharray": DASHES[i] };
    drawn(svg, "path", { ...look, d: points });
    const item = element("span", { class: "together" });
    drawn(drawn(item, "svg", { class: "line", viewBox: "0 0 36 10" }), "path", { ...look, d: "M0 5H36" });
    item.append(name);
    key.append(item, " ");
  });
}

// --- controls ---

const VOXEL_NAMES = ["000", "100", "010", "110", "001", "101", "011", "111"];

function show_signal_controls() {
  const controls = of_id("signal_controls");
  const set = (target, key) => (value) => {
    target[key] = value;
    changed();
  };
  of_id("signal_note").textContent = NOTES[state.signal];
  const lists = {
    cell: () => [
      element("p", { class: "small" }, "voxels, at x y z"),
      element("div", { class: "voxels" }, ...state.voxels.map((value, i) => slider(VOXEL_NAMES[i], 0, 1, 0.01, value, set(state.voxels, i)))),
      element("p", { class: "small" }, "the ray, from its entry to its exit"),
      element("div", { class: "voxels" }, ...[0, 1, 2].flatMap((axis) => [slider(`in ${"xyz"[axis]}`, 0, 1, 0.01, state.entry[axis], set(state.entry, axis)), slider(`out ${"xyz"[axis]}`, 0, 1, 0.01, state.exit[axis], set(state.exit, axis))])),
    ],
    peak: () => state.peak.map((value, i) => slider(`coefficient ${i}`, -0.5, 1.5, 0.01, value, set(state.peak, i))),
    random: () => [slider("seed", 1, 1000, 1, state.seed, set(state, "seed")), slider("cubics", 1, 16, 1, state.pieces, set(state, "pieces"))],
    marschner_lobb: () => [slider("heading (°)", 0, 90, 1, state.heading, set(state, "heading")), slider("height z", 0, 38, 0.5, state.height, set(state, "height"))],
  };
  controls.replaceChildren(...lists[state.signal]());
}

function set_phase(phase) {
  state.phase = Number(clamp(phase, 0, 0.9999).toFixed(4));
  changed();
}

let is_waiting = false;

/** Computes and draws before the next frame, however often it is called until then. */
function changed() {
  if (is_waiting) return;
  is_waiting = true;
  requestAnimationFrame(() => {
    is_waiting = false;
    refresh();
  });
}

function refresh() {
  try {
    compute();
    of_id("problem").textContent = "";
  } catch (error) {
    of_id("problem").textContent = error.message;
    return;
  }
  of_id("steps").value = state.steps;
  of_id("steps_out").textContent = state.steps;
  of_id("phase").value = state.phase;
  of_id("phase_out").textContent = `${state.phase.toFixed(2)} h`;
  of_id("sampling_note").textContent = `Step h = ${Number((answer.length / state.steps).toPrecision(4))} voxels on a ray of ${Number(answer.length.toPrecision(4))}. ` + (state.phase ? "The first step is shorter, as with jittered rays, and the last: schemes that need equal steps say so." : "");
  const most = top_of_values();
  if (most > transfer_top || most < transfer_top / 3 || state.kind === "opacity") transfer_top = most;
  draw_signal();
  draw_transfer();
  show_point();
  show_answers();
}

function listen() {
  const on = (id, name, act) => of_id(id).addEventListener(name, act);
  on("signal", "change", () => {
    state.signal = of_id("signal").value;
    state.steps = { cell: 4, peak: 8, random: 2 * state.pieces, marschner_lobb: 24 }[state.signal];
    show_signal_controls();
    changed();
  });
  on("steps", "input", () => ((state.steps = Number(of_id("steps").value)), changed()));
  on("phase", "input", () => set_phase(Number(of_id("phase").value)));
  for (const name of Object.keys(PRESETS)) of_id("preset").append(element("option", {}, name));
  on("preset", "change", () => {
    state.points = preset_points(of_id("preset").value);
    if (state.kind === "opacity") state.points.forEach((point) => (point.value = opacity_of(point.value)));
    state.chosen_point = Math.min(2, state.points.length - 1);
    changed();
  });
  on("kind", "change", () => {
    state.kind = of_id("kind").value;
    for (const point of state.points) point.value = state.kind === "opacity" ? opacity_of(point.value) : extinction_of(point.value);
    transfer_top = top_of_values();
    changed();
  });
  on("emission", "change", () => ((state.emission = of_id("emission").value), changed()));
  const read_point = () => {
    const [s, value] = ["point_s", "point_value"].map((id) => of_id(id).valueAsNumber);
    if (Number.isFinite(s) && Number.isFinite(value)) move_point(state.chosen_point, s, value);
  };
  on("point_s", "change", read_point);
  on("point_value", "change", read_point);
  on("point_color", "input", () => ((state.points[state.chosen_point].color = color_of(of_id("point_color").value)), changed()));
  on("add_point", "click", () => {
    const index = Math.min(state.chosen_point, state.points.length - 2);
    const [a, b] = index < 0 ? [state.points[0], { ...state.points[0], s: state.points[0].s + 0.2 }] : [state.points[index], state.points[index + 1]];
    if (b.s - a.s < 3 * LEAST_GAP) return;
    const middle = (x, y) => Number(((x + y) / 2).toFixed(5));
    state.points.splice(index + 1, 0, { s: middle(a.s, b.s), value: middle(a.value, b.value), color: a.color.map((x, i) => middle(x, b.color[i])) });
    state.chosen_point = index + 1;
    changed();
  });
  on("remove_point", "click", () => {
    state.points.splice(state.chosen_point, 1);
    state.chosen_point = Math.min(state.chosen_point, state.points.length - 1);
    changed();
  });
  on("all_schemes", "change", changed);
  on("order", "change", changed);
  on("copy", "click", () => {
    of_id("case").select();
    navigator.clipboard?.writeText(of_id("case").value);
  });
  let width = innerWidth;
  window.addEventListener("resize", () => {
    if (width === innerWidth) return; // phones hide their bars while they scroll
    width = innerWidth;
    changed();
    show_slabs();
  });
  on("angle", "input", show_slabs);
  on("highlight", "change", show_slabs);
}

const opacity_of = (extinction) => Number((1 - Math.exp(-extinction)).toFixed(5));
const extinction_of = (opacity) => Number((-Math.log(Math.max(1 - opacity, 1e-5))).toFixed(5));

/** For the console and for tests. */
window.explorer = { state, refresh, case_of, answer: () => answer, error_of, slabs, show_signal_controls };

of_id("angle").value = 90;
listen();
show_signal_controls();
show_slabs();
window.explorer.ready = (async () => {
  const packed = Uint8Array.from(atob(of_id("engine_binary").textContent), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  engine = await make_explorer({ wasmBinary: await new Response(stream).arrayBuffer() });
  schemes = ask("schemes");
  refresh();
})().catch((error) => {
  of_id("problem").textContent = `The engine did not start: ${error.message}. It needs WebAssembly with 128-bit registers, as all browsers have since 2023.`;
});

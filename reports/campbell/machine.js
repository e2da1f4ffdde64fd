// The machine in one mode at one speed: x downwind, y to port, z up. Data: see moving_machine.py.
"use strict";

const data = JSON.parse(document.getElementById("machine-data").textContent);
const state = { mode: 0, speed: data.speeds.length - 1, turns: true, playing: false, phase: 0, amplitude: 1 };
const PERIOD = 2.0; // seconds on the screen for one period of a mode
const FRAME = 40; // ms between pictures
const by = (id) => document.getElementById(id);

const real = (pair, c, s) => pair[0] * c - pair[1] * s; // of (re + i im) e^{i phase}
const ground = (p) => [p[2], -p[1], p[0]];

// factors of the multi-blade coordinates of blade k at its azimuth
function factors(count, psi, k) {
  const out = [1];
  for (let h = 1; 2 * h < count; h++) out.push(Math.cos(h * psi), Math.sin(h * psi));
  if (count % 2 === 0) out.push(k % 2 ? -1 : 1);
  return out;
}

function positions() {
  const speed = data.speeds[state.speed];
  const mode = speed.modes[state.mode];
  const size = data.size * state.amplitude;
  const c = Math.cos(state.phase), s = Math.sin(state.phase);
  const tower = speed.tower.map((p, i) => ground(p.map((x, j) => x + size * real(mode.tower[i][j], c, s))));
  const hub = mode.hub.map((pair) => size * real(pair, c, s));
  const azimuth = state.turns ? (state.phase * speed.omega) / mode.omega : 0;
  const place = (r, moved) => {
    const [u, v, w, a, b, g] = hub; // displacement and rotation of the hub
    const q = [r[0] + moved[0] + u + b * r[2] - g * r[1], r[1] + moved[1] + v + g * r[0] - a * r[2],
      r[2] + moved[2] + w + a * r[1] - b * r[0]];
    return ground(speed.shaft.map((row) => row[0] * q[0] + row[1] * q[1] + row[2] * q[2] + row[3]));
  };
  const blades = [];
  for (let k = 0; k < data.blades; k++) {
    const psi = azimuth + (2 * Math.PI * k) / data.blades;
    const by_coordinate = factors(data.blades, psi, k);
    const cp = Math.cos(psi), sp = Math.sin(psi);
    const turn = (p) => [cp * p[0] - sp * p[1], sp * p[0] + cp * p[1], p[2]];
    blades.push([[0, 0, 0], ...speed.blade].map((p, n) => {
      const own = [0, 0, 0];
      if (n > 0) by_coordinate.forEach((f, m) => {
        for (let j = 0; j < 3; j++) own[j] += f * size * real(mode.blades[m][n - 1][j], c, s);
      });
      return place(turn(p), turn(own));
    }));
  }
  return { tower, nacelle: [tower[tower.length - 1], blades[0][0]], blades };
}

const columns = (points) => [0, 1, 2].map((j) => points.map((p) => p[j]));

function traces() {
  const p = positions();
  return [p.tower, p.nacelle, ...p.blades].map(columns);
}

function draw() {
  const [x, y, z] = [0, 1, 2].map((j) => traces().map((t) => t[j]));
  Plotly.restyle("machine", { x, y, z }, x.map((_, n) => n + 1));
}

function caption() {
  const speed = data.speeds[state.speed], mode = speed.modes[state.mode];
  by("caption").textContent = `${mode.name}: ${mode.frequency} at ${speed.label}; confidence of the name ${mode.confidence}`;
  by("speed-label").textContent = speed.label;
}

function select(mode, speed) {
  state.mode = mode;
  state.speed = speed;
  by("mode").value = mode;
  by("speed").value = speed;
  caption();
  draw();
}

function play(on) {
  state.playing = on;
  by("play").textContent = on ? "Stop" : "Play";
  by("play").setAttribute("aria-pressed", on);
}

function start() {
  const rest = columns(data.speeds[0].tower.map(ground));
  const line = (t, name, color, width, dash) => ({ type: "scatter3d", mode: "lines", name, x: t[0], y: t[1], z: t[2],
    line: { color, width, dash }, hoverinfo: "name" });
  const names = ["tower", "nacelle", ...Array.from({ length: data.blades }, (_, k) => `blade ${k + 1}`)];
  const colours = [data.colours[7], data.colours[7], data.colours[1], ...Array(data.blades - 1).fill(data.colours[0])];
  const drawn = traces().map((t, n) => line(t, names[n], colours[n], n < 2 ? 14 : 9));
  const side = { range: [-data.reach, data.reach] };
  const axis = (title, more) => ({ title: { text: title }, ...more });
  Plotly.newPlot("machine", [line(rest, "tower at rest", "#b0b0b0", 3, "dot"), ...drawn], {
    scene: {
      xaxis: axis("downwind, m", side), yaxis: axis("to port, m", side), zaxis: axis("up, m", { range: [0, data.top] }),
      aspectmode: "manual", aspectratio: { x: 1, y: 1, z: data.top / (2 * data.reach) },
      camera: { eye: { x: -1.5, y: -1.1, z: 0.35 }, center: { x: 0, y: 0, z: -0.12 } },
    },
    showlegend: false, margin: { l: 0, r: 0, t: 0, b: 0 }, height: 560, uirevision: "keep",
  }, { responsive: true, displaylogo: false });
  data.names.forEach((name, n) => by("mode").add(new Option(name, n)));
  by("speed").max = data.speeds.length - 1;
  by("mode").onchange = (e) => select(Number(e.target.value), state.speed);
  by("speed").oninput = (e) => select(state.mode, Number(e.target.value));
  by("amplitude").oninput = (e) => { state.amplitude = Number(e.target.value); draw(); };
  by("turns").onchange = (e) => { state.turns = e.target.checked; draw(); };
  by("play").onclick = () => play(!state.playing);
  by("diagram").on("plotly_click", (event) => {
    const { curveNumber, pointNumber } = event.points[0];
    if (curveNumber < data.names.length) select(curveNumber, pointNumber);
  });
  setInterval(() => {
    if (!state.playing || document.hidden) return;
    state.phase += (2 * Math.PI * FRAME) / 1000 / PERIOD;
    draw();
  }, FRAME);
  if (window.innerWidth < 700) {
    Plotly.relayout("diagram", { legend: { orientation: "h", y: -0.15, font: { size: 11 } }, height: 680,
      "margin.l": 45, "margin.r": 16 });
    Plotly.relayout("machine", { height: 420, "scene.camera.eye": { x: -1.9, y: -1.4, z: 0.4 } });
  }
  select(0, state.speed);
  play(!window.matchMedia("(prefers-reduced-motion: reduce)").matches);
}

start();

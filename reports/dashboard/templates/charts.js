"use strict";
// Drawing: elements made by name, lines over linear or logarithmic axes, and a blade that turns.

const SVG = "http://www.w3.org/2000/svg";
// Okabe and Ito's colours, told apart without telling red from green
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a6d00", "#7a7a7a"];

function make(name, attributes = {}, ...children) {
  const element = name.startsWith("svg:") ? document.createElementNS(SVG, name.slice(4)) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

function ticks(low, high, log) {
  if (log) {
    const out = [];
    for (let p = Math.ceil(Math.log10(low)); p <= Math.floor(Math.log10(high)); p++) out.push(10 ** p);
    return out;
  }
  const rough = (high - low) / 6 || 1;
  const unit = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * unit).find((s) => s >= rough);
  const out = [];
  for (let v = Math.ceil(low / step - 1e-9) * step; v <= high + 1e-9 * step; v += step) out.push(Math.abs(v) < 1e-12 * step ? 0 : v);
  return out;
}

function short(value) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(0).replace("e+", "e") : String(Number(value.toPrecision(4)));
}

// series: [{name, points: [[x, y], …], colour, marks, line, dash, title}]
function chart(series, { x, y, logX = false, logY = false, height = 300, yMin = null, label = "" }) {
  const all = series.flatMap((s) => s.points).filter(([a, b]) => Number.isFinite(a) && Number.isFinite(b));
  const width = 460, left = 58, right = 10, top = 10, bottom = 40;
  const svg = make("svg:svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label });
  if (!all.length) {
    svg.append(make("svg:text", { x: width / 2, y: height / 2, "text-anchor": "middle" }, "nothing to draw"));
    return svg;
  }
  const span = (k, log, least) => {
    let low = Math.min(...all.map((p) => p[k])), high = Math.max(...all.map((p) => p[k]));
    if (least !== null) low = least;
    if (log) return [low / 1.3, high * 1.3];
    const room = 0.05 * (high - low || Math.abs(high) || 1);
    return [least === null ? low - room : low, high + room];
  };
  const [x0, x1] = span(0, logX, logX ? null : Math.min(0, ...all.map((p) => p[0]))), [y0, y1] = span(1, logY, yMin);
  const scale = (v, a, b, from, to, log) => from + (to - from) * (log ? Math.log(v / a) / Math.log(b / a) : (v - a) / (b - a));
  const X = (v) => scale(v, x0, x1, left, width - right, logX), Y = (v) => scale(v, y0, y1, height - bottom, top, logY);
  for (const v of ticks(y0, y1, logY)) {
    svg.append(make("svg:line", { class: "grid", x1: left, x2: width - right, y1: Y(v), y2: Y(v) }));
    svg.append(make("svg:text", { x: left - 5, y: Y(v) + 4, "text-anchor": "end" }, short(v)));
  }
  const across = logX ? [...new Set(all.map((p) => p[0]))].sort((a, b) => a - b) : ticks(x0, x1, false);
  let last = -99;
  for (const v of across) {
    if (X(v) - last < 26) continue;
    last = X(v);
    svg.append(make("svg:text", { x: X(v), y: height - bottom + 15, "text-anchor": "middle" }, short(v)));
  }
  svg.append(make("svg:line", { class: "axis", x1: left, x2: width - right, y1: height - bottom, y2: height - bottom }));
  svg.append(make("svg:text", { x: (left + width) / 2, y: height - 6, "text-anchor": "middle" }, x));
  svg.append(make("svg:text", { x: 12, y: (height - bottom) / 2, "text-anchor": "middle", transform: `rotate(-90 12 ${(height - bottom) / 2})` }, y));
  const clip = (v) => Math.max(top, Math.min(height - bottom, v));
  for (const s of series) {
    const points = s.points.filter(([a, b]) => Number.isFinite(a) && Number.isFinite(b));
    const group = make("svg:g", {}, make("svg:title", {}, s.title || s.name));
    if (s.line !== false && points.length > 1) {
      const path = points.map(([a, b]) => `${X(a).toFixed(1)},${clip(Y(b)).toFixed(1)}`).join(" ");
      group.append(make("svg:polyline", { points: path, fill: "none", stroke: s.colour, "stroke-width": s.width || 1.6, "stroke-dasharray": s.dash || null }));
    }
    if (s.marks) for (const [a, b] of points) group.append(make("svg:circle", { cx: X(a), cy: clip(Y(b)), r: 3, fill: s.colour }, make("svg:title", {}, `${s.name}: ${short(a)}, ${b.toPrecision(7)}`)));
    svg.append(group);
  }
  return svg;
}

function legend(series) {
  const seen = new Set(), line = make("p", { class: "muted" });
  for (const s of series) {
    if (seen.has(s.name) || s.quiet) continue;
    seen.add(s.name);
    line.append(make("span", { style: `color:${s.colour};font-weight:700` }, "● "), s.name, "   ");
  }
  return line;
}

// The rotor from above and aside, one blade moving in a mode; returns functions to set the mode and to stop.
function rotor(canvas, shapes) {
  const pen = canvas.getContext("2d");
  const quiet = matchMedia("(prefers-reduced-motion: reduce)").matches;
  let mode = 0, playing = !quiet, begun = performance.now(), held = 0;
  const project = ([x, y, z], angle) => {
    const a = Math.cos(angle), b = Math.sin(angle);
    const u = a * x - b * y, v = b * x + a * y;  // turned about the rotor's axis, z
    const scale = 0.42 * canvas.width / shapes.length;
    return [canvas.width / 2 + scale * u, canvas.height * 0.52 - scale * (0.42 * v + 0.9 * z)];
  };
  const line = (points, angle, colour, width) => {
    pen.beginPath();
    points.forEach((p, k) => { const [u, v] = project(p, angle); k ? pen.lineTo(u, v) : pen.moveTo(u, v); });
    pen.strokeStyle = colour; pen.lineWidth = width; pen.stroke();
  };
  const draw = (now) => {
    const t = playing ? (now - begun) / 1000 : held;
    const m = shapes.modes[mode];
    const ink = getComputedStyle(document.body).color;
    pen.clearRect(0, 0, canvas.width, canvas.height);
    const angle = shapes.omega ? 0.25 * t : 0, phase = 2 * Math.PI * 0.7 * t, c = Math.cos(phase), s = Math.sin(phase);
    const circle = Array.from({ length: 73 }, (_, k) => { const a = k * Math.PI / 36; return [shapes.length * Math.cos(a), shapes.length * Math.sin(a), 0]; });
    line(circle, 0, "#9aa4ae55", 1);
    const moved = shapes.rest.map((p, k) => p.map((v, i) => v + m.re[k][i] * c - m.im[k][i] * s));
    line(shapes.rest, angle, "#9aa4ae", 1.5);
    line([[0, 0, 0], shapes.rest[0]], angle, ink, 6);
    line(moved, angle, "#0072b2", 3.5);
    if (playing) requestAnimationFrame(draw);
  };
  draw(begun);
  return {
    mode(k) { mode = k; if (!playing) draw(0); },
    toggle() {
      const now = performance.now();
      if (playing) { held = (now - begun) / 1000; playing = false; }
      else { begun = now - held * 1000; playing = true; requestAnimationFrame(draw); }
      return playing;
    },
    playing: () => playing,
  };
}

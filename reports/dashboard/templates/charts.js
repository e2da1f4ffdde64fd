"use strict";
// Lines and points over linear or logarithmic axes, as SVG.

const WIDTH = 460, LEFT = 58, RIGHT = 26, TOP = 12, BOTTOM = 40;
const colour = (k) => COLOURS[k % COLOURS.length];
const dash = (k) => [null, "6 3", "2 3"][Math.floor(k / COLOURS.length) % 3];  // the second and third time round the colours

function ticks(low, high, log, whole = false) {
  const out = [];
  if (log) {
    for (let p = Math.ceil(Math.log10(low)); p <= Math.floor(Math.log10(high)); p++) out.push(10 ** p);
    return out;
  }
  const rough = (high - low) / 6 || 1, size = 10 ** Math.floor(Math.log10(rough));
  const fit = [1, 2, 5, 10].map((m) => m * size).find((s) => s >= rough), step = whole ? Math.max(1, Math.round(fit)) : fit;
  for (let v = Math.ceil(low / step - 1e-9) * step; v <= high + 1e-9 * step; v += step) out.push(Math.abs(v) < 1e-12 * step ? 0 : v);
  return out;
}

function short(value, near = 0) {
  if (value === 0) return "0";
  const size = Math.abs(value), count = near ? Math.min(15, Math.max(4, Math.ceil(Math.log10(size / near)) + 1)) : 4;
  return size >= 1e5 || size < 1e-3 ? Number(value.toPrecision(3)).toExponential().replace("e+", "e") : String(Number(value.toPrecision(count)));
}

// series: [{name, points: [[x, y], …], colour, marks, line, dash, width, quiet, end, bars: half heights}]
function chart(series, { x, y, logX = false, logY = false, whole = false, height = 300, yMin = null, label = "", steps = [] }) {
  const finite = ([a, b]) => Number.isFinite(a) && Number.isFinite(b);
  const all = series.flatMap((s) => s.points).filter(finite);
  const svg = make("svg:svg", { viewBox: `0 0 ${WIDTH} ${height}`, role: "img", "aria-label": label });
  if (!all.length) {
    svg.append(make("svg:text", { x: WIDTH / 2, y: height / 2, "text-anchor": "middle" }, "nothing to draw"));
    return svg;
  }
  const span = (k, log, least) => {
    const values = all.map((p) => p[k]), low = least ?? Math.min(...values), high = Math.max(...values);
    if (log) return [low / 1.3, high * 1.3];
    const room = 0.05 * (high - low || Math.abs(high) || 1);
    return [least === null ? low - room : low, high + room];
  };
  const [x0, x1] = span(0, logX, logX || whole ? null : Math.min(0, ...all.map((p) => p[0]))), [y0, y1] = span(1, logY, yMin);
  const scale = (v, a, b, from, to, log) => from + (to - from) * (log ? Math.log(v / a) / Math.log(b / a) : (v - a) / (b - a));
  const X = (v) => scale(v, x0, x1, LEFT, WIDTH - RIGHT, logX), Y = (v) => scale(v, y0, y1, height - BOTTOM, TOP, logY);
  const upright = ticks(y0, y1, logY), near = upright.length > 1 ? upright[1] - upright[0] : 0;
  for (const v of upright) {
    svg.append(make("svg:line", { class: "grid", x1: LEFT, x2: WIDTH - RIGHT, y1: Y(v), y2: Y(v) }));
    svg.append(make("svg:text", { x: LEFT - 5, y: Y(v) + 4, "text-anchor": "end" }, short(v, logY ? 0 : near)));
  }
  const across = logX ? unique(all.map((p) => p[0])).sort((a, b) => a - b) : ticks(x0, x1, false, whole);
  let last = -99;
  for (const v of across) {
    if (X(v) - last < 26) continue;
    last = X(v);
    svg.append(make("svg:text", { x: X(v), y: height - BOTTOM + 15, "text-anchor": "middle" }, short(v)));
  }
  for (const v of steps) svg.append(make("svg:line", { class: "step", x1: X(v), x2: X(v), y1: TOP, y2: height - BOTTOM }, make("svg:title", {}, `step at ${v}`)));
  const middle = (height - BOTTOM) / 2;
  svg.append(make("svg:line", { class: "axis", x1: LEFT, x2: WIDTH - RIGHT, y1: height - BOTTOM, y2: height - BOTTOM }),
    make("svg:text", { x: (LEFT + WIDTH) / 2, y: height - 6, "text-anchor": "middle" }, x),
    make("svg:text", { x: 12, y: middle, "text-anchor": "middle", transform: `rotate(-90 12 ${middle})` }, y));
  for (const s of series) {
    const points = s.points.filter(finite), group = make("svg:g", {}, make("svg:title", {}, s.name));
    if (s.line !== false && points.length > 1) {
      group.append(make("svg:polyline", { points: points.map(([a, b]) => `${X(a).toFixed(1)},${Y(b).toFixed(1)}`).join(" "), fill: "none",
        stroke: s.colour, "stroke-width": s.width || 1.6, "stroke-dasharray": s.dash }));
    }
    s.points.forEach(([a, b], k) => s.bars?.[k] && group.append(make("svg:line", { x1: X(a), x2: X(a), y1: Y(Math.max(b - s.bars[k], y0)), y2: Y(Math.min(b + s.bars[k], y1)), stroke: s.colour, "stroke-width": 1.4 })));
    if (s.marks) for (const [a, b] of points) group.append(make("svg:circle", { cx: X(a), cy: Y(b), r: 2.6, fill: s.colour }, make("svg:title", {}, `${s.name}: ${short(a)}, ${b.toPrecision(7)}`)));
    if (s.end && points.length) group.append(make("svg:text", { x: X(points.at(-1)[0]) + 4, y: Y(points.at(-1)[1]) + 4 }, s.end));
    svg.append(group);
  }
  return svg;
}

function legend(series) {
  const entries = series.filter((s, k) => !s.quiet && series.findIndex((other) => other.name === s.name) === k);
  return make("p", { class: "legend" }, ...entries.map((s) => make("span", {},
    make("svg:svg", { viewBox: "0 0 22 8", class: "key", "aria-hidden": "true" }, make("svg:line", { x1: 0, x2: 22, y1: 4, y2: 4, stroke: s.colour, "stroke-width": 2.4, "stroke-dasharray": s.dash }),
      s.marks ? make("svg:circle", { cx: 11, cy: 4, r: 3, fill: s.colour }) : null), s.name)));
}

"use strict";
// A case: its words, Campbell diagram, convergence, moving mode shapes, times, every mode and code.

const solved = DATA.cells.filter((c) => c.f !== null && c.mode && c.quantity === "frequency");
const inWords = (speed) => at(speed, DATA.speed);

function casePage() {
  const s = DATA.setting;
  MAIN.append(make("h1", {}, DATA.name));
  if (s) MAIN.append(make("p", {}, s.title));
  MAIN.append(make("div", { id: "headline", class: `v${DATA.answered}` }, make("p", {}, make("strong", {}, DATA.answer)), ...DATA.verdict_counts.map((t) =>
    make("p", {}, `${t.count} ${sign(t.verdict)}`, t.text ? `, at worst ${t.text} (${t.where})` : t.where ? ` (${t.where})` : ""))));
  if (s) MAIN.append(make("p", { class: "muted" }, s.description),
    make("p", { class: "muted" }, Object.entries(s.facts).map(([k, v]) => `${k}: ${v}`).join(" · ")), make("p", { class: "muted" }, `Source: ${s.source}`));
  differences();
  MAIN.append(make("div", { class: "pair" }, make("div", {}, campbell(), convergence()), make("div", {}, viewer())));
  everything();
}

function differences() {
  const speeds = unique(DATA.cells.map((c) => c.speed)).sort((a, b) => a - b);
  const place = make("div", {}), detail = make("div", { id: "detail", "aria-live": "polite" });
  const draw = (speed) => {
    const here = DATA.cells.filter((c) => c.speed === Number(speed)), modes = unique(here.filter((c) => c.mode).sort((a, b) => a.mode - b.mode).map((c) => c.name));
    const columns = DATA.columns.filter((name) => here.some((c) => c.code === name));
    const silent = columns.filter((name) => !here.some((c) => c.code === name && c.mode));
    const field = (name, code) => {
      const c = here.find((cell) => cell.code === code && (cell.name === name || !cell.mode));
      return c ? { verdict: c.verdict, text: c.text, label: `${name}, ${code}: ${DATA.verdicts[c.verdict].name} ${c.text}`,
        tell: () => [make("strong", {}, c.mode ? `${name} × ${code}` : code), "  ", chip(c.verdict), c.text, c.f === null ? null : ` · ${digits(c.f, 8)} ${c.unit}, Southwell's own solver ${digits(c.ref, 8)} · target ${c.target}`,
          c.reason ? make("p", { class: "muted" }, c.reason) : null] } : null;
    };
    const answering = columns.filter((name) => !silent.includes(name));
    const core = (name) => {  // of a code that leaves effects out, another mode may have this name
      const named = here.filter((c) => c.name === name && c.full !== null);
      return (named.find((c) => c.ref === c.full) || named[0])?.full;
    };
    const reasons = new Map();
    for (const name of silent) {
      const c = here.find((cell) => cell.code === name), why = `${sign(c.verdict)}: ${c.reason}`;
      reasons.set(why, [...(reasons.get(why) || []), name]);
    }
    place.replaceChildren(modes.length ? grid("mode", modes.map((name) => make("span", {}, name, make("small", {}, core(name) ? ` ${digits(core(name), 6)}` : ""))), answering, modes.map((name) => answering.map((code) => field(name, code))), detail) : make("p", {}, "No code has an answer at this speed."),
      silent.length ? make("details", { class: "muted" }, make("summary", {}, `No answer: ${silent.join(", ")}`),
        make("ul", {}, ...[...reasons].map(([why, names]) => make("li", {}, make("strong", {}, names.join(", ")), ` ${why}`)))) : "");
  };
  MAIN.append(make("h2", {}, "Difference ± uncertainty"), make("div", { class: "filters" }, chooser("speed", speeds.map((v) => [v, inWords(v)]), draw, "speed", speeds.at(-1))), place, detail,
    make("p", { class: "muted" }, `Beside each mode: Southwell's own solver with all effects, ${DATA.frequency}. Known differences are from this value; other differences are from Southwell's own solver with the same effects as the code.`));
  draw(speeds.at(-1));
}

// Between two speeds a frequency's square runs straight in the speed's (Southwell 1921).
function curve([x, f], [x1, f1]) {
  return Array.from({ length: 8 }, (_, k) => x + (x1 - x) * (k + 1) / 8).map((s) => [s, Math.sqrt(f * f + (f1 * f1 - f * f) * (s * s - x * x) / (x1 * x1 - x * x))]);
}

function campbell() {
  const names = DATA.lines.map((line) => line.name), on = new Set([1, 2, 3]), place = make("div", {});
  let code = "";
  const toggle = (n) => make("button", { "aria-pressed": String(on.has(n)), onclick: (event) => {
    if (!on.delete(n)) on.add(n);
    event.currentTarget.setAttribute("aria-pressed", String(on.has(n)));
    draw();
  } }, `${n}P`);
  const last = Math.max(...solved.map((c) => c.speed));
  const controls = make("div", { class: "filters", role: "group", "aria-label": "Lines and marks" },
    last > 0 ? make("span", { class: "group" }, ...[1, 2, 3, 4, 5, 6, 9, 12].map(toggle)) : null,
    chooser("marks", [["", "all codes"], ["none", "none"], ...unique(solved.map((c) => c.code)).map((c) => [c, c])], (v) => { code = v; draw(); }, "marks"));
  function draw() {
    const core = DATA.lines.map(({ name, points }, k) => ({ name, colour: colour(k), dash: dash(k), points: points.flatMap((p, i) => (i ? curve(points[i - 1], p) : [p])) }));
    const top = Math.max(...core.flatMap((c) => c.points.map((p) => p[1])));
    const rays = last > 0 ? [...on].sort((a, b) => a - b).map((n) => {
      const end = Math.min(last, top / (n * DATA.perSpeed));
      return { name: `${n}P`, end: `${n}P`, colour: "#8a949e", width: 1, quiet: true, points: [[0, 0], [end, n * DATA.perSpeed * end]] };
    }) : [];
    const dots = names.map((name, k) => ({ name, colour: colour(k), marks: true, line: false,
      points: solved.filter((c) => c.bar === null && (names.includes(c.name) ? c.name : `mode ${c.mode}`) === name && (!code || c.code === code)).map((c) => [c.speed, c.f]) }));
    const measured = unique(solved.filter((c) => c.bar !== null).map((c) => c.code)).filter((name) => !code || name === code).map((name) => {
      const mine = solved.filter((c) => c.code === name);
      return { name: `${name}, measured ± 2 u_val`, colour: "currentColor", marks: true, line: false, bars: mine.map((c) => c.bar), points: mine.map((c) => [c.speed, c.f]) };
    });
    const drawing = chart([...rays, ...core, ...dots, ...measured], { x: `rotor speed, ${DATA.speed}`, y: `frequency, ${DATA.frequency}`, yMin: 0, label: "Campbell diagram" });
    place.replaceChildren(drawing, legend([...core, ...measured]));
  }
  const block = make("section", {}, make("h2", {}, "Campbell diagram"));
  if (!solved.length) { block.append(make("p", { class: "muted" }, "No code has an answer.")); return block; }
  draw();
  block.append(controls, place, make("p", { class: "muted" }, "Lines: Southwell's own solver, all effects. Points: the codes' answers; with bars: measured data. nP: n per revolution."));
  return block;
}

function convergence() {
  const split = (key) => key.split("|").map(Number);
  const block = make("section", {}, make("h2", {}, "Convergence")), place = make("div", {});
  const keys = unique(DATA.levels.map((v) => `${v[1]}|${v[2]}`)).sort((a, b) => split(b)[0] - split(a)[0] || split(a)[1] - split(b)[1]);
  if (!keys.length) { block.append(make("p", { class: "muted" }, "No refinements in this run.")); return block; }
  const named = ([speed, mode]) => `${DATA.cells.find((c) => c.speed === speed && c.mode === mode && c.quantity === "frequency")?.name || `mode ${mode}`}, ${inWords(speed)}`;
  function draw(key) {
    const [speed, mode] = split(key), levels = DATA.levels.filter((v) => v[1] === speed && v[2] === mode);
    const series = unique(levels.map((v) => v[0])).map((code, k) => {
      const core = DATA.cells.find((c) => c.code === code && c.speed === speed && c.mode === mode && c.quantity === "frequency")?.ref;
      const points = levels.filter((v) => v[0] === code && core).map((v) => [v[3], Math.max(Math.abs(v[4] / core - 1), 1e-14)]).sort((a, b) => a[0] - b[0]);
      return { name: code, colour: colour(k), dash: dash(k), points, marks: true };
    }).filter((s) => s.points.length);
    place.replaceChildren(chart(series, { x: "elements, or terms of a series", y: "difference from Southwell's own solver", logX: true, logY: true, label: "Convergence" }), legend(series));
  }
  block.append(make("div", { class: "filters" }, chooser("mode", keys.map((key) => [key, named(split(key))]), draw, "convergence")), place,
    make("p", { class: "muted" }, "Each refinement against Southwell's own solver with the same effects, converged."));
  draw(keys[0]);
  return block;
}

function viewer() {
  const block = make("section", {}, make("h2", {}, "Mode shapes")), shapes = DATA.shapes;
  if (!shapes || !shapes.speeds.length) {
    block.append(make("p", { class: "muted" }, "Not drawn: the case is not one of the package's own blades as this run had it, or its files are not here."));
    return block;
  }
  const canvas = make("canvas", { width: 900, height: 520, role: "img", "aria-label": "A blade moving in one of its modes while the rotor turns" });
  const picture = rotor(canvas, shapes), still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  let speed = shapes.speeds.length - 1, mode = 0, playing = !still;
  const along = make("div", {});
  const show = () => {
    picture.show(shapes.speeds[speed].modes[mode], shapes.speeds[speed].speed !== 0);
    along.replaceChildren(...spanwise(shapes.rest, shapes.speeds[speed].modes[mode]));
  };
  const list = () => shapes.speeds[speed].modes.map((m, k) => make("option", { value: k }, `${m.name}: ${digits(m.f, 5)} ${DATA.frequency}`));
  const button = make("button", { "aria-pressed": String(playing), onclick: () => {
    playing = !playing;
    button.setAttribute("aria-pressed", String(playing));
    picture.play(playing);
  } }, "move");
  const modes = chooser("mode", [], (v) => { mode = Number(v); show(); }, "shape"), select = modes.querySelector("select");
  const speeds = chooser("at", shapes.speeds.map((s, k) => [k, inWords(s.speed)]), (v) => {
    speed = Number(v);
    mode = Math.min(mode, shapes.speeds[speed].modes.length - 1);
    select.replaceChildren(...list());
    select.value = mode;
    show();
  }, "shape-speed", speed);
  select.replaceChildren(...list());
  show();
  picture.play(playing);
  block.append(make("div", { class: "filters" }, button, modes, speeds), canvas,
    make("p", { class: "muted" }, `Southwell's shapes about the steady state, of ${shapes.elements} elements: their frequencies are not yet the converged ones above. Amplitude, chord and both rates are not to scale; thick: the leading edge. Upwards: the rotor's axis.`),
    along, make("p", { class: "muted" }, "Displacements in the hub's axes over the largest of them, each at the moment when it is largest."));
  return block;
}

// The chosen mode's displacements along the blade: each turned to its own phase, those under a hundredth left out.
function spanwise(rest, mode) {
  const radius = rest.map((p) => Math.hypot(...p)), size = (k) => mode.re.map((re, i) => Math.hypot(re[k], mode.im[i][k]));
  const all = [2, 1, 0].map((k) => ({ k, name: ["axial", "edgewise", "flapwise"][k], sizes: size(k) })), far = Math.max(...all.flatMap((c) => c.sizes));
  const series = all.map(({ k, name, sizes }, place) => {
    const most = Math.max(...sizes), i = sizes.indexOf(most), c = mode.re[i][k] / most, s = mode.im[i][k] / most;
    return { name, most, colour: colour(place), dash: dash(place * COLOURS.length), points: radius.map((r, j) => [r, (mode.re[j][k] * c + mode.im[j][k] * s) / far]) };
  }).filter((s) => s.most > 0.01 * far);
  return [chart(series, { x: "radius over the tip's", y: "displacement", height: 190, label: "Displacements along the blade" }), legend(series)];
}

function everything() {
  if (DATA.properties.length) MAIN.append(make("details", { open: DATA.properties.some((p) => DATA.verdicts[p.verdict].name === "fail") }, make("summary", {}, `Properties of the blade: ${DATA.properties.length} checks`),
    table(["check", "property", "value", "reference", "unit", "difference", "verdict", "why"], DATA.properties.map((p) => row(p.check, p.property, digits(p.value, 7), digits(p.reference, 7), p.unit, p.difference, judged(p.verdict),
      make("td", { class: "reason" }, p.reason))), { id: "properties" })));
  const lines = DATA.cells.map((c) => row(inWords(c.speed), c.name, c.code, judged(c.verdict), c.text, digits(c.f, 8), c.elements, digits(c.order, 3), make("td", { class: "reason" }, c.reason)));
  MAIN.append(make("details", {}, make("summary", {}, `Every number: ${lines.length} cells`),
    table(["speed", "mode", "code", "verdict", "difference ± uncertainty", `value; frequencies in ${DATA.frequency}`, "elements", "order", "why"], lines, { id: "everything" })));
}

casePage();

"use strict";
// One function a page; each draws from the data in the page, never from markup in them: text goes in as text.

const DATA = JSON.parse(document.getElementById("data").textContent);
const MAIN = document.getElementById("main");
const plainNumber = (value, digits = 7) => (value === null || value === undefined ? "" : Number(value).toPrecision(digits));
const unique = (values) => [...new Set(values)];
const verdict = (k, list = DATA.verdicts) => make("span", { class: `chip v${k}` }, `${list[k].sign} ${list[k].name}`);

function chooser(label, options, onchange, name) {
  const select = make("select", { name, onchange: () => onchange(select.value) });
  for (const [value, text] of options) select.append(make("option", { value }, text));
  return make("label", {}, label, select);
}

function rows(head, body, attributes = {}) {
  const table = make("table", attributes, make("thead", {}, make("tr", {}, ...head.map((h) => make("th", { scope: "col" }, h)))));
  table.append(make("tbody", {}, ...body));
  return make("div", { class: "wide", tabindex: "0" }, table);
}

const cells = (...values) => make("tr", {}, ...values.map((v) => (v instanceof Node && v.nodeName === "TD" ? v : make("td", {}, v ?? ""))));

// ---- the matrix

function matrix() {
  const chosen = { code: "", family: "", speed: "", verdict: "" };
  const [CASE, COLUMN, SPEED, NAME, VERDICT, SIZE, TEXT, REASON] = [0, 1, 2, 3, 4, 5, 6, 7];
  const family = (cell) => cell[NAME].replace(/ \d+$/, "");
  const where = (cell) => (cell[SPEED] ? `${cell[SPEED]} ${DATA.cases[cell[CASE]].unit}` : "at rest");
  MAIN.append(make("h1", {}, "Are these natural frequencies right?"), make("p", { id: "headline" }, DATA.headline));
  MAIN.append(make("p", { class: "muted" }, "In each field: the gravest verdict of all modes and speeds shown, and the largest difference from core behind it. ",
    "Arrow keys move between fields, Enter opens the case."));
  const filters = make("div", { class: "filters", role: "group", "aria-label": "Filters" });
  const change = (key) => (value) => { chosen[key] = value; draw(); };
  const any = (text) => ["", text];
  filters.append(
    chooser("code", [any("all"), ...DATA.columns.map((c) => [c.name, c.name])], change("code"), "code"),
    chooser("family", [any("all"), ...unique(DATA.cells.map(family)).filter(Boolean).sort().map((f) => [f, f])], change("family"), "family"),
    chooser("speed", [any("all"), ["rest", "at rest"], ["turning", "turning"]], change("speed"), "speed"),
    chooser("verdict", [any("all"), ...DATA.verdicts.map((v, k) => [String(k), `${v.sign} ${v.name}`])], change("verdict"), "verdict"),
  );
  const place = make("div", {}), detail = make("div", { id: "detail", "aria-live": "polite" }, "A field's details stand here.");
  MAIN.append(filters, place, detail);

  const kept = (cell) =>
    (!chosen.code || DATA.columns[cell[COLUMN]].name === chosen.code) && (!chosen.family || family(cell) === chosen.family)
    && (!chosen.speed || (chosen.speed === "rest") === (cell[SPEED] === 0)) && (!chosen.verdict || cell[VERDICT] === Number(chosen.verdict));

  function show(caseName, column, worst, count) {
    detail.replaceChildren(make("strong", {}, `${caseName} × ${column}`), "  ", verdict(worst[VERDICT]),
      make("span", {}, worst[TEXT] ? `${worst[TEXT]} (${worst[NAME]}, ${where(worst)}; ${count} cells)` : `${count} cells`),
      worst[REASON] ? make("p", { class: "muted" }, worst[REASON]) : null);
  }

  function field(k, j, group) {
    if (!group.length) return make("td", {});
    const grave = Math.min(...group.map((c) => c[VERDICT]));
    const worst = group.filter((c) => c[VERDICT] === grave).reduce((a, b) => (Math.abs(b[SIZE] || 0) > Math.abs(a[SIZE] || 0) ? b : a));
    const name = DATA.cases[k].name, column = DATA.columns[j].name;
    const size = worst[TEXT].split(" ± ")[0], v = DATA.verdicts[grave];
    const tell = () => show(name, column, worst, group.length);
    return make("td", { class: `v${grave}`, tabindex: "-1", "data-row": k, "aria-label": `${name}, ${column}: ${v.name} ${worst[TEXT]}`,
      onfocus: tell, onmouseenter: tell, onclick: (e) => e.currentTarget.focus(),
      onkeydown: (e) => move(e, DATA.cases[k].page) }, v.sign, make("br"), size);
  }

  function move(event, page) {
    const row = event.currentTarget.parentElement, at = [...row.children].indexOf(event.currentTarget);
    const step = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowDown: [1, 0], ArrowUp: [-1, 0] }[event.key];
    if (event.key === "Enter") location.href = page;
    if (!step) return;
    event.preventDefault();
    const all = [...row.parentElement.children];
    let r = all.indexOf(row), c = at;
    do {
      r += step[0]; c += step[1];
      const next = all[r]?.children[c];
      if (!next) return;
      if (next.hasAttribute("tabindex")) { event.currentTarget.tabIndex = -1; next.tabIndex = 0; next.focus(); return; }
    } while (true);
  }

  function draw() {
    const shown = DATA.cells.filter(kept);
    const used = DATA.columns.map((_, j) => j).filter((j) => shown.some((c) => c[COLUMN] === j));
    const body = DATA.cases.map((item, k) => [item, k, shown.filter((c) => c[CASE] === k)]).filter(([, , mine]) => mine.length);
    const head = make("tr", {}, make("th", { scope: "col" }, "case"), ...used.map((j) => make("th", { scope: "col" }, DATA.columns[j].name)));
    const table = make("table", { class: "matrix" }, make("thead", {}, head), make("tbody", {},
      ...body.map(([item, k, mine]) => make("tr", {}, make("th", { scope: "row", title: item.title }, make("a", { href: item.page }, item.name)),
        ...used.map((j) => field(k, j, mine.filter((c) => c[COLUMN] === j))))),
      make("tr", { class: "shares" }, make("th", { scope: "row" }, "shares with core"), ...used.map((j) => make("td", {}, DATA.columns[j].shares)))));
    const first = table.querySelector("td[tabindex]");
    if (first) first.tabIndex = 0;
    place.replaceChildren(body.length ? make("div", { class: "wide" }, table) : make("p", {}, "No cell is of this kind."));
  }
  draw();
  MAIN.append(make("p", {}, ...DATA.verdicts.map((_, k) => verdict(k))));
  if (DATA.controls.length) controls();
  MAIN.append(make("h2", {}, "How to get this"), make("p", {}, make("code", {}, DATA.command)),
    make("p", { class: "muted" }, Object.entries(DATA.versions).map(([k, v]) => `${k} ${v}`).join(", ")));
}

function controls() {
  const percent = (v) => (v === null || v === undefined ? "no such mode" : `${v > 0 ? "+" : "−"}${Math.abs(100 * v).toPrecision(3)} %`);
  const largest = (o) => Object.entries(o.cases).map(([name, c]) => [name, c, c.right && c.wrong ? c.wrong / c.right - 1 : null])
    .sort((a, b) => Math.abs(b[2] || 0) - Math.abs(a[2] || 0))[0];
  MAIN.append(make("h2", {}, "Core made wrong on purpose"), make("p", { class: "muted" }, "Every run tries; the matrix must notice."),
    rows(["mistake", "outcome", "largest change", "where", "caught by", "in cases"], DATA.controls.map((o) => {
      const found = largest(o);
      return cells(o.name, o.status, found ? percent(found[2]) : "", found ? `${found[0]}, ${found[1].mode}` : "",
        unique(Object.values(o.cases).flatMap((c) => c.caught)).length, Object.values(o.cases).filter((c) => c.caught.length).length);
    }), { id: "controls" }));
}

// ---- a case

function casePage() {
  const s = DATA.setting;
  MAIN.append(make("h1", {}, DATA.name), s ? make("p", {}, s.title) : null, s ? make("p", { class: "muted" }, s.description) : null);
  if (s) MAIN.append(make("p", { class: "muted" }, Object.entries(s.facts).map(([k, v]) => `${k}: ${v}`).join(" · ")), make("p", { class: "muted" }, `Source: ${s.source}`));
  const pair = make("div", { class: "pair" });
  MAIN.append(pair);
  pair.append(campbell(), convergence());
  pair.append(viewer(), timing());
  differences();
}

const solved = () => DATA.cells.filter((c) => c.f !== null && c.mode);

function campbell() {
  const block = make("section", {}, make("h2", {}, "Campbell diagram"));
  const names = unique(solved().map((c) => c.name)), marksOf = unique(solved().map((c) => c.code));
  const on = new Set([1, 2, 3]);
  let code = "";
  const place = make("div", {}), buttons = make("div", { class: "filters", role: "group", "aria-label": "n per revolution" });
  for (const n of [1, 2, 3, 4, 5, 6, 9, 12]) {
    const button = make("button", { "aria-pressed": String(on.has(n)), onclick: () => {
      on.has(n) ? on.delete(n) : on.add(n);
      button.setAttribute("aria-pressed", String(on.has(n)));
      draw();
    } }, `${n}P`);
    buttons.append(button);
  }
  buttons.append(chooser("marks", [["", "all codes"], ...marksOf.map((c) => [c, c])], (v) => { code = v; draw(); }, "marks"));
  function draw() {
    const core = names.map((name, k) => ({ name, colour: COLOURS[k % COLOURS.length],
      points: [...new Map(solved().filter((c) => c.name === name && c.full !== null).map((c) => [c.speed, c.full]))].sort((a, b) => a[0] - b[0]) }));
    const top = Math.max(...core.flatMap((c) => c.points.map((p) => p[1])));
    const last = Math.max(...solved().map((c) => c.speed));
    const rays = last ? [...on].map((n) => {
      const end = Math.min(last, top / (n * DATA.perSpeed));
      return { name: `${n}P`, colour: "#9aa4ae", width: 1, quiet: true, points: [[0, 0], [end, n * DATA.perSpeed * end]] };
    }) : [];
    const dots = names.map((name, k) => ({ name, colour: COLOURS[k % COLOURS.length], marks: true, line: false, quiet: true,
      points: solved().filter((c) => c.name === name && (!code || c.code === code)).map((c) => [c.speed, c.f]) }));
    place.replaceChildren(chart([...rays, ...core, ...dots], { x: `rotor speed, ${DATA.speed}`, y: `frequency, ${DATA.frequency}`, yMin: 0, label: "Campbell diagram" }), legend(core));
  }
  draw();
  block.append(buttons, place, make("p", { class: "muted" }, "Lines: core, all effects. Points: every code's answer."));
  return block;
}

function convergence() {
  const block = make("section", {}, make("h2", {}, "Convergence")), place = make("div", {});
  const keys = unique(DATA.levels.map((v) => `${v[1]}|${v[2]}`));
  if (!keys.length) return make("section", {}, make("h2", {}, "Convergence"), make("p", { class: "muted" }, "No refinements in this run."));
  const named = (speed, mode) => DATA.cells.find((c) => c.speed === speed && c.mode === mode)?.name || `mode ${mode}`;
  function draw(key) {
    const [speed, mode] = key.split("|").map(Number);
    const codes = unique(DATA.levels.filter((v) => v[1] === speed && v[2] === mode).map((v) => v[0]));
    const series = codes.map((code, k) => {
      const best = DATA.cells.find((c) => c.code === code && c.speed === speed && c.mode === mode)?.ref;
      const points = DATA.levels.filter((v) => v[0] === code && v[1] === speed && v[2] === mode && best)
        .map((v) => [v[3], Math.max(Math.abs(v[4] / best - 1), 1e-13)]).sort((a, b) => a[0] - b[0]);
      return { name: code, colour: COLOURS[k % COLOURS.length], points, marks: true };
    }).filter((s) => s.points.length);
    place.replaceChildren(chart(series, { x: "elements, or terms", y: "difference from core, relative", logX: true, logY: true, label: "Convergence" }), legend(series));
  }
  block.append(make("div", { class: "filters" }, chooser("mode", keys.map((key) => {
    const [speed, mode] = key.split("|").map(Number);
    return [key, `${named(speed, mode)}, ${speed ? `${Number(speed.toPrecision(6))} ${DATA.speed}` : "at rest"}`];
  }), draw, "convergence")), place);
  draw(keys[0]);
  return block;
}

function viewer() {
  const block = make("section", {}, make("h2", {}, "Mode shapes"));
  if (!DATA.shapes) { block.append(make("p", { class: "muted" }, "Core's shapes are drawn for the package's own blades, where their files are.")); return block; }
  const canvas = make("canvas", { width: 900, height: 560, role: "img", "aria-label": "A blade moving in one of its modes while the rotor turns" });
  const turning = rotor(canvas, DATA.shapes);
  const button = make("button", { "aria-pressed": String(turning.playing()), onclick: () => button.setAttribute("aria-pressed", String(turning.toggle())) }, "play");
  block.append(make("div", { class: "filters" }, button, chooser("mode", DATA.shapes.modes.map((m, k) => [k, `${k + 1}: ${plainNumber(m.f, 5)} ${DATA.frequency}`]), (v) => turning.mode(Number(v)), "shape")),
    canvas, make("p", { class: "muted" }, `Core at ${plainNumber(DATA.shapes.speed, 4)} ${DATA.speed}; amplitude and rotor speed are not to scale.`));
  return block;
}

function timing() {
  const spent = new Map();
  for (const c of DATA.cells) if (c.seconds) spent.set(`${c.code}|${c.speed}`, c.seconds);
  const codes = unique([...spent.keys()].map((k) => k.split("|")[0]));
  const body = codes.map((code) => {
    const all = [...spent].filter(([k]) => k.split("|")[0] === code).map(([, v]) => v).sort((a, b) => a - b);
    return [code, all[Math.floor(all.length / 2)], all.reduce((a, b) => a + b, 0)];
  }).sort((a, b) => b[2] - a[2]);
  return make("section", {}, make("h2", {}, "Time"), make("p", { class: "muted" }, "Of the finest solution, while other codes ran beside it: a hint, not a measurement."),
    rows(["code", "median, s", "all speeds, s"], body.map(([code, m, t]) => cells(code, m.toPrecision(2), t.toPrecision(2))), { id: "timing" }));
}

function differences() {
  const speeds = unique(DATA.cells.map((c) => c.speed)).sort((a, b) => a - b), place = make("div", {});
  const draw = (speed) => place.replaceChildren(rows(["mode", "code", "verdict", "difference ± uncertainty", "frequency", "elements", "order", "why"],
    DATA.cells.filter((c) => c.speed === Number(speed)).sort((a, b) => a.mode - b.mode).map((c) => cells(c.name, c.code,
      make("td", { class: `v${c.verdict}` }, `${DATA.verdicts[c.verdict].sign} ${DATA.verdicts[c.verdict].name}`), c.text, plainNumber(c.f), c.elements, c.order === null ? "" : plainNumber(c.order, 3),
      make("td", { class: "reason" }, c.reason))), { id: "differences" }));
  MAIN.append(make("h2", {}, "Every mode and code"), make("div", { class: "filters" }, chooser("speed", speeds.map((v) => [v, v ? `${Number(v.toPrecision(6))} ${DATA.speed}` : "at rest"]), draw, "speed")), place);
  draw(speeds[0]);
}

// ---- codes

function codesPage() {
  MAIN.append(make("h1", {}, "Codes"));
  for (const code of DATA.codes) {
    MAIN.append(make("h2", { id: code.name }, code.name), make("p", { class: "muted" }, `version ${code.version || "unknown"}; shares with core: ${code.shares || "nothing said"}; `
      + Object.entries(code.counts).map(([v, n]) => `${n} ${v}`).join(", ")));
    MAIN.append(make("details", {}, make("summary", {}, "worst on every case"), rows(["case", "verdict", "difference ± uncertainty, or why"],
      code.worst.map(([name, page, v, text]) => cells(make("td", {}, make("a", { href: page }, name)), make("td", { class: `v${v}` }, `${DATA.verdicts[v].sign} ${DATA.verdicts[v].name}`), make("td", { class: "reason" }, text))))));
  }
}

// ---- the history

function historyPage() {
  const runs = DATA.runs, named = (k) => `${k + 1}: ${runs[k].commit.slice(0, 10)}, ${runs[k].date.slice(0, 10)}`;
  MAIN.append(make("h1", {}, "History"), make("p", {}, `${runs.length} runs`, DATA.torn.length ? `; lines cut short and left out: ${DATA.torn.join(", ")}` : ""));
  if (!runs.length) return;
  MAIN.append(rows(["run", "commit", "date", "machine", "cells", "not right", "mistakes caught"], runs.map((r, k) => cells(k + 1, r.commit.slice(0, 12), r.date, r.machine,
    Object.values(DATA.verdicts[k]).reduce((a, b) => a + b, 0), (DATA.verdicts[k].fail || 0) + (DATA.verdicts[k].inconclusive || 0), DATA.controls[k].length)), { id: "runs" }));
  between(named);
  MAIN.append(make("h2", {}, "Steps"), make("p", { class: "muted" }, "A frequency steps where it moved by more than 1e-9; a time where its level changed and stayed, beyond its scatter."));
  const steps = [...DATA.frequencies.map((s) => ["frequency", s]), ...DATA.timings.map((s) => ["time", s])]
    .flatMap(([kind, s]) => s.steps.map((k) => [kind, s, k])).sort((a, b) => b[2] - a[2]);
  MAIN.append(steps.length ? rows(["at run", "what", "case", "code", "mode, speed", "from", "to"], steps.map(([kind, s, k]) => {
    const before = s.values.slice(0, k).filter((v) => v !== null).at(-1);
    return cells(named(k), kind, s.case, s.code, kind === "time" ? "" : `${s.mode}, ${plainNumber(s.omega, 4)} rad/s`, plainNumber(before, kind === "time" ? 3 : 12), plainNumber(s.values[k], kind === "time" ? 3 : 12));
  }), { id: "steps" }) : make("p", { id: "steps" }, "None."));
  series(named);
}

function between(named) {
  const place = make("div", { id: "moved" }), options = DATA.runs.map((_, k) => [k, named(k)]);
  let from = Math.max(0, DATA.runs.length - 2), to = DATA.runs.length - 1;
  const a = chooser("from", options, (v) => { from = Number(v); draw(); }, "from"), b = chooser("to", options, (v) => { to = Number(v); draw(); }, "to");
  a.querySelector("select").value = from; b.querySelector("select").value = to;
  function draw() {
    const versions = unique([...Object.keys(DATA.runs[from].versions), ...Object.keys(DATA.runs[to].versions)])
      .filter((n) => DATA.runs[from].versions[n] !== DATA.runs[to].versions[n]).map((n) => `${n} ${DATA.runs[from].versions[n] || "absent"} → ${DATA.runs[to].versions[n] || "absent"}`);
    const moved = DATA.frequencies.map((s) => [s, s.values[from], s.values[to]]).filter(([, x, y]) => x !== y && !(x !== null && y !== null && Math.abs(y / x - 1) <= 1e-9))
      .sort((p, q) => Math.abs(q[2] / q[1] - 1 || 9) - Math.abs(p[2] / p[1] - 1 || 9));
    place.replaceChildren(make("p", { class: "muted" }, versions.length ? `Versions: ${versions.join(", ")}.` : "The same versions of everything."),
      moved.length ? rows(["case", "code", "mode, speed", "from, rad/s", "to, rad/s", "moved"], moved.slice(0, 500).map(([s, x, y]) => cells(s.case, s.code, `${s.mode}, ${plainNumber(s.omega, 4)} rad/s`,
        x === null ? "absent" : plainNumber(x, 12), y === null ? "absent" : plainNumber(y, 12), x !== null && y !== null ? (y / x - 1).toExponential(2) : ""))) : make("p", {}, "No frequency moved."));
  }
  MAIN.append(make("h2", {}, "Who moved what between two runs"), make("div", { class: "filters" }, a, b), place);
  draw();
}

function series(named) {
  const place = make("div", {});
  const all = [...DATA.frequencies.map((s) => [`${s.case} × ${s.code}, mode ${s.mode} at ${plainNumber(s.omega, 4)} rad/s: frequency`, s.values, "frequency, rad/s"]),
    ...DATA.frequencies.map((s) => [`${s.case} × ${s.code}, mode ${s.mode} at ${plainNumber(s.omega, 4)} rad/s: difference`, s.differences, "difference, relative"]),
    ...DATA.timings.map((s) => [`${s.case} × ${s.code}: time`, s.values, "seconds"])];
  if (!all.length) return;
  const draw = (k) => place.replaceChildren(chart([{ name: all[k][0], colour: COLOURS[0], marks: true, points: all[k][1].map((v, i) => [i + 1, v === null ? NaN : v]) }],
    { x: "run", y: all[k][2], height: 240, label: all[k][0] }));
  MAIN.append(make("h2", {}, "One number, run by run"), make("p", { class: "muted" }, "Every time, and every frequency that ever moved; the others never did."),
    make("div", { class: "filters" }, chooser("number", all.map(([text], k) => [k, text]), (v) => draw(Number(v)), "number")), make("div", { style: "max-width:560px" }, place));
  draw(0);
}

({ matrix, case: casePage, codes: codesPage, history: historyPage })[document.body.dataset.page]();

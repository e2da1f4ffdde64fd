"use strict";
// The history: the runs, changes between two of them, where numbers stepped, and every number run by run.

const RUNS = DATA.runs, MOVED = 1e-9, MOST = 400;
const [CASE, CODE, OMEGA, MODE, FAMILY, VALUES, DIFFERENCES, VERDICTS, WHAT, ABSOLUTE] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9];
const of = (values, k) => (Array.isArray(values) ? values[k] : values);
const date = (run) => run.date.slice(0, 16).replace("T", " ");
const named = (k) => `${k + 1}: ${RUNS[k].commit.slice(0, 10)}, ${date(RUNS[k]).slice(0, 10)}`;
const where = (mode, family, omega, what) => `${mode}${family ? ` (${family})` : ""}, ${what ? `${what}, ` : ""}${at(omega, "rad/s")}`;
const placed = (cell) => where(cell[MODE], cell[FAMILY], cell[OMEGA], cell[WHAT]);

function versions(from, to) {
  const a = RUNS[from].versions, b = RUNS[to].versions;
  return unique([...Object.keys(a), ...Object.keys(b)]).filter((n) => a[n] !== b[n]).map((n) => `${n} ${a[n] || "absent"} → ${b[n] || "absent"}`).join(", ");
}

function historyPage() {
  MAIN.append(make("h1", {}, "History"), make("p", {}, `${RUNS.length} runs`, DATA.truncated.length ? `; truncated and left out: line ${DATA.truncated.join(", line ")} of the file` : "", "."));
  if (!RUNS.length) return;
  MAIN.append(table(["run", "commit", "date, UTC", "cells", "faults detected", "properties wrong", "machine", "new versions"], RUNS.map((r, k) => row(k + 1, make("td", { title: r.commit }, r.commit.slice(0, 12)), date(r),
    make("td", {}, ...r.counts.map(([v, n]) => make("span", { class: `chip v${v}`, title: DATA.verdicts[v].name }, `${n} ${DATA.verdicts[v].sign}`))),
    r.controls ? `${r.detected} of ${r.controls}` : "", r.properties ? `${r.wrong} of ${r.properties}` : "", r.machine, make("td", { class: "reason" }, k ? versions(k - 1, k) : ""))).reverse(), { id: "runs" }),
    make("p", {}, ...DATA.verdicts.map((_, k) => chip(k))));
  between();
  steps();
  numbers();
}

// What moved in one cell: the code's own number, core's (from the difference), the verdict, whether it has an answer.
function change(cell, from, to) {
  const [x, y, dx, dy] = [of(cell[VALUES], from) ?? null, of(cell[VALUES], to) ?? null, of(cell[DIFFERENCES], from) ?? null, of(cell[DIFFERENCES], to) ?? null];
  const both = x !== null && y !== null, known = both && dx !== null && dy !== null, absolute = cell[ABSOLUTE];
  const code = !both ? null : absolute ? y - x : x ? y / x - 1 : null;
  const core = !known ? null : absolute ? y - dy - (x - dx) : x ? (y / (1 + dy)) / (x / (1 + dx)) - 1 : null;
  const before = of(cell[VERDICTS], from) ?? null, after = of(cell[VERDICTS], to) ?? null;
  return { cell, x, y, code, core, before, after, gone: x !== null && y === null, fresh: x === null && y !== null,
    moved: Math.abs(code) > MOVED, shifted: Math.abs(core) > MOVED, judged: before !== after && before !== null && after !== null };
}

function between() {
  const place = make("div", { id: "moved" }), options = RUNS.map((_, k) => [k, named(k)]);
  let from = Math.max(0, RUNS.length - 2), to = RUNS.length - 1;
  const verdictOf = (k) => (k === null ? "absent" : sign(k));
  function who(all) {
    const groups = new Map(), put = (name, key, c, size) => {
      if (!groups.has(name)) groups.set(name, { moved: new Map(), gone: 0, fresh: 0, judged: 0, far: null });
      const group = groups.get(name);
      if (key) group.moved.set(key, size); else for (const kind of ["gone", "fresh"]) group[kind] += c[kind];
      if (key && (!group.far || Math.abs(size) > Math.abs(group.far[0]))) group.far = [size, c.cell];
      return group;
    };
    for (const c of all) {
      const key = JSON.stringify([c.cell[CASE], c.cell[OMEGA], c.cell[MODE], c.cell[WHAT]]);
      if (c.moved) put(c.cell[CODE], key, c, c.code);
      if (c.shifted) put("Southwell", key, c, c.core);
      if (c.gone || c.fresh) put(c.cell[CODE], null, c);
      if (c.judged) put(c.cell[CODE], null, { gone: 0, fresh: 0 }).judged += 1;
    }
    return [...groups].map(([name, g]) => row(name, g.moved.size || "", g.far ? relative(g.far[0]) : "", g.far ? `${g.far[1][CASE]}, ${placed(g.far[1])}` : "", g.gone || "", g.fresh || "", g.judged || ""));
  }
  function draw() {
    const all = DATA.cells.map((cell) => change(cell, from, to)).filter((c) => c.moved || c.shifted || c.judged || c.gone || c.fresh);
    const size = (c) => (c.gone || c.fresh || c.judged ? Infinity : Math.max(Math.abs(c.code), Math.abs(c.core)));
    all.sort((p, q) => (size(p) === size(q) ? 0 : size(q) - size(p)));
    const other = versions(from, to);
    place.replaceChildren(make("p", { class: "muted" }, other ? `Versions: ${other}.` : "The same versions of everything."),
      all.length ? table(["who", "numbers moved", "largest move", "where", "answers gone", "answers new", "verdicts changed"], who(all), { id: "who" }) : make("p", {}, "No number moved, no verdict changed."),
      all.length ? make("details", {}, make("summary", {}, all.length > MOST ? `The first ${MOST} of ${all.length} cells` : `All ${all.length} cells`), table(["case", "code", "mode, speed", "from", "to", "code moved", "Southwell moved", "verdict"], all.slice(0, MOST).map((c) => row(c.cell[CASE], c.cell[CODE],
        placed(c.cell), digits(c.x, 12) || "absent", digits(c.y, 12) || "absent", c.moved ? relative(c.code) : "", c.shifted ? relative(c.core) : "",
        c.judged ? `${verdictOf(c.before)} → ${verdictOf(c.after)}` : "")), { id: "cells" })) : "");
  }
  MAIN.append(make("h2", {}, "Changes between two runs"), make("div", { class: "filters" }, chooser("from", options, (v) => { from = Number(v); draw(); }, "from", from),
    chooser("to", options, (v) => { to = Number(v); draw(); }, "to", to)), place);
  draw();
}

function steps() {
  const all = [...DATA.steps].sort((a, b) => b.run - a.run || b.count - a.count);
  MAIN.append(make("h2", {}, "Steps"), make("p", { class: "muted" }, "A number steps where it moves by more than 1e-9, a code's own or that of Southwell's own solver: a frequency by a fraction of itself, a damping ratio by itself."),
    all.length ? table(["at run", "who", "what", "largest change", "where", "versions that changed"], all.map((s) => row(named(s.run), s.who,
      s.numbers, s.change === null ? "from nothing" : relative(s.change), `${s.case}, mode ${where(s.mode, s.family, s.omega, s.what)}`,
      make("td", { class: "reason" }, s.run ? versions(s.run - 1, s.run) : ""))), { id: "steps" }) : make("p", { id: "steps" }, "None."));
}

// The number that stepped last: what a reader wants to see first.
function latest() {
  const [step] = [...DATA.steps].sort((a, b) => b.run - a.run || b.count - a.count);
  if (!step) return {};
  const cell = DATA.cells.find((c) => c[CASE] === step.case && c[MODE] === step.mode && c[OMEGA] === step.omega && c[WHAT] === step.what && (c[CODE] === step.who || step.who === "Southwell"));
  return { case: step.case, code: cell[CODE], number: `${step.who === "Southwell" ? "d" : "f"} mode ${placed(cell)}` };
}

function numbers() {
  const place = make("div", { class: "chart" }), chosen = latest();
  const names = unique(DATA.cells.filter((c) => c[VALUES] !== null).map((c) => c[CASE]));
  if (!names.length) return;
  const choosers = ["case", "code", "number"].map((name) => chooser(name, [], (v) => { chosen[name] = v; draw(); }, `series-${name}`));
  const fill = (k, options) => {
    const name = ["case", "code", "number"][k], select = choosers[k].querySelector("select"), known = options.map(([value]) => String(value));
    select.replaceChildren(...options.map(([value, text]) => make("option", { value }, text)));
    if (!known.includes(chosen[name])) chosen[name] = known[0];
    select.value = chosen[name];
  };
  function list() {
    const out = [];
    for (const c of DATA.cells) {
      if (c[CASE] !== chosen.case || c[CODE] !== chosen.code || c[VALUES] === null) continue;
      const text = `mode ${placed(c)}`, name = c[WHAT] || "frequency";
      out.push([`f ${text}`, `${name}: ${text}`, c[VALUES], c[ABSOLUTE] ? name : "frequency, rad/s", c[ABSOLUTE] ? 1 : null], [`d ${text}`, `difference: ${text}`, c[DIFFERENCES], c[ABSOLUTE] ? "difference from Southwell's own solver" : "difference from Southwell's own solver, relative", 1]);
    }
    return out.filter((n) => n[2] !== null);
  }
  function draw() {
    fill(0, names.map((n) => [n, n]));
    fill(1, unique(DATA.cells.filter((c) => c[CASE] === chosen.case && c[VALUES] !== null).map((c) => c[CODE])).map((n) => [n, n]));
    const all = list();
    fill(2, all);
    const [, text, values, unit, scale] = all.find((n) => String(n[0]) === chosen.number);
    const points = RUNS.map((_, k) => [k + 1, of(values, k) ?? NaN]);
    const moved = points.filter(([, v], k) => k && Number.isFinite(v) && Number.isFinite(points[k - 1][1]) && Math.abs(v - points[k - 1][1]) > MOVED * (scale ?? Math.abs(v))).map(([k]) => k);
    place.replaceChildren(chart([{ name: text, colour: COLOURS[0], marks: true, points }], { x: "run", y: unit, whole: true, height: 240, label: text, steps: moved }),
      make("p", { class: "muted" }, Array.isArray(values) ? "Dashed: steps." : "The same in every run, to rounding."));
  }
  MAIN.append(make("h2", {}, "Every number, run by run"), make("div", { class: "filters" }, ...choosers), place);
  draw();
}

historyPage();

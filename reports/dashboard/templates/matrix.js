"use strict";
// The first page: the verdict, the heat map with its filters, seeded faults.

const [CASE, COLUMN, SPEED, NAME, VERDICT, SIZE, TEXT, REASON, TARGET] = [0, 1, 2, 3, 4, 5, 6, 7, 8];
const FILTERS = ["code", "family", "speed", "verdict"];
const family = (cell) => cell[NAME].replace(/ \d+$/, "");
const unit = (cell) => DATA.cases[cell[CASE]].unit;
const speed = (cell) => at(cell[SPEED], unit(cell));

function matrix() {
  const chosen = Object.fromEntries(FILTERS.map((name) => [name, new URLSearchParams(location.hash.slice(1)).get(name) || ""]));
  const place = make("div", {}), detail = make("div", { id: "detail", "aria-live": "polite" });
  const select = (name, options) => chooser(name, [["", "all"], ...options], (value) => {
    chosen[name] = value;
    history.replaceState(null, "", `#${new URLSearchParams(Object.entries(chosen).filter(([, v]) => v))}`);
    draw();
  }, name, chosen[name]);
  const speeds = unique(DATA.cells.filter((c) => c[SPEED]).sort((a, b) => unit(a).localeCompare(unit(b)) || a[SPEED] - b[SPEED]).map(speed));
  const clear = make("button", { onclick: () => {
    for (const name of FILTERS) { chosen[name] = ""; filters.querySelector(`[name=${name}]`).value = ""; }
    history.replaceState(null, "", "#");
    draw();
  } }, "show all");
  const filters = make("div", { class: "filters", role: "group", "aria-label": "Filters" },
    select("code", DATA.columns.map((c) => [c.name, c.name])),
    select("family", unique(DATA.cells.map(family)).filter(Boolean).sort().map((f) => [f, f])),
    select("speed", [["at rest", "at rest"], ["turning", "turning"], ...speeds.map((s) => [s, s])]),
    select("verdict", DATA.verdicts.map((v, k) => [v.name, sign(k)])), clear);

  const kept = (cell) => (!chosen.code || DATA.columns[cell[COLUMN]].name === chosen.code)
    && (!chosen.family || family(cell) === chosen.family)
    && (!chosen.speed || (chosen.speed === "turning" ? cell[SPEED] !== 0 : speed(cell) === chosen.speed))
    && (!chosen.verdict || DATA.verdicts[cell[VERDICT]].name === chosen.verdict);

  function field(k, j, group) {
    if (!group.length) return null;
    const grave = Math.min(...group.map((c) => c[VERDICT]));
    const worst = group.filter((c) => c[VERDICT] === grave).reduce((a, b) => (Math.abs(b[SIZE] || 0) > Math.abs(a[SIZE] || 0) ? b : a));
    const item = DATA.cases[k], column = DATA.columns[j];
    return {
      verdict: grave, text: worst[TEXT].split(" ± ")[0], href: item.page,
      label: `${item.name}, ${column.name}: ${DATA.verdicts[grave].name} ${worst[TEXT]}`,
      tell: () => [make("strong", {}, link(item.page, item.name), " × ", link(column.page, column.name)), "  ", chip(grave),
        worst[TEXT] ? `${worst[TEXT]} (${worst[NAME]}, ${speed(worst)}; target ${worst[TARGET]}; ` : "(", `${group.length} ${group.length === 1 ? "cell" : "cells"})`,
        worst[REASON] ? make("p", { class: "muted" }, worst[REASON]) : null],
    };
  }

  function draw() {
    const shown = DATA.cells.filter(kept), groups = new Map();
    for (const cell of shown) {
      const key = `${cell[CASE]} ${cell[COLUMN]}`;
      if (!groups.has(key)) groups.set(key, []);
      groups.get(key).push(cell);
    }
    const cases = DATA.cases.map((_, k) => k).filter((k) => shown.some((c) => c[CASE] === k));
    const columns = DATA.columns.map((_, j) => j).filter((j) => shown.some((c) => c[COLUMN] === j));
    const shares = make("tr", { class: "shares" }, make("th", { scope: "row" }, "shares with Southwell"), ...columns.map((j) => make("td", {}, DATA.columns[j].shares.replace("discretisation", "discreti\u00adsation"))));
    place.replaceChildren(cases.length ? grid("case", cases.map((k) => make("a", { href: DATA.cases[k].page, title: DATA.cases[k].title }, ...broken(DATA.cases[k].name))),
      columns.map((j) => make(DATA.columns[j].page ? "a" : "span", { href: DATA.columns[j].page }, ...broken(DATA.columns[j].name))),
      cases.map((k) => columns.map((j) => field(k, j, groups.get(`${k} ${j}`) || []))), detail, shares) : make("p", {}, "No cell is of this kind."));
  }

  MAIN.append(make("h1", {}, "Are these natural frequencies right?"), make("div", { id: "headline", class: `v${DATA.answer}` }, ...DATA.headline.map((line) => make("p", {}, line))),
    make("p", { class: "muted" }, "In each field: the worst verdict of all modes and speeds shown, and the largest difference from Southwell's own solver behind it. ",
      "Point at a field, or go from one to the next with the arrow keys, for details; Enter opens the case."),
    filters, make("p", {}, ...DATA.verdicts.map((_, k) => chip(k))), place, detail);
  draw();
  MAIN.append(make("h2", {}, "The evidence, kind by kind"), table(Object.keys(DATA.evidence[0] || {}),
    DATA.evidence.map((kind) => row(...Object.values(kind).map((text) => make("td", { class: "prose" }, text)))), { id: "evidence" }));
  if (DATA.properties.length) properties();
  if (DATA.controls.length) controls();
  MAIN.append(make("h2", {}, "How to get this"), make("p", {}, make("code", {}, DATA.command)),
    make("p", { class: "muted" }, Object.entries(DATA.versions).map(([k, v]) => `${k} ${v}`).join(", ")));
}

function properties() {
  const page = (name) => DATA.cases.find((c) => c.name === name)?.page;
  MAIN.append(make("h2", {}, "Properties of the blades"), make("p", { class: "muted" }, "A second reading of each file, the model that each code assembles, and other descriptions of the same blade."),
    table(["case", "check", "verdict", "properties", "why"], DATA.properties.map((p) => row(make("td", {}, link(page(p.case), p.case)), p.check, judged(p.verdict),
      make("td", { class: "prose" }, [p.count, ...p.properties].join(", ")), make("td", { class: "reason" }, p.reason))), { id: "properties" }));
}

function controls() {
  MAIN.append(make("h2", {}, "Seeded faults"), make("p", { class: "muted" }, "Every run tries; the matrix must notice."),
    table(["fault", "outcome", "largest change of a frequency", "where", "cases", "detected by"], DATA.controls.map((o) => row(o.name,
      make("td", { class: o.status === "detected" ? "v3" : o.status === "missed" ? "v0" : "v1" }, `${o.status === "detected" ? "✔" : o.status === "missed" ? "✘" : "?"} ${o.status}`),
      o.change === null && o.where ? "no such mode" : relative(o.change), o.where, make("td", { title: o.cases.join(", ") }, o.cases.length),
      make("td", { class: "reason", title: o.detected_by.join("\n") }, named(o.detected_by)))), { id: "controls" }));
}

// the first of the cells that detected a fault; the number of the others
function named(cells) {
  const more = cells.length - 1;
  return more < 0 ? "none" : more ? `${cells[0]}; and ${more} more` : cells[0];
}

matrix();

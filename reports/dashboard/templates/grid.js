"use strict";
// A heat map: one field takes part in the tab order, arrow keys move from field to field, Enter opens what a field is about.

// fields[i][j]: null, or {verdict, text, label, tell: () => [children for the detail], href}
// The sign, the value and its uncertainty, each on a line of its own where there is no room beside each other.
function parts(field) {
  const mark = DATA.verdicts[field.verdict].sign, [value, uncertainty] = field.text.split(" ± ");
  if (uncertainty) return [figure(`${mark} ${value}`), " ", figure(`± ${uncertainty}`, "figure below")];
  return value ? [mark, " ", figure(value, "figure below")] : [mark];
}

function grid(corner, rows, columns, fields, detail, last = null) {
  const td = (field) => {
    if (!field) return make("td", {});
    const tell = () => detail.replaceChildren(...field.tell().filter((child) => child !== null));
    return make("td", { class: `v${field.verdict}`, tabindex: "-1", "aria-label": field.label, onfocus: tell, onmouseenter: tell,
      onclick: (event) => enter(event.currentTarget), onkeydown: (event) => key(event, field.href) },
    ...parts(field));
  };
  const head = make("tr", {}, make("th", { scope: "col" }, corner), ...columns.map((column) => make("th", { scope: "col" }, column)));
  const body = make("tbody", {}, ...rows.map((name, i) => make("tr", {}, make("th", { scope: "row" }, name), ...fields[i].map(td))), last);
  const first = body.querySelector("td[tabindex]");
  if (first) first.tabIndex = 0;

  function enter(field) {
    for (const other of body.querySelectorAll("td[tabindex='0']")) other.tabIndex = -1;
    field.tabIndex = 0;
    field.focus();
  }

  function key(event, href) {
    const step = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowDown: [1, 0], ArrowUp: [-1, 0] }[event.key];
    if (event.key === "Enter" && href) location.href = href;
    if (!step) return;
    event.preventDefault();
    const line = event.currentTarget.parentElement, lines = [...body.children];
    let r = lines.indexOf(line) + step[0], c = [...line.children].indexOf(event.currentTarget) + step[1];
    for (; lines[r]?.children[c]; r += step[0], c += step[1]) {
      if (lines[r].children[c].hasAttribute("tabindex")) { enter(lines[r].children[c]); return; }
    }
  }

  return sideways(make("div", { class: "wide" }, make("table", { class: "matrix" }, make("thead", {}, head), body)));
}

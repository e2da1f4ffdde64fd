"use strict";
// What every page has: its data, elements made by name (text goes in as text, never as markup), tables, choosers.

const DATA = JSON.parse(document.getElementById("data").textContent);
const MAIN = document.getElementById("main");
const SVG = "http://www.w3.org/2000/svg";
// Okabe and Ito's colours, distinguishable without red–green vision
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a6d00", "#7a7a7a"];

function make(name, attributes = {}, ...children) {
  const element = name.startsWith("svg:") ? document.createElementNS(SVG, name.slice(4)) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (key === "style") element.style.cssText = value; // the page's policy allows no attribute of style
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

const unique = (values) => [...new Set(values)];
const broken = (text) => text.split(/(?<=[/-])/).flatMap((part, k) => (k ? [make("wbr"), part] : [part]));  // may break there
const link = (href, text) => (href ? make("a", { href }, text) : text);
const digits = (value, count = 7) => (value === null || value === undefined ? "" : Number(value).toPrecision(count));
const brief = (value) => String(Number(Number(value).toPrecision(6)));
const at = (speed, unit) => (speed ? (unit === "γ" ? `γ = ${brief(speed)}` : `${brief(speed)} ${unit}`) : "at rest");
const sign = (k) => `${DATA.verdicts[k].sign} ${DATA.verdicts[k].name}`;
const figure = (text, name = "figure") => make("span", { class: name }, text);  // breaks nowhere
const chip = (k, before = "") => make("span", { class: `chip v${k}` }, before + sign(k));
const judged = (k) => make("td", { class: `v${k}` }, sign(k));

function relative(value) {
  if (value === null || value === undefined) return "";
  const size = Math.abs(value), text = size === 0 ? "0" : size < 1e-4 ? size.toExponential(2) : `${Number((100 * size).toPrecision(3))} %`;
  return size === 0 ? text : (value < 0 ? "−" : "+") + text;
}

function chooser(label, options, onchange, name, value) {
  const select = make("select", { name, onchange: () => onchange(select.value) });
  for (const [key, text] of options) select.append(make("option", { value: key }, text));
  if (value !== undefined) select.value = value;
  return make("label", {}, label, select);
}

// Fades the edge where there is more to scroll to.
function sideways(box) {
  const fade = () => box.classList.toggle("more", box.scrollLeft + box.clientWidth < box.scrollWidth - 2);
  box.addEventListener("scroll", fade, { passive: true });
  new ResizeObserver(fade).observe(box);
  return box;
}

function row(...values) {
  return make("tr", {}, ...values.map((v) => (v instanceof Node && v.nodeName === "TD" ? v : make("td", {}, v ?? ""))));
}

function table(head, rows, attributes = {}) {
  const top = make("thead", {}, make("tr", {}, ...head.map((h) => make("th", { scope: "col" }, h))));
  for (const line of rows) [...line.children].forEach((field, k) => {  // on a phone a row is a card, its fields labelled
    field.dataset.label = head[k];
    if (field.textContent || field.firstElementChild) field.replaceChildren(make("div", {}, ...field.childNodes));
  });
  return sideways(make("div", { class: "wide", tabindex: "0", role: "region", "aria-label": head.filter(Boolean).join(", ") },
    make("table", { class: "cards", ...attributes }, top, make("tbody", {}, ...rows))));
}

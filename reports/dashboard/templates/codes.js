"use strict";
// All codes in a table; one code: what it is, its worst difference on every blade.

const placed = (far) => make("td", { class: far ? `prose v${far[0]}` : null }, ...(far ? [figure(`${DATA.verdicts[far[0]].sign} ${far[1]}`), make("br"), ...broken(far[2])] : []));

function codes() {
  MAIN.append(make("h1", {}, "Codes"), make("p", { class: "muted" }, "Codes that share the mechanical model of Southwell's own solver or discretisation are one witness of the implementation, not several of the answer."),
    table(["code", "what", "version", "shares with Southwell", "answers", "worst, relative to target", "largest known difference"], DATA.codes.map((code) => row(link(code.page, code.name),
      make("td", { class: "prose" }, code.title), code.version, code.shares, make("td", { class: "prose" }, code.counts.map(([k, n]) => `${n} ${DATA.verdicts[k].sign}`).join(", ")), placed(code.worst), placed(code.known))), { id: "codes" }),
    make("p", {}, ...DATA.verdicts.map((_, k) => chip(k))));
}

function code() {
  MAIN.append(make("h1", {}, DATA.title), make("p", {}, make("code", {}, DATA.name), ` · version ${DATA.version || "unknown"} · shares with Southwell: ${DATA.shares || "not said in these results"}`,
    DATA.lacks === undefined ? "" : ` · leaves out: ${DATA.lacks || "nothing"}`));
  if (DATA.hint && DATA.version === "not installed") MAIN.append(make("p", { class: "muted" }, `To install: ${DATA.hint}`));
  MAIN.append(make("h2", {}, "Largest difference for each blade"),
    table(["case", "worst verdict", "cells", "difference ± uncertainty", "where", "why"], DATA.worst.map(([name, page, v, n, text, where, why]) =>
      row(link(page, name), judged(v), n, text, where, make("td", { class: "reason" }, why))), { id: "worst" }));
}

({ codes, code })[document.body.dataset.page]();

"use strict";
// A blade on its turning rotor, moving in one of its modes: a ribbon of nominal chord, so that torsion shows too.

const TURNS = 0.04, CYCLES = 0.6;  // per second, for the eye: neither is to scale

function rotor(canvas, shapes) {
  const pen = canvas.getContext("2d");
  let mode = null, playing = false, begun = 0, held = 0;
  const project = ([x, y, z], angle) => {
    const a = Math.cos(angle), b = Math.sin(angle), scale = 0.46 * canvas.width;
    return [canvas.width / 2 + scale * (a * x - b * y), canvas.height * 0.52 - scale * (0.42 * (b * x + a * y) + 0.9 * z)];
  };
  const path = (points, angle) => {
    pen.beginPath();
    points.forEach((point, k) => pen[k ? "lineTo" : "moveTo"](...project(point, angle)));
  };
  const line = (points, angle, stroke, width) => { path(points, angle); pen.strokeStyle = stroke; pen.lineWidth = width; pen.stroke(); };
  const shifted = (points, across, sense) => points.map((p, k) => p.map((v, i) => v + sense * across[k][i]));
  const circle = Array.from({ length: 97 }, (_, k) => [Math.cos(k * Math.PI / 48), Math.sin(k * Math.PI / 48), 0]);

  function draw(seconds, turning) {
    const angle = turning ? 2 * Math.PI * TURNS * seconds : 0, phase = 2 * Math.PI * CYCLES * seconds, c = Math.cos(phase), s = Math.sin(phase);
    const moved = mode.re.map((re, k) => re.map((v, i) => v * c - mode.im[k][i] * s));
    const places = shapes.rest.map((p, k) => p.map((v, i) => v + moved[k][i]));
    const across = shapes.across.map(([x, y, z], k) => [x, y - moved[k][3] * z, z + moved[k][3] * y]);
    pen.clearRect(0, 0, canvas.width, canvas.height);
    line(circle, 0, "#9aa4ae66", 1.5);
    line([[0, 0, -0.12], [0, 0, 0.12]], 0, "#9aa4ae", 1.5);
    line(shapes.rest, angle, "#9aa4ae", 2);
    line([[0, 0, 0], shapes.rest[0]], angle, getComputedStyle(document.body).color, 7);
    path([...shifted(places, across, 1), ...shifted(places, across, -1).reverse()], angle);
    pen.fillStyle = "#0072b255";
    pen.fill();
    line(shifted(places, across, 1), angle, "#0072b2", 4);
    line(shifted(places, across, -1), angle, "#56b4e9", 2);
  }

  let turns = false;
  function frame(now) {
    if (!playing) return;
    draw((now - begun) / 1000, turns);
    requestAnimationFrame(frame);
  }
  return {
    show(chosen, turning) { mode = chosen; turns = turning; draw(playing ? (performance.now() - begun) / 1000 : held, turns); },
    play(on) {
      if (on === playing) return;
      const now = performance.now();
      if (on) begun = now - 1000 * held; else held = (now - begun) / 1000;
      playing = on;
      requestAnimationFrame(frame);
    },
  };
}

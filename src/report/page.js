// Functions of the pictures of a page: read values, switch lines off, and move through the axles.
//
// The page is complete without this script, and the script loads nothing. The data of a chart are the JSON in its
// <metadata>, written by readings.rs, in the units of its axes.
"use strict";
(() => {
  const NEAR = 40; // px of the picture from a sample beyond which nothing is read
  const DOT = 4;
  const charts = [];

  const html = (tag, className) => Object.assign(document.createElement(tag), { className });
  const drawn = (tag, attributes, parent) => {
    const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    return parent.appendChild(node);
  };

  // ---- data and places ----

  // The place of a value on an axis, as a share of its length, and the value of a share.
  const scaleOf = ({ range: [low, high], log }) => log
    ? { share: v => Math.log(v / low) / Math.log(high / low), value: s => low * (high / low) ** s }
    : { share: v => (v - low) / (high - low), value: s => low + s * (high - low) };

  function chartOf(node) {
    const data = JSON.parse(node.querySelector("metadata").textContent);
    const chart = { node, data, across: scaleOf(data.x), upwards: scaleOf(data.y) };
    chart.groups = data.series.map((_, index) => node.querySelector(`.series[data-series="${index}"]`));
    data.series.forEach((series, index) => place(chart, index));
    return chart;
  }

  // Places of the values of a curve on the picture, px; a value that is not a number has no place.
  function place(chart, index) {
    const { frame: [left, top, width, height], x, y, grids, series } = chart.data;
    const curve = series[index];
    const values = grids[curve.x];
    const up = value => value === null ? undefined : chart.upwards.share(value);
    curve.px = values.map(value => left + chart.across.share(value) * width);
    curve.py = curve.y.map(value => top + (y.down ? up(value) : 1 - up(value)) * height);
    curve.ordered = curve.px.every((value, k) => k === 0 || value >= curve.px[k - 1]);
    chart.inside = (u, v) => u >= left - 6 && u <= left + width + 6 && v >= top - 6 && v <= top + height + 6;
  }

  // `1 234.5` with a true minus sign; a number that keeps its zeros has as many digits as its neighbours.
  function told(value, axis, zeros) {
    let text = axis.log ? Number(value.toPrecision(3)).toString() : value.toFixed(axis.digits);
    if (!zeros && text.includes(".")) text = text.replace(/\.?0+$/, "");
    const [head, tail] = text.replace("-", "").split(".");
    const grouped = head.length > 4 ? head.replace(/\B(?=(\d{3})+$)/g, "\u2009") : head;
    return (value < 0 && Number(text) !== 0 ? "\u2212" : "") + grouped + (tail ? "." + tail : "");
  }

  const withUnit = (text, axis) => axis.unit ? `${text} ${axis.unit}` : text;

  // ---- values under the pointer ----

  const box = html("div", "reading");
  box.setAttribute("role", "status");
  box.hidden = true;
  let shown = null; // the chart that is read

  const nameOf = (chart, curve, k) => curve.labels?.[k] || full(curve.name || chart.data.series[curve.entry].name) || chart.data.y.name;
  const full = name => /^[\d\u2009]+$/.test(name) ? `after ${name} axles` : name; // small legends show the count alone
  const visible = (chart, index) => !chart.groups[index].classList.contains("off");

  // The sample of a curve nearest to a place: across where places are in order, else in the plane.
  function nearest(curve, u, v) {
    let best = null;
    for (let k = 0; k < curve.px.length; k++) {
      if (!Number.isFinite(curve.py[k])) continue;
      const across = Math.abs(curve.px[k] - u);
      const away = Math.hypot(across, curve.py[k] - v);
      const order = curve.ordered ? across + 1e-3 * away : away;
      if (!best || order < best.order) best = { curve, k, order, away, across, x: curve.px[k], y: curve.py[k] };
    }
    return best;
  }

  // The place under the pointer on a line that is drawn between its samples.
  function between(curve, u) {
    for (let k = 1; k < curve.px.length; k++) {
      const [a, b] = [curve.px[k - 1], curve.px[k]];
      if (u < a || u > b || b <= a || !Number.isFinite(curve.py[k - 1]) || !Number.isFinite(curve.py[k])) continue;
      const share = (u - a) / (b - a);
      return { curve, x: u, y: curve.py[k - 1] + share * (curve.py[k] - curve.py[k - 1]), across: 0 };
    }
    return null;
  }

  function read(chart, u, v) {
    const curves = chart.data.series.filter((_, index) => visible(chart, index));
    const samples = curves.map(curve => nearest(curve, u, v)).filter(Boolean);
    if (!samples.length) return hide();
    const along = u => samples.map(sample => sample.curve.line && sample.curve.ordered && between(sample.curve, u) || sample);
    const far = found => Math.hypot(found.x - u, found.y - v);
    const closest = along(u).reduce((a, b) => far(b) < far(a) ? b : a);
    if (closest.across > NEAR || !closest.curve.ordered && far(closest) > NEAR) return hide();
    const at = closest.x;
    const beside = along(at).filter(found => found.curve.ordered && Math.abs(found.x - at) <= 6);
    const alike = closest.curve.ordered ? beside : [closest];
    // a curve that goes on in a lighter one has one value where they meet
    const once = [...new Map(alike.map(found => [`${nameOf(chart, found.curve, found.k)} ${found.y}`, found])).values()];
    show(chart, at, once, closest);
  }

  function show(chart, at, found, closest) {
    const { frame: [left, top, width, height], x, y, seats } = chart.data;
    hide();
    shown = chart;
    chart.overlay = drawn("g", { class: "overlay", "pointer-events": "none" }, chart.node);
    if (closest.curve.ordered) drawn("line", { class: "guide", x1: at, x2: at, y1: top, y2: top + height }, chart.overlay);
    const place = chart.across.value((at - left) / width);
    const lines = [[withUnit(`${x.name} ${told(place, x)}`, x) + seatAt(seats, place, width / (x.range[1] - x.range[0])), "", ""]];
    for (const { curve, k, x: u, y: v } of found) {
      const share = (v - top) / height;
      const value = chart.upwards.value(y.down ? share : 1 - share);
      drawn("circle", { class: curve.class.replace("line", "dot"), cx: u, cy: v, r: DOT }, chart.overlay);
      lines.push([nameOf(chart, curve, k), withUnit(told(value, y, true), y), curve.class, curve === closest.curve]);
    }
    box.replaceChildren(...lines.map(([name, value, kind, bold]) => {
      const line = html("div", bold ? "bold" : "");
      if (kind) drawn("circle", { cx: 5, cy: 5, r: DOT, class: kind.replace("line", "dot") },
        drawn("svg", { class: "tb swatch", width: 10, height: 10, "aria-hidden": true }, line));
      line.append(kind ? `${name}: ` : name, value);
      return line;
    }));
    box.hidden = false;
    beside(toScreen(chart, closest.x, closest.y));
  }

  // `, seat -3` where a numbered seat lies at that place.
  function seatAt(seats, place, scale) {
    if (!seats) return "";
    const index = seats[0].findIndex(x => Math.abs(x - place) * scale < 1);
    return index < 0 ? "" : `, seat ${seats[1][index] < 0 ? "\u2212" : "+"}${Math.abs(seats[1][index])}`;
  }

  // The box stands right of a place of the window, or left where there is no room, and never outside.
  function beside({ x, y }) {
    const { offsetWidth: width, offsetHeight: height } = box;
    const room = document.documentElement;
    const left = x + 16 + width < room.clientWidth ? x + 16 : x - 16 - width;
    const most = { x: room.clientWidth - width - 4, y: room.clientHeight - height - 4 };
    box.style.left = `${Math.max(4, Math.min(left, most.x))}px`;
    box.style.top = `${Math.max(4, Math.min(y - height / 2, most.y))}px`;
  }

  function hide() {
    if (shown) shown.overlay.remove();
    shown = null;
    box.hidden = true;
  }

  const matrix = chart => chart.node.ownerSVGElement.getScreenCTM();
  const toScreen = (chart, x, y) => new DOMPoint(x, y).matrixTransform(matrix(chart));
  const toPicture = (chart, event) => new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix(chart).inverse());

  function point(event) {
    const chart = charts.find(chart => chart.node.ownerSVGElement.contains(event.target) && under(chart, event));
    if (!chart) return hide();
    const { x, y } = toPicture(chart, event);
    read(chart, x, y);
  }

  function under(chart, event) {
    const { x, y } = toPicture(chart, event);
    return chart.inside(x, y);
  }

  // Arrows step through the samples of a curve and from curve to curve.
  function step(chart, event) {
    const curves = chart.data.series.filter((curve, index) => visible(chart, index) && curve.py.some(y => Number.isFinite(y)));
    if (!curves.length) return;
    let { curve, k } = chart.cursor && curves.includes(chart.cursor.curve) ? chart.cursor : { curve: curves[0], k: -1 };
    const known = k >= 0 ? curve.px[k] : null;
    const places = curve.py.map((y, index) => !Number.isFinite(y) ? -1 : index).filter(index => index >= 0);
    const now = places.indexOf(k);
    const other = by => curves[(curves.indexOf(curve) + by + curves.length) % curves.length];
    const moves = {
      ArrowRight: () => k = places[Math.min(now + 1, places.length - 1)],
      ArrowLeft: () => k = places[Math.max(now - 1, 0)],
      Home: () => k = places[0],
      End: () => k = places[places.length - 1],
      ArrowDown: () => { curve = other(1); k = nearest(curve, known ?? curve.px[0], 0).k; },
      ArrowUp: () => { curve = other(-1); k = nearest(curve, known ?? curve.px[0], 0).k; },
    };
    if (event.key === "Escape") return hide();
    if (!moves[event.key] || event.target !== chart.node) return;
    event.preventDefault();
    moves[event.key]();
    chart.cursor = { curve, k };
    const found = { curve, k, x: curve.px[k], y: curve.py[k] };
    show(chart, found.x, [found], found);
  }

  // ---- a switch for every line ----

  function switches(chart) {
    const entries = [...chart.node.querySelectorAll(".entry")];
    if (entries.length < 2) return;
    for (const entry of entries) {
      const name = chart.data.series[entry.dataset.series].name;
      const area = entry.getBBox();
      drawn("rect", { class: "hit", x: area.x - 3, y: area.y - 2, width: area.width + 6, height: area.height + 4 }, entry);
      Object.entries({ role: "button", tabindex: 0, "aria-pressed": true, "aria-label": `line ${full(name)}` })
        .forEach(([key, value]) => entry.setAttribute(key, value));
      const toggle = () => turn(chart.node.ownerSVGElement, name, entry.getAttribute("aria-pressed") !== "true");
      entry.addEventListener("click", toggle);
      entry.addEventListener("keydown", event => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        toggle();
      });
    }
  }

  // Charts of one picture have the same lines: a name is switched in all of them.
  function turn(picture, name, on) {
    hide();
    for (const chart of charts.filter(chart => chart.node.ownerSVGElement === picture)) {
      chart.data.series.forEach((curve, index) => {
        if (chart.data.series[curve.entry].name === name) chart.groups[index].classList.toggle("off", !on);
      });
      for (const entry of chart.node.querySelectorAll(".entry")) {
        if (chart.data.series[entry.dataset.series].name !== name) continue;
        entry.setAttribute("aria-pressed", on);
        entry.classList.toggle("off", !on);
      }
    }
  }

  // ---- the slider over the axles ----

  const sliders = []; // each moves one picture; those of other pictures go to the same count where they have it

  function slider(picture) {
    const moving = charts.filter(chart => chart.node.ownerSVGElement === picture && chart.data.steps);
    const layers = [...picture.querySelectorAll(".layer")];
    const named = picture.querySelector("metadata.layers");
    if (!moving.length && !named) return;
    const steps = named ? JSON.parse(named.textContent) : moving[0].data.steps;
    if (steps.length < 2) return;
    const label = html("label", "slider");
    const input = Object.assign(html("input", ""), { type: "range", min: 0, max: steps.length - 1, step: 1, value: steps.length - 1 });
    const output = html("output", "");
    const move = () => {
      const now = Number(input.value);
      output.textContent = steps[now];
      input.setAttribute("aria-valuetext", steps[now]);
      moving.forEach(chart => moveTo(chart, now));
      for (const layer of layers) layer.setAttribute("display", Number(layer.dataset.step) === now ? "inline" : "none");
    };
    const goTo = name => {
      if (!steps.includes(name) || output.textContent === name) return;
      input.value = steps.indexOf(name);
      move();
    };
    input.addEventListener("input", () => {
      move();
      sliders.forEach(other => other(output.textContent));
    });
    sliders.push(goTo);
    label.append("Axles", input, output);
    const scroll = picture.closest(".scroll");
    scroll.parentNode.insertBefore(label, scroll);
    move();
  }

  function moveTo(chart, now) {
    hide();
    chart.cursor = null;
    const title = chart.node.querySelector("text");
    title.textContent = `${withUnit(chart.data.y.name, { unit: chart.data.y.unit && `[${chart.data.y.unit}]` })}, ${chart.data.steps[now]}`;
    chart.data.series.forEach((curve, index) => {
      curve.y = curve.moving[now];
      place(chart, index);
      let pen = "M";
      const path = curve.px.map((x, k) => {
        if (!Number.isFinite(curve.py[k])) return pen = "M", "";
        const move = `${pen}${x.toFixed(1)} ${curve.py[k].toFixed(1)}`;
        return pen = "L", move;
      });
      chart.groups[index].replaceChildren();
      drawn("path", { class: curve.class, d: path.join("") }, chart.groups[index]);
    });
  }

  // ---- start ----

  for (const node of document.querySelectorAll(".chart")) charts.push(chartOf(node));
  for (const chart of charts) {
    const picture = chart.node.ownerSVGElement;
    picture.setAttribute("role", "group"); // what is inside can be reached now
    chart.node.setAttribute("role", "group");
    chart.node.setAttribute("tabindex", 0);
    chart.node.setAttribute("aria-label", `${chart.data.y.name} over ${chart.data.x.name}: arrow keys read values`);
    chart.node.querySelectorAll(".series title").forEach(title => title.remove()); // the box says it
    chart.node.addEventListener("keydown", event => step(chart, event));
    chart.node.addEventListener("blur", hide);
    switches(chart);
  }
  const pictures = new Set(charts.map(chart => chart.node.ownerSVGElement));
  for (const named of document.querySelectorAll("metadata.layers")) {
    const picture = named.ownerSVGElement;
    if (!pictures.has(picture)) slider(picture);
  }
  for (const picture of pictures) {
    picture.addEventListener("pointermove", point);
    picture.addEventListener("pointerdown", point);
    picture.addEventListener("pointerleave", event => event.pointerType === "mouse" && hide());
    slider(picture);
  }
  document.addEventListener("pointerdown", event => [...pictures].some(picture => picture.contains(event.target)) || hide());
  document.addEventListener("scroll", hide, { capture: true, passive: true });
  document.body.append(box);
})();

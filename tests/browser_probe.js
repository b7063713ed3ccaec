// Looks at a page from inside: what is cut, what is empty, and what its script does. The findings go as JSON to the window
// that frames the page, see tests/browser.rs.
"use strict";
addEventListener("load", () => {
  const found = { errors: window.probeErrors, width: innerWidth };
  try {
    look(found);
  } catch (error) {
    found.errors.push(`probe: ${error.stack}`);
  }
  parent.postMessage(JSON.stringify(found), "*");
});

function look(found) {
  const root = document.documentElement;
  found.overflow = Math.max(root.scrollWidth - root.clientWidth, document.body.scrollWidth - root.clientWidth);
  found.raw = rawBackticks();
  const pictures = [...document.querySelectorAll("section svg.tb")].filter(svg => !svg.closest(".reading"));
  found.pictures = pictures.length;
  found.empty = pictures.filter(isEmpty).map(nameOf);
  found.cut = pictures.flatMap(cutTexts);
  found.overlaid = pictures.flatMap(overlaid);
  found.small = Math.min(...pictures.flatMap(svg => [...svg.querySelectorAll("text")].map(sizeOf)));
  found.ticks = Math.min(...[...document.querySelectorAll(".chart")].map(fewestTicks));
  found.charts = document.querySelectorAll(".chart").length;
  found.unread = [...document.querySelectorAll(".chart")].filter(chart => !readsUnderPointer(chart)).map(chart => nameOf(chart.ownerSVGElement));
  found.reading = lastReading;
  found.keys = readsByKeys();
  found.unswitched = [...document.querySelectorAll(".entry[role=button]")].filter(entry => !switches(entry)).map(entry => entry.textContent);
  found.switches = document.querySelectorAll(".entry[role=button]").length;
  found.slider = slide();
}

const nameOf = svg => svg.closest("section").id;

// Text outside of files that shows a backtick.
function rawBackticks() {
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  const found = [];
  while (walker.nextNode()) {
    const node = walker.currentNode;
    const hidden = node.parentElement.closest("script, style, metadata, pre.source");
    if (!hidden && node.textContent.includes("`")) found.push(node.textContent.trim().slice(0, 80));
  }
  return found;
}

// A picture without shapes beside its paper, or a chart whose curves have no length.
function isEmpty(svg) {
  const shapes = [...svg.querySelectorAll("path, line, circle, rect:not(.paper), polygon, image")];
  const box = svg.getBoundingClientRect();
  if (shapes.length < 5 || box.width < 50 || box.height < 20) return true;
  const charts = [...svg.querySelectorAll(".chart")];
  return charts.some(chart => ![...chart.querySelectorAll(".series > *")].some(mark => mark.getBBox().width + mark.getBBox().height > 0));
}

// Texts that do not lie inside their picture, and pictures that do not lie inside what scrolls them.
function cutTexts(svg) {
  const box = svg.getBoundingClientRect();
  const scroll = svg.closest(".scroll");
  const frame = scroll.getBoundingClientRect();
  const found = [];
  if (box.left < frame.left - scroll.scrollLeft - 1 || box.right > frame.left - scroll.scrollLeft + scroll.scrollWidth + 1) found.push(`${nameOf(svg)}: the picture`);
  if (frame.left < -1 || frame.right > document.documentElement.clientWidth + 1) found.push(`${nameOf(svg)}: its box`);
  for (const text of svg.querySelectorAll("text")) {
    const at = text.getBoundingClientRect();
    if (at.left < box.left - 1 || at.right > box.right + 1 || at.top < box.top - 1 || at.bottom > box.bottom + 1) found.push(`${nameOf(svg)}: ${text.textContent}`);
  }
  return found;
}

// Pairs of texts of a picture that lie on each other.
function overlaid(svg) {
  const texts = [...svg.querySelectorAll("text")].map(text => ({ text: text.textContent, box: text.getBoundingClientRect() }));
  const found = [];
  texts.forEach(({ text, box: a }, index) => {
    for (const { text: other, box: b } of texts.slice(index + 1)) {
      const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (across > 3 && down > 0.35 * Math.min(a.height, b.height)) found.push(`${nameOf(svg)}: ${text} / ${other}`);
    }
  });
  return found;
}

// Height of the letters of a text on the screen, px.
function sizeOf(text) {
  const svg = text.ownerSVGElement;
  return parseFloat(getComputedStyle(text).fontSize) * svg.getBoundingClientRect().width / svg.viewBox.baseVal.width;
}

// Marks of the axis of a chart that has fewer of them: level lines, and strokes below the plane.
function fewestTicks(chart) {
  const [, top, , height] = dataOf(chart).frame;
  const at = (line, name) => Number(line.getAttribute(name));
  const level = [...chart.querySelectorAll("line.grid")].filter(line => at(line, "y1") === at(line, "y2"));
  const strokes = [...chart.querySelectorAll("line.axis")].filter(line =>
    at(line, "x1") === at(line, "x2") && Math.abs(at(line, "y1") - top - height) < 0.2 && at(line, "y2") > at(line, "y1"));
  return Math.min(level.length, strokes.length);
}

let lastReading = "";

const dataOf = chart => JSON.parse(chart.querySelector("metadata").textContent);

// Points at a sample of a chart and says whether a value with its unit appears.
function readsUnderPointer(chart) {
  const data = dataOf(chart);
  const [left, top, width, height] = data.frame;
  const box = document.querySelector(".reading");
  for (let share = 0.02; share < 1; share += 0.04) {
    for (const up of [0.5, 0.2, 0.8, 0.05, 0.35, 0.65, 0.95]) {
      const at = new DOMPoint(left + share * width, top + up * height).matrixTransform(chart.ownerSVGElement.getScreenCTM());
      const event = { clientX: at.x, clientY: at.y, bubbles: true, pointerType: "mouse" };
      chart.dispatchEvent(new PointerEvent("pointermove", event));
      if (!box.hidden && chart.querySelector(".overlay circle") && /\d/.test(box.textContent) && box.textContent.includes(data.y.unit)) {
        if (chart.closest("section").id === "settlement") lastReading = [...box.children].map(line => line.textContent).join("; ");
        const place = box.getBoundingClientRect();
        return place.left >= 0 && place.right <= innerWidth && place.top >= 0;
      }
    }
  }
  return false;
}

// Steps through the samples of the first chart by its keys: two readings that differ.
function readsByKeys() {
  const chart = document.querySelector(".chart");
  if (!chart) return null;
  const press = key => chart.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
  const box = document.querySelector(".reading");
  chart.focus();
  press("ArrowRight");
  const first = box.textContent;
  press("ArrowRight");
  const second = box.textContent;
  press("Escape");
  return first !== "" && first !== second && box.hidden;
}

// Switches the line of a legend entry off and on again.
function switches(entry) {
  const name = entry.getAttribute("data-series");
  const group = entry.closest(".chart").querySelector(`.series[data-series="${name}"]`);
  const seen = () => getComputedStyle(group).display !== "none";
  const before = seen();
  entry.dispatchEvent(new MouseEvent("click", { bubbles: true }));
  const off = !seen() && entry.getAttribute("aria-pressed") === "false";
  entry.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true, cancelable: true }));
  return before && off && seen();
}

// Moves the slider from its last step to its first: what it says, and which charts change.
function slide() {
  const input = document.querySelector(".slider input");
  if (!input) return null;
  const charts = [...input.closest("section").querySelectorAll(".chart")];
  const drawn = () => charts.map(chart => [...chart.querySelectorAll(".series path")].map(path => path.getAttribute("d")).join(" "));
  const said = () => input.closest(".slider").querySelector("output").textContent;
  const [last, saidLast] = [drawn(), said()];
  input.value = 0;
  input.dispatchEvent(new Event("input", { bubbles: true }));
  const [first, saidFirst] = [drawn(), said()];
  input.value = input.max;
  input.dispatchEvent(new Event("input", { bubbles: true }));
  const back = drawn();
  return { charts: charts.length, steps: Number(input.max) + 1, moved: first.filter((d, k) => d !== last[k] && d !== "").length,
    back: back.every((d, k) => d === last[k]), said: [saidFirst, saidLast] };
}

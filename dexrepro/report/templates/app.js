"use strict";
window.RECORDED = {};  // what the pages' scripts of recorded series fill
window.SERIES = {};
window.SCENES = {};
window.STUDIES = {};

function make(tag, values = {}, ...inside) {
  const node = Object.assign(document.createElement(tag), values);
  node.append(...inside);
  return node;
}

const loading = new Map();
function load(url) {
  if (!loading.has(url)) {
    loading.set(url, new Promise((done, failed) => {
      document.head.append(make("script", { src: url, onload: done, onerror: () => failed(new Error(`${url} is missing`)) }));
    }));
  }
  return loading.get(url);
}

// ---- search: the index is loaded when the box is first used

const box = document.getElementById("search");
const found = document.getElementById("found");
const MOST = 40;
const KINDS = ["chapter", "experiment", "figure", "table", "claim", "law", "symbol", "equation", "erratum", "parameter"];

// A verdict of two words is looked for as one.
const PHRASES = /\b(not|after|by) (reproduced|attributed|testable|evaluated|correction|construction)\b/g;
const joined = (text) => text.toLowerCase().replace(PHRASES, "$1_$2");

async function search() {
  await load("search-index.js");
  const wanted = joined(box.value).split(/\s+/).filter(Boolean);
  const matches = ([kind, text, , more]) => wanted.every((word) => joined(`${kind} ${text} ${more}`).includes(word));
  const hits = wanted.length ? SEARCH_INDEX.filter(matches).sort((a, b) => KINDS.indexOf(a[0]) - KINDS.indexOf(b[0])) : [];
  const items = hits.slice(0, MOST).map(([kind, text, to]) => make("li", {}, make("a", { href: to },
    make("span", { className: "kind", textContent: kind }), make("span", { textContent: text }))));
  const count = hits.length > MOST ? `the first ${MOST} of ${hits.length}; add a word` : `${hits.length || "nothing"} found`;
  found.replaceChildren(make("p", { className: "note", textContent: count }), make("ul", {}, ...items));
  found.hidden = !wanted.length;
}

if (box) {
  box.addEventListener("focus", () => load("search-index.js"), { once: true });
  box.addEventListener("input", search);
  box.form.addEventListener("keydown", (event) => {
    const links = [...found.querySelectorAll("a")];
    const at = links.indexOf(document.activeElement);
    if (event.key === "Escape") { box.value = ""; found.hidden = true; box.focus(); }
    if (event.key === "ArrowDown" && links.length) { links[Math.min(at + 1, links.length - 1)].focus(); event.preventDefault(); }
    if (event.key === "ArrowUp" && at >= 0) { (at ? links[at - 1] : box).focus(); event.preventDefault(); }
    if (event.key === "Enter" && event.target === box && links.length) { links[0].click(); }
  });
  document.addEventListener("click", (event) => { if (!box.form.contains(event.target)) found.hidden = true; });
  document.addEventListener("keydown", (event) => {
    if (event.key === "/" && !event.target.closest("input, select, textarea")) { box.focus(); event.preventDefault(); }
  });
}

// ---- figures enlarge

const dialog = document.getElementById("enlarged");
for (const link of document.querySelectorAll("a.enlarge")) {
  link.addEventListener("click", (event) => {
    event.preventDefault();
    const [picture, shown] = [dialog.querySelector("img"), link.querySelector("img")];
    Object.assign(picture, { src: link.href, alt: shown.alt, className: shown.className });
    dialog.showModal();
  });
}
dialog?.addEventListener("click", (event) => { if (event.target === dialog) dialog.close(); });

// ---- films run while they are in view, unless the reader asked for less motion or pressed Pause

const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
const inView = new IntersectionObserver((entries) => entries.forEach((entry) => entry.target.run(entry.isIntersecting)),
  { threshold: 0.6 });
for (const figure of document.querySelectorAll("figure.film")) {
  const [picture, link, button] = ["img", "a", "button"].map((name) => figure.querySelector(name));
  const still = picture.getAttribute("src");
  figure.run = (on) => {
    picture.src = on ? link.getAttribute("href") : still;
    button.textContent = on ? "Pause" : "Play";
  };
  const toggle = (event) => {
    event.preventDefault();
    inView.unobserve(figure);
    figure.run(button.textContent === "Play");
  };
  link.addEventListener("click", toggle);
  button.addEventListener("click", toggle);
  button.hidden = false;
  if (!calm) inView.observe(figure);
}

// ---- the contents list follows the scroll

const contents = document.querySelector(".contents");
if (contents) {
  if (matchMedia("(max-width: 72rem)").matches) contents.open = false;
  const entries = [...contents.querySelectorAll("a")].map((link) => [link.parentElement, document.getElementById(link.hash.slice(1))]);
  const follow = () => {
    const passed = entries.filter(([, section]) => section && section.getBoundingClientRect().top < innerHeight / 3);
    const [current] = passed[passed.length - 1] || [];
    for (const [item] of entries) item.classList.toggle("current", item === current);
  };
  addEventListener("scroll", follow, { passive: true });
  new ResizeObserver(follow).observe(document.body);
}

// ---- all claims: filter

const filter = document.getElementById("filter");
if (filter) {
  const rows = [...document.querySelectorAll(".answers tbody tr")];
  const apply = () => {
    const wanted = Object.fromEntries(new FormData(filter));
    const words = wanted.words.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const row of rows) {
      const fits = ["verdict", "chapter", "strength", "source"].every((key) => !wanted[key] || row.dataset[key] === wanted[key])
        && words.every((word) => row.textContent.toLowerCase().includes(word));
      row.hidden = !fits;
      shown += fits;
    }
    filter.querySelector("output").textContent = `${shown} of ${rows.length} claims`;
  };
  filter.addEventListener("input", apply);
  filter.addEventListener("submit", (event) => event.preventDefault());
  filter.hidden = false;
  apply();
}

// ---- recorded series: loaded when a reader opens them

for (const place of document.querySelectorAll(".explorer")) {
  place.addEventListener("toggle", async () => {
    if (!place.open || place.dataset.ready) return;
    place.dataset.ready = "yes";
    const drawing = "vendor/uplot/uPlot.iife.min.js";
    if (!loading.has(drawing)) document.head.append(make("link", { rel: "stylesheet", href: "vendor/uplot/uPlot.min.css" }));
    await load(drawing);
    await load("explorer.js");
    await load(`files/${place.dataset.experiment}/series.js`);
    const recorded = RECORDED[place.dataset.experiment];
    const shown = await explore(place.querySelector(".panels"), recorded);
    if (recorded.scene) {
      await load("vendor/three/three.iife.min.js");
      await load("scene.js");
      await load(recorded.scene.script);
      await showScene(shown, SCENES[recorded.name]);
    }
  });
}

// ---- what if: the draws of a study

for (const place of document.querySelectorAll(".whatif")) {
  place.closest("details").addEventListener("toggle", async () => {
    await load("whatif.js");
    await load(`files/${place.dataset.experiment}/study.js`);
    whatIf(place, STUDIES[place.dataset.experiment]);
  }, { once: true });
}

// ---- a link to something folded opens it

function reveal() {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  for (let node = target; node; node = node.parentElement) if (node.tagName === "DETAILS") node.open = true;
  const own = target?.matches(".claim") && target.querySelector("details");
  if (own) own.open = true;
  target?.scrollIntoView();
}
window.addEventListener("hashchange", reveal);
if (location.hash) reveal();

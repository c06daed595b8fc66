"use strict";
const box = document.getElementById("search");
const list = document.getElementById("found");

function show(words) {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  const hits = wanted.length
    ? SEARCH_INDEX.filter((entry) => wanted.every((word) => entry.text.toLowerCase().includes(word))).slice(0, 40)
    : [];
  list.replaceChildren(...hits.map((entry) => {
    const item = document.createElement("li");
    const link = document.createElement("a");
    link.href = entry.to;
    link.textContent = entry.text;
    item.append(link);
    return item;
  }));
  if (wanted.length && !hits.length) {
    const item = document.createElement("li");
    item.textContent = "nothing found";
    list.append(item);
  }
  list.hidden = !wanted.length;
  box.setAttribute("aria-expanded", String(!list.hidden));
}

box.addEventListener("input", () => show(box.value));
box.form.addEventListener("keydown", (event) => {
  const links = [...list.querySelectorAll("a")];
  const at = links.indexOf(document.activeElement);
  if (event.key === "Escape") { box.value = ""; show(""); box.focus(); }
  if (event.key === "ArrowDown" && links.length) { links[Math.min(at + 1, links.length - 1)].focus(); event.preventDefault(); }
  if (event.key === "ArrowUp" && at >= 0) { (at ? links[at - 1] : box).focus(); event.preventDefault(); }
  if (event.key === "Enter" && event.target === box && links.length) { links[0].click(); }
});
document.addEventListener("click", (event) => { if (!box.form.contains(event.target)) show(""); });

const dialog = document.getElementById("enlarged");
for (const link of document.querySelectorAll("a.enlarge")) {
  link.addEventListener("click", (event) => {
    event.preventDefault();
    const picture = dialog.querySelector("img");
    picture.src = link.href;
    picture.alt = link.querySelector("img").alt;
    dialog.showModal();
  });
}
dialog.addEventListener("click", (event) => { if (event.target === dialog) dialog.close(); });

// Films run while they are in view, unless the reader asked for less motion or pressed Pause.
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

function reveal() {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  for (let node = target; node; node = node.parentElement) if (node.tagName === "DETAILS") node.open = true;
  target?.scrollIntoView();
}
window.addEventListener("hashchange", reveal);
if (location.hash) reveal();

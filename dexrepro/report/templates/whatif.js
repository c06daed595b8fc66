"use strict";
// The draws of a study: a claim's margin against one of the parameters that the book does not print.

const FRAME = { width: 720, height: 300, left: 60, right: 12, top: 12, bottom: 44 };

function whatIf(place, study) {
  const varied = Object.keys(study.varied);
  const claims = study.claims.filter((c) => study.draws.some((d) => d.margins[c.id] != null));
  if (!claims.length) return;
  const pick = (word, values, texts) => {
    const select = make("select");
    values.forEach((value, i) => select.append(make("option", { value, textContent: texts[i] })));
    select.addEventListener("input", draw);
    return [select, make("label", {}, `${word} `, select)];
  };
  const [claim, claimLabel] = pick("Claim", claims.map((c) => c.id), claims.map((c) => `${c.id} ${c.statement}`));
  const [parameter, parameterLabel] = pick("Parameter", varied, varied);
  claim.addEventListener("input", suggest);
  const picture = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const told = make("div", { ariaLive: "polite" });
  place.append(make("h3", { textContent: "What if: every draw of the study" }), make("p", {}, claimLabel, parameterLabel), picture, told);
  picture.setAttribute("viewBox", `0 0 ${FRAME.width} ${FRAME.height}`);
  picture.setAttribute("role", "img");
  picture.tabIndex = 0;
  let marks = [];
  let chosen = -1;

  function suggest() {
    const follows = study.claims.find((c) => c.id === claim.value).parameter;
    parameter.value = varied.includes(follows) ? follows : varied[0];
    draw();
  }

  function node(name, values, text = "") {
    const made = document.createElementNS(picture.namespaceURI, name);
    for (const [key, value] of Object.entries(values)) made.setAttribute(key, value);
    made.textContent = text;
    picture.append(made);
    return made;
  }

  const short = (value) => String(Number(value.toPrecision(4))).replace("-", "\u2212");

  function draw() {
    const key = parameter.value;
    const words = typeof study.varied[key][0] === "string" ? study.varied[key] : null;
    const number = (sample) => words ? words.indexOf(sample.values[key]) : sample.values[key];
    const draws = study.draws.filter((d) => d.margins[claim.value] != null && key in d.values)
      .sort((a, b) => number(a) - number(b));
    const [low, high] = words ? [0, words.length - 1] : study.varied[key];
    const wide = low > 0 && high / low >= 10 && draws.every((d) => d.values[key] > 0);
    const scale = wide ? Math.log : (x) => x;
    const right = FRAME.width - FRAME.right;
    const bottom = FRAME.height - FRAME.bottom;
    const x = (value) => FRAME.left + ((scale(value) - scale(low)) / (scale(high) - scale(low))) * (right - FRAME.left);
    const y = (margin) => FRAME.top + ((1 - Math.min(Math.max(margin, -1), 1)) / 2) * (bottom - FRAME.top);
    picture.replaceChildren();
    for (const margin of [-1, 0, 1]) {
      node("line", { class: "rule", x1: FRAME.left, x2: right, y1: y(margin), y2: y(margin), ...(margin ? { "stroke-dasharray": "2 4" } : {}) });
      node("text", { x: FRAME.left - 8, y: y(margin) + 4, "text-anchor": "end" }, short(margin));
    }
    for (const value of words ? words.keys() : [low, high]) {
      const anchor = value === low ? "start" : value === high ? "end" : "middle";
      node("text", { x: x(value), y: bottom + 18, "text-anchor": anchor }, words ? words[value] : short(value));
    }
    node("text", { x: (FRAME.left + right) / 2, y: bottom + 34, "text-anchor": "middle" }, scale === Math.log ? `${key} (logarithmic)` : key);
    node("text", { x: 14, y: (FRAME.top + bottom) / 2, transform: `rotate(-90 14 ${(FRAME.top + bottom) / 2})`, "text-anchor": "middle" }, "margin");
    marks = draws.map((sample, i) => {
      const [cx, cy, holds] = [x(number(sample)), y(sample.margins[claim.value]), sample.margins[claim.value] > 0];
      const mark = holds ? node("circle", { class: "holds", cx, cy, r: 4.5 })
        : node("path", { class: "fails", d: `M${cx - 4} ${cy - 4}l8 8m0 -8l-8 8` });
      mark.addEventListener("mouseenter", () => choose(i));
      mark.addEventListener("click", () => choose(i));
      return { mark, sample };
    });
    const held = draws.filter((d) => d.margins[claim.value] > 0).length;
    picture.setAttribute("aria-label", `${claim.value} holds in ${held} of ${draws.length} draws; margin against ${key}. Arrow keys go from draw to draw.`);
    chosen = -1;
    told.replaceChildren(make("p", { className: "note", textContent: `Holds in ${held} of ${draws.length} draws (dots; crosses fail). Point at a draw, or press the arrow keys, for its values and its command.` }));
  }

  function choose(i) {
    marks[chosen]?.mark.classList.remove("chosen");
    chosen = Math.min(Math.max(i, 0), marks.length - 1);
    const { mark, sample } = marks[chosen];
    mark.classList.add("chosen");
    const margin = sample.margins[claim.value];
    const value = sample.values[parameter.value];
    const values = Object.entries(sample.values).map(([key, value]) => `${key}=${value}`);
    told.replaceChildren(
      make("p", { className: "note", textContent: `Draw ${sample.index}: margin ${short(margin)}, ${claim.value} ${margin > 0 ? "holds" : "fails"}; ${parameter.value} = ${typeof value === "string" ? value : short(value)}.` }),
      make("pre", { className: "command", textContent: `dexrepro run${study.option} chapter=${study.chapter} only=${study.experiment} ${values.join(" ")}` }));
  }

  picture.addEventListener("keydown", (event) => {
    const steps = { ArrowLeft: -1, ArrowRight: 1 };
    if (!(event.key in steps)) return;
    choose(chosen + steps[event.key]);
    event.preventDefault();
  });
  suggest();
}

"use strict";
// Recorded series of one experiment: choose cases and channels, hover for values, drag to zoom; all time axes move together.

const COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#8C8C8C", "#A6761D"];
const DASHES = [[], [9, 3, 2, 3], [6, 3], [2, 2], [12, 3], [3, 1, 1, 1], [5, 1], [1, 3]];
const PANEL_HEIGHT = 210;

async function unpacked(text, columns, samples) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  return Array.from({ length: columns }, (_, column) => {
    const bits = new Int32Array(samples);
    let value = 0;
    for (let i = 0, start = 4 * column * samples; i < samples; i++) {
      let change = 0;
      for (let plane = 3; plane >= 0; plane--) change = (change << 8) | planes[start + plane * samples + i];
      value = (value + change) | 0;
      bits[i] = value;
    }
    return Array.from(new Float32Array(bits.buffer), (number) => (Number.isFinite(number) ? number : null));
  });
}

async function explore(place, recorded) {
  const cases = Object.keys(recorded.cases);
  const look = new Map(cases.map((name, i) => [name, { stroke: COLOURS[i % COLOURS.length], dash: DASHES[(i + Math.floor(i / COLOURS.length)) % DASHES.length] }]));
  const data = new Map();
  const panels = new Map();
  const zoom = { min: null, max: null, busy: false };
  const text = (number) => (number == null ? "–" : Number(number.toPrecision(5)).toString().replace("-", "\u2212"));

  const fetched = async (name) => {
    if (!data.has(name)) {
      const entry = recorded.cases[name];
      await load(entry.script);
      const columns = await unpacked(SERIES[entry.key], entry.channels.length, entry.samples);
      data.set(name, Object.fromEntries(entry.channels.map((channel, i) => [channel, columns[i]])));
    }
    return data.get(name);
  };

  const boxes = (legend, names, chosen, decorate) => {
    const set = make("fieldset", { className: "choices" }, make("legend", { textContent: legend }));
    set.tabIndex = 0;
    for (const name of names) {
      const input = make("input", { type: "checkbox", value: name, checked: chosen.includes(name) });
      input.addEventListener("change", update);
      set.append(make("label", {}, input, " ", ...decorate(name)));
    }
    return set;
  };
  const swatch = (name) => { const line = make("span", { className: "swatch" }); line.style.background = look.get(name).stroke; return [line, ` ${name.replaceAll("_", " ")}`]; };
  const units = Object.fromEntries(recorded.channels.map(({ name, unit }) => [name, unit.split(", ")]));
  const caseBox = boxes("Cases", cases, recorded.first.cases, swatch);
  const channelBox = boxes("Channels", recorded.channels.map((c) => c.name), recorded.first.channels, (name) => [name]);
  const reset = make("button", { type: "button", textContent: "Whole time" });
  reset.addEventListener("click", () => zoomTo(null, null));
  const links = make("span", { className: "note" });
  const stage = make("div");
  const view = make("div", { className: "scene" });
  const listeners = [];  // told the time under the cursor
  let told = false;
  place.replaceChildren(caseBox, channelBox, make("p", { className: "note" }, reset,
    " Drag over a panel to zoom, or focus it: \u2190 \u2192 move the cursor, + \u2212 zoom. ", links), view, stage);
  const chosen = (set) => [...set.querySelectorAll("input:checked")].map((input) => input.value);

  function zoomTo(min, max) {
    Object.assign(zoom, { min, max, busy: true });
    for (const { plot } of panels.values()) {
      const x = plot.data[0];
      plot.setScale("x", { min: min ?? x[0], max: max ?? x[x.length - 1] });
    }
    zoom.busy = false;
  }

  // The components of a channel: [""] of a number, ["[0]", "[1]", ...] of a vector.
  function parts(channel) {
    const all = Object.values(recorded.cases).flatMap((entry) => entry.channels);
    return [...new Set(all.filter((name) => name === channel || name.startsWith(`${channel}[`)).map((name) => name.slice(channel.length)))];
  }

  function values(columns, channel, part, components) {
    if (part !== "length") return columns[channel + part];
    const all = components.map((name) => columns[channel + name]).filter(Boolean);
    return all.length ? all[0].map((_, i) => Math.hypot(...all.map((column) => column[i] ?? NaN))) : undefined;
  }

  // "m" of a channel or of one of its components; "" of a number without unit.
  function unit(channel, part) {
    const found = units[channel].length > 1 && part !== "length" ? units[channel][parts(channel).indexOf(part)] : units[channel][0];
    return found === "1" ? "" : found;
  }

  async function update() {
    const shown = chosen(caseBox);
    const wanted = chosen(channelBox);
    for (const name of shown) await fetched(name);
    links.replaceChildren(...shown.flatMap((name) => {
      const every = recorded.cases[name].stride > 1 ? ` (one sample in ${recorded.cases[name].stride} is drawn)` : "";
      return [make("a", { href: recorded.cases[name].csv, textContent: `${name}.csv.gz` }), `${every} `];
    }));
    for (const [channel, panel] of panels) if (!wanted.includes(channel)) { panel.plot.destroy(); panel.node.remove(); panels.delete(channel); }
    for (const channel of wanted) draw(channel, shown);
  }

  function draw(channel, shown) {
    const components = parts(channel);
    const old = panels.get(channel);
    const node = old?.node ?? make("div", { className: "panel" });
    const part = old?.part ?? (components.includes("") ? "" : components[0]);
    if (!old) {
      const title = make("h3", {}, make("span"));
      if (!components.includes("")) {
        const select = make("select", { ariaLabel: `Component of ${channel}` });
        for (const name of units[channel].length > 1 ? components : [...components, "length"]) select.append(make("option", { value: name, textContent: name === "length" ? "length of the vector" : name }));
        select.addEventListener("change", () => { panels.get(channel).part = select.value; draw(channel, chosen(caseBox)); });
        title.append(select);
      }
      node.append(title);
      stage.append(node);
    }
    old?.plot.destroy();
    const called = unit(channel, part);
    node.querySelector("h3 span").textContent = `${channel} [${called || "no unit"}]`;
    const tables = shown.map((name) => [data.get(name).time, values(data.get(name), channel, part, components)]);
    const kept = tables.map((table, i) => [shown[i], table]).filter(([, [, column]]) => column);
    const joined = kept.length ? uPlot.join(kept.map(([, table]) => table)) : [[0, 1]];
    const ink = getComputedStyle(document.body).color;
    const axis = { stroke: ink, grid: { stroke: "#8885", width: 0.5 }, ticks: { stroke: "#8888", width: 0.5 }, font: "12px system-ui" };
    const plot = new uPlot({
      width: Math.max(stage.clientWidth, 240), height: PANEL_HEIGHT,
      cursor: { sync: { key: recorded.name, scales: ["x", null] }, drag: { x: true, y: false }, points: { size: 6 } },
      scales: { x: { time: false, min: zoom.min ?? undefined, max: zoom.max ?? undefined } },
      axes: [{ ...axis, label: "Time [s]", labelSize: 18, labelFont: "12px system-ui" }, { ...axis, size: 62 }],
      series: [{ label: "t", value: (_, time) => (time == null ? "–" : `${text(time)} s`) }, ...kept.map(([name]) => ({
        label: name.replaceAll("_", " "), ...look.get(name), width: 1.6, spanGaps: true, points: { show: false },
        value: (_, number) => (number == null ? "–" : `${text(number)} ${called}`),
      }))],
      hooks: { setScale: [(self, key) => { if (key === "x" && !zoom.busy && self.status) zoomTo(self.scales.x.min, self.scales.x.max); }],
        setCursor: [(self) => { if (!told && self.cursor.left >= 0 && self.cursor.event) for (const listener of listeners) listener(self.posToVal(self.cursor.left, "x")); }] },
    }, joined, node);
    plot.root.tabIndex = 0;
    plot.root.setAttribute("role", "group");
    plot.root.setAttribute("aria-label", `${channel} over time; arrow keys move the cursor, plus and minus zoom`);
    plot.root.addEventListener("keydown", (event) => keys(event, plot));
    panels.set(channel, { plot, node, part });
    node.plot = plot;
    if (zoom.min !== null) zoomTo(zoom.min, zoom.max);
  }

  function keys(event, plot) {
    const x = plot.data[0];
    const { min, max } = plot.scales.x;
    const at = plot.cursor.idx ?? Math.floor(x.length / 2);
    const steps = { ArrowLeft: -1, ArrowRight: 1, PageUp: -Math.ceil(x.length / 20), PageDown: Math.ceil(x.length / 20) };
    if (event.key in steps) {
      const next = Math.min(Math.max(at + steps[event.key], 0), x.length - 1);
      plot.setCursor({ left: plot.valToPos(x[next], "x"), top: 10 });
    } else if (event.key === "+" || event.key === "-") {
      const [centre, half] = [x[at], ((max - min) / 2) * (event.key === "+" ? 0.5 : 2)];
      zoomTo(Math.max(centre - half, x[0]), Math.min(centre + half, x[x.length - 1]));
    } else return;
    event.preventDefault();
  }

  addEventListener("resize", () => { for (const { plot } of panels.values()) plot.setSize({ width: Math.max(stage.clientWidth, 240), height: PANEL_HEIGHT }); });
  await update();

  // The time cursor of all panels, moved from outside; and who wants to know where the reader moved it.
  return {
    place: view,
    onTime: (listener) => listeners.push(listener),
    setTime: (time) => {
      told = true;
      for (const { plot } of panels.values()) plot.setCursor({ left: plot.valToPos(time, "x"), top: 10 }, true, false);
      told = false;
    },
  };
}

"use strict";
// The recorded motion of a scene: one time for it and for the series, orbit with the mouse or the arrow keys.

async function showScene(shown, recorded) {
  const width = 1 + 7 * recorded.solids.length;
  const [times, ...values] = await unpacked(recorded.poses, width, recorded.samples);
  const [start, end] = [times[0], times[times.length - 1]];
  const canvas = make("canvas", { tabIndex: 0 });
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `The scene of the case ${recorded.case} in three dimensions; arrow keys turn it, plus and minus come nearer or go away`);
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
  } catch {
    shown.place.append(make("p", { className: "note", textContent: "This browser cannot draw in three dimensions; the film shows the scene." }));
    return;
  }
  const scene = new THREE.Scene();
  scene.add(new THREE.HemisphereLight(0xffffff, 0x99a3ad, 2.2));
  const sun = new THREE.DirectionalLight(0xffffff, 1.8);
  sun.position.set(1, -1, 2);
  scene.add(sun);
  const solids = recorded.solids.map((solid) => scene.add(mesh(solid)) && scene.children[scene.children.length - 1]);

  const { target, distance, yaw, pitch, field_of_view: angle } = recorded.camera;
  const eye = { yaw: (yaw * Math.PI) / 180, pitch: (pitch * Math.PI) / 180, distance };
  const camera = new THREE.PerspectiveCamera(angle, 1, 0.02, 40);
  camera.up.set(0, 0, 1);

  const button = make("button", { type: "button", textContent: "Play" });
  const slider = make("input", { type: "range", min: start, max: end, step: "any", value: start, ariaLabel: "Time" });
  const pace = make("select", { ariaLabel: "Pace" });
  for (const factor of [0.25, 0.5, 1, 2, 5, 10]) pace.append(make("option", { value: factor, textContent: `${factor}\u00d7`, selected: factor === 1 }));
  const label = make("output");
  shown.place.append(canvas, make("p", { className: "controls" }, button, slider, label, pace,
    make("span", { className: "note", textContent: `case ${recorded.case.replaceAll("_", " ")}; drag to turn` })));

  let time = start;
  let playing = null;

  function draw() {
    const { clientWidth: w, clientHeight: h } = canvas;
    if (!w) return;
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.setSize(w, h, false);
    camera.aspect = w / h;
    camera.updateProjectionMatrix();
    const far = eye.distance * Math.max(1, 1.4 / camera.aspect);  // a narrow window shows as much, smaller
    const flat = far * Math.cos(eye.pitch);
    camera.position.set(target[0] + flat * Math.sin(eye.yaw), target[1] - flat * Math.cos(eye.yaw), target[2] - far * Math.sin(eye.pitch));
    camera.lookAt(new THREE.Vector3(...target));
    renderer.render(scene, camera);
  }

  // Poses between two recorded instants: places and turns are blended, turns the short way round.
  function move(to) {
    time = Math.min(Math.max(to, start), end);
    let after = times.findIndex((instant) => instant >= time);
    if (after < 1) after = Math.min(1, times.length - 1);
    const before = Math.max(after - 1, 0);
    const share = times[after] > times[before] ? (time - times[before]) / (times[after] - times[before]) : 0;
    solids.forEach((solid, i) => {
      const at = (k) => values.slice(7 * i, 7 * i + 7).map((column) => column[k]);
      const [first, second] = [at(before), at(after)];
      const sign = first.slice(3).reduce((sum, q, k) => sum + q * second[3 + k], 0) < 0 ? -1 : 1;
      const blend = first.map((value, k) => (1 - share) * value + share * (k < 3 ? 1 : sign) * second[k]);
      solid.position.set(...blend.slice(0, 3));
      solid.quaternion.set(...blend.slice(3)).normalize();
    });
    slider.value = time;
    label.textContent = `${time.toFixed(2)} s`;
    canvas.dataset.time = time;
    draw();
  }

  function play(on) {
    button.textContent = on ? "Pause" : "Play";
    cancelAnimationFrame(playing);
    if (!on) return;
    if (time >= end) time = start;
    let last = performance.now();
    const step = (now) => {
      move(time + ((now - last) / 1000) * Number(pace.value));
      shown.setTime(time);
      last = now;
      if (time >= end) play(false);
      else playing = requestAnimationFrame(step);
    };
    playing = requestAnimationFrame(step);
  }

  button.addEventListener("click", () => play(button.textContent === "Play"));
  slider.addEventListener("input", () => { play(false); move(Number(slider.value)); shown.setTime(time); });
  shown.onTime((to) => { if (button.textContent === "Play") move(to); });
  const turn = (dx, dy) => {
    eye.yaw -= dx;
    eye.pitch = Math.min(Math.max(eye.pitch - dy, -1.55), 1.55);
    draw();
  };
  const near = (factor) => { eye.distance = Math.min(Math.max(eye.distance * factor, 0.1), 15); draw(); };
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => { if (event.buttons) turn(event.movementX / 150, event.movementY / 150); });
  canvas.addEventListener("wheel", (event) => { if (event.ctrlKey || document.activeElement === canvas) { near(Math.exp(event.deltaY / 800)); event.preventDefault(); } }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
    if (event.key in turns) turn(...turns[event.key]);
    else if (event.key === "+" || event.key === "-") near(event.key === "+" ? 0.9 : 1.1);
    else if (event.key === " ") play(button.textContent === "Play");
    else return;
    event.preventDefault();
  });
  addEventListener("resize", draw);
  move(start);
}

function mesh({ kind, size, colour: [red, green, blue, alpha] }) {
  const material = new THREE.MeshLambertMaterial({ transparent: alpha < 1, opacity: alpha, depthWrite: alpha === 1 });
  material.color.setRGB(red, green, blue, "srgb");
  let shape;
  if (kind === "box") shape = new THREE.BoxGeometry(...size);
  else if (kind === "sphere") shape = new THREE.SphereGeometry(size[0], 32, 20);
  else if (kind === "capsule") shape = new THREE.CapsuleGeometry(size[0], size[1], 10, 24).rotateX(Math.PI / 2);
  else shape = new THREE.CylinderGeometry(size[0], size[0], size[1], 32).rotateX(Math.PI / 2);
  return new THREE.Mesh(shape, material);
}
